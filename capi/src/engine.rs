//! A mechanism, where it is, and how it is integrated.
//!
//! In:  values.
//! Out: an [`Engine`]; a [`Status`] and a message where something is refused.
//!
//! Nothing is allocated but by [`Engine::new`] and by copying.
//!
//! Not here: how it moves (`motion`).

use crate::Embedded;
use crate::input_functions::{Driven, Law};
use crate::names::{Known, List, Names};
use crate::status::Status;
use crate::text::Text;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Initial, Options, SimulateError, Solver, Start, State, Stepper, Structure, assemble,
};
use core::ffi::CStr;
use core::fmt::Display;

/// Whether something could be done; [`Engine::text`] says why not.
pub type Outcome<V = ()> = Result<V, Status>;

/// Accepted error of a step, relative and absolute, unless another is given.
const TOLERANCE: f64 = 1e-9;

/// A mechanism, where it is, and how it is integrated.
#[derive(Debug)]
pub struct Engine<M, const N: usize, const R: usize> {
    pub(crate) driven: Driven<M>,
    /// The values that inputs without a function are held at.
    held: Box<[Option<f64>]>,
    pub(crate) names: Names,
    start: Start<f64, N>,
    pub(crate) state: Option<State<f64, N>>,
    options: Options<f64>,
    pub(crate) stepper: Stepper<f64, N, R>,
    /// Answers questions about states, apart from the motion.
    pub(crate) inquiry: Solver<f64, N, R>,
    /// Derivatives by the description's own symbols, before they are put together.
    pub(crate) partials: Box<[f64]>,
    pub(crate) text: Text,
    /// When the last motion failed (s).
    pub(crate) failed_at: Option<f64>,
}

impl<M, const N: usize, const R: usize> Engine<M, N, R>
where
    M: Embedded<N, R>,
{
    /// A mechanism with the parameters and the start of its description, not assembled.
    ///
    /// # Errors
    ///
    /// [`SimulateError`] if the default options are refused.
    pub fn new() -> Result<Self, SimulateError<f64>> {
        let mechanism = M::default();
        let structure = mechanism.structure();
        let options = Options::dop853(0.0, TOLERANCE);
        Ok(Self {
            held: vec![None; structure.inputs.len()].into(),
            names: Names::of(structure),
            start: mechanism.start(),
            state: None,
            options,
            stepper: Stepper::new(options.method, options.step_control, options.settings)?,
            inquiry: Solver::new(options.settings),
            partials: vec![0.0; room::<N>(structure)].into(),
            text: Text::new(),
            failed_at: None,
            driven: Driven::new(mechanism, structure.inputs.len()),
        })
    }

    /// A copy, which goes on to the same bits.
    pub fn copy(&self) -> Self {
        Self {
            driven: self.driven.clone(),
            held: self.held.clone(),
            names: self.names.clone(),
            start: self.start,
            state: self.state,
            options: self.options,
            stepper: self.stepper.clone(),
            inquiry: self.inquiry.clone(),
            partials: self.partials.clone(),
            text: Text::new(),
            failed_at: None,
        }
    }

    /// Becomes a copy of another, without allocating.
    pub fn assign(&mut self, other: &Self) {
        self.driven.clone_from(&other.driven);
        self.held.clone_from(&other.held);
        self.start = other.start;
        self.state = other.state;
        self.options = other.options;
        self.stepper.clone_from(&other.stepper);
        self.inquiry.clone_from(&other.inquiry);
    }

    /// How many coordinates the description declares; velocities follow as many, and then
    /// the states of the first order.
    pub(crate) fn freedoms(&self) -> usize {
        self.structure().freedoms().len()
    }

    /// What was known when the code was generated.
    pub fn structure(&self) -> &'static Structure {
        self.driven.mechanism.structure()
    }

    /// Refuses something, with a reason.
    pub(crate) fn refuse<V>(&mut self, status: Status, reason: &dyn Display) -> Outcome<V> {
        self.text.say(reason);
        Err(status)
    }

    /// Refuses an array of another length than is wanted.
    pub(crate) fn expect_length(&mut self, n: usize, wanted: usize, what: &str) -> Outcome {
        match n == wanted {
            true => Ok(()),
            false => self.refuse(
                Status::Length,
                &format_args!("{what} has {wanted} numbers, not {n}"),
            ),
        }
    }

    /// Refuses a place at which there is nothing.
    fn expect_index(&mut self, list: List, index: usize) -> Outcome {
        let count = self.names.list(list).len();
        let word = list.word();
        match (index < count, count) {
            (true, _) => Ok(()),
            (false, 0) => self.refuse(Status::Index, &format_args!("there is no {word}")),
            (false, _) => self.refuse(
                Status::Index,
                &format_args!("there is no {word} {index}: they are 0 to {}", count - 1),
            ),
        }
    }

    /// The place of a name in a list.
    pub(crate) fn place_of(&mut self, list: List, name: &CStr) -> Outcome<usize> {
        if let Some(place) = self.names.find(list, name) {
            return Ok(place);
        }
        let entries = self.names.list(list);
        let (word, name) = (list.word(), name.to_string_lossy());
        self.text.say(&format_args!(
            "there is no {word} `{name}`{}",
            Known(entries)
        ));
        Err(Status::Name)
    }

    /// Refuses what is infinite or NaN.
    fn expect_finite(&mut self, value: f64, list: List, index: usize) -> Outcome {
        if value.is_finite() {
            return Ok(());
        }
        let name = &self.names.list(list)[index].name;
        let (word, name) = (list.word(), name.to_string_lossy());
        self.text.say(&format_args!(
            "the {word} `{name}` can't be {value}: give it a finite number"
        ));
        Err(Status::NotFinite)
    }

    /// A parameter.
    ///
    /// # Errors
    ///
    /// [`Status::Index`].
    pub fn parameter(&mut self, index: usize) -> Outcome<f64> {
        self.expect_index(List::Parameters, index)?;
        Ok(self.parameter_at(index).unwrap_or_default())
    }

    pub(crate) fn parameter_at(&self, index: usize) -> Option<f64> {
        self.driven.mechanism.parameter(index)
    }

    /// Sets a parameter.
    ///
    /// # Errors
    ///
    /// [`Status::Index`], [`Status::NotFinite`].
    pub fn set_parameter(&mut self, index: usize, value: f64) -> Outcome {
        self.expect_index(List::Parameters, index)?;
        self.expect_finite(value, List::Parameters, index)?;
        // The start of the description may depend on parameters, as long as nothing else
        // was given.
        let before = self.driven.mechanism.start();
        self.driven.mechanism.set_parameter(index, value);
        let after = self.driven.mechanism.start();
        let given = self.start.q.iter_mut().chain(&mut self.start.v);
        let before = before.q.iter().chain(&before.v);
        let after = after.q.iter().chain(&after.v);
        for ((given, before), after) in given.zip(before).zip(after) {
            if given == before {
                *given = *after;
            }
        }
        Ok(())
    }

    /// The values that inputs are held at.
    pub(crate) fn held(&self) -> &[Option<f64>] {
        &self.held
    }

    /// Holds an input at a value.
    ///
    /// # Errors
    ///
    /// [`Status::Index`], [`Status::NotFinite`].
    pub fn hold_input(&mut self, index: usize, value: f64) -> Outcome {
        self.expect_index(List::Inputs, index)?;
        self.expect_finite(value, List::Inputs, index)?;
        self.feed(index, Some(value), None);
        Ok(())
    }

    /// Returns an input to the law of the description.
    ///
    /// # Errors
    ///
    /// [`Status::Index`].
    pub fn release_input(&mut self, index: usize) -> Outcome {
        self.expect_index(List::Inputs, index)?;
        self.feed(index, None, None);
        Ok(())
    }

    /// Lets an input follow a function.
    ///
    /// # Errors
    ///
    /// [`Status::Index`].
    pub(crate) fn drive_input(&mut self, index: usize, law: Law) -> Outcome {
        self.expect_index(List::Inputs, index)?;
        self.feed(index, None, Some(law));
        Ok(())
    }

    fn feed(&mut self, index: usize, value: Option<f64>, law: Option<Law>) {
        self.driven.mechanism.set_input(index, value);
        self.held[index] = value;
        self.driven.follow(index, law);
    }

    /// What is given for the start.
    pub fn start(&self) -> Start<f64, N> {
        self.start
    }

    /// What is given for the start of a coordinate or of its velocity; states of the first
    /// order stand behind the velocities.
    ///
    /// # Errors
    ///
    /// [`Status::Index`].
    pub fn start_of(&mut self, index: usize, velocity: bool) -> Outcome<Initial<f64>> {
        self.expect_start(index, velocity)?;
        Ok(match velocity {
            true => self.start.v[index],
            false => self.start.q[index],
        })
    }

    /// Refuses a place of the start at which there is nothing; what is there otherwise.
    fn expect_start(&mut self, index: usize, velocity: bool) -> Outcome<(List, usize)> {
        let freedoms = self.freedoms();
        let (list, place) = match index.checked_sub(freedoms) {
            Some(place) if velocity && place < N - freedoms => (List::States, place),
            _ => (List::Coordinates, index),
        };
        self.expect_index(list, place)?;
        Ok((list, place))
    }

    /// Gives a value, or a guess, for the start of a coordinate or of its velocity.
    ///
    /// # Errors
    ///
    /// [`Status::Index`], [`Status::NotFinite`].
    pub fn set_start(&mut self, index: usize, velocity: bool, initial: Initial<f64>) -> Outcome {
        let (list, place) = self.expect_start(index, velocity)?;
        self.expect_finite(initial.value, list, place)?;
        match velocity {
            true => self.start.v[index] = initial,
            false => self.start.q[index] = initial,
        }
        Ok(())
    }

    /// Finds a state that keeps the held values of the start.
    ///
    /// # Errors
    ///
    /// [`Status::NotFinite`], [`Status::Assembly`].
    pub fn assemble(&mut self, t: f64) -> Outcome {
        if !t.is_finite() {
            let reason = format_args!("the start can't be at t = {t} s");
            return self.refuse(Status::NotFinite, &reason);
        }
        match assemble::<f64, _, N, R>(&self.driven, &self.start, t) {
            Ok(state) => {
                self.place(state);
                Ok(())
            }
            Err(error) => self.refuse(Status::Assembly, &error),
        }
    }

    /// Where the mechanism is, if it is anywhere.
    pub(crate) fn state_if_any(&self) -> Option<State<f64, N>> {
        self.state
    }

    /// Where the mechanism is.
    ///
    /// # Errors
    ///
    /// [`Status::Order`].
    pub fn state(&mut self) -> Outcome<State<f64, N>> {
        match self.state {
            Some(state) => Ok(state),
            None => {
                let words = Status::Order.words().to_string_lossy();
                self.refuse(Status::Order, &words)
            }
        }
    }

    /// Puts the mechanism somewhere.
    ///
    /// # Errors
    ///
    /// [`Status::NotFinite`].
    pub fn set_state(&mut self, state: State<f64, N>) -> Outcome {
        if !state.is_finite() {
            let reason = "a state must be finite: a time, coordinate or velocity is not";
            return self.refuse(Status::NotFinite, &reason);
        }
        self.place(state);
        Ok(())
    }

    /// Begins at a state: what steps before it taught is forgotten.
    pub(crate) fn place(&mut self, state: State<f64, N>) {
        self.replace(Some(state), self.start);
    }

    pub(crate) fn replace(&mut self, state: Option<State<f64, N>>, start: Start<f64, N>) {
        self.start = start;
        self.state = state;
        let Options {
            method,
            step_control,
            settings,
            ..
        } = self.options;
        // The options were checked when they were set.
        let renewed = self.stepper.renew(method, step_control, settings);
        debug_assert!(renewed.is_ok(), "{renewed:?}");
    }

    /// How it is integrated.
    pub fn options(&self) -> &Options<f64> {
        &self.options
    }

    /// Chooses how it is integrated; the end of a run is told when it begins.
    ///
    /// # Errors
    ///
    /// [`Status::Argument`]; nothing is changed then.
    pub fn set_options(&mut self, options: Options<f64>) -> Outcome {
        let Options {
            method,
            step_control,
            settings,
            ..
        } = options;
        if let Err(error) = self.stepper.renew(method, step_control, settings) {
            return self.refuse(Status::Argument, &error);
        }
        self.inquiry.renew(settings);
        self.options = options;
        Ok(())
    }
}

/// A state of some numbers: as many coordinates as are given, the integrals of states being
/// none, and all velocities and states.
pub(crate) fn state_of<const N: usize>(t: f64, q: &[f64], v: &[f64]) -> State<f64, N> {
    State {
        t,
        q: SVector::from_fn(|i, _| q.get(i).copied().unwrap_or(0.0)),
        v: SVector::from_fn(|i, _| v[i]),
    }
}

/// How many numbers the derivatives of forces, outputs and events are.
fn room<const N: usize>(structure: &Structure) -> usize {
    let inputs = structure.inputs.len();
    let functions = structure.outputs.len() + structure.events.len();
    N * inputs + functions * (3 * N + inputs)
}
