//! A mechanism whose inputs may come from functions of the program around.
//!
//! In:  a mechanism, a function for some of its inputs.
//! Out: a mechanism; the functions are asked at each state at which forces are needed.

use crate::callback::{Callback, LawFunction};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Acceleration, Canvas, Condition, Correction, Described, Differentiated, Energy, Interface,
    Linearised, Mechanism, Partials, Position, Start, StartFault, State, Structure, Switches,
    Terms,
};
use core::cell::Cell;

/// The value of an input over time.
pub(crate) type Law = Callback<LawFunction>;

/// A mechanism, and what its inputs follow.
#[derive(Debug)]
pub(crate) struct Driven<M> {
    /// The mechanism; inputs without a function have their values in it.
    pub(crate) mechanism: M,
    laws: Box<[Option<Law>]>,
    driven: bool,
    /// The input whose function has failed.
    failed: Cell<Option<usize>>,
}

impl<M> Driven<M> {
    /// A mechanism with a number of inputs, none of which follows a function.
    pub(crate) fn new(mechanism: M, inputs: usize) -> Self {
        Self {
            mechanism,
            laws: vec![None; inputs].into(),
            driven: false,
            failed: Cell::new(None),
        }
    }

    /// Makes an input follow a function, or none; the index is known to be one.
    pub(crate) fn follow(&mut self, input: usize, law: Option<Law>) {
        if let Some(place) = self.laws.get_mut(input) {
            *place = law;
        }
        self.driven = self.laws.iter().any(Option::is_some);
    }

    /// The input whose function has failed since this was asked last.
    pub(crate) fn take_failed(&self) -> Option<usize> {
        self.failed.take()
    }
}

impl<M: Clone> Clone for Driven<M> {
    fn clone(&self) -> Self {
        Self {
            mechanism: self.mechanism.clone(),
            laws: self.laws.clone(),
            driven: self.driven,
            failed: Cell::new(None),
        }
    }

    fn clone_from(&mut self, other: &Self) {
        self.mechanism.clone_from(&other.mechanism);
        self.laws.clone_from(&other.laws);
        self.driven = other.driven;
        self.failed = Cell::new(None);
    }
}

impl<M: Clone> Driven<M> {
    /// Does something with the mechanism as it is at a state.
    #[inline(always)]
    fn at<V, const N: usize>(&self, state: &State<f64, N>, act: impl FnOnce(&M) -> V) -> V
    where
        M: Interface<f64, N>,
    {
        match self.driven {
            false => act(&self.mechanism),
            true => act(&self.driven_at(state)),
        }
    }

    /// The mechanism with its inputs at a state. One whose function fails is not a number,
    /// which ends the run.
    fn driven_at<const N: usize>(&self, state: &State<f64, N>) -> M
    where
        M: Interface<f64, N>,
    {
        let mut mechanism = self.mechanism.clone();
        for (input, law) in self.laws.iter().enumerate() {
            if let Some(law) = law {
                let value = law.value(state.t, state.q.as_slice(), state.v.as_slice());
                if value.is_none() {
                    self.failed.set(Some(input));
                }
                mechanism.set_input(input, Some(value.unwrap_or(f64::NAN)));
            }
        }
        mechanism
    }
}

impl<M, const N: usize, const R: usize> Mechanism<f64, N, R> for Driven<M>
where
    M: Mechanism<f64, N, R> + Interface<f64, N> + Clone,
{
    fn structure(&self) -> &'static Structure {
        self.mechanism.structure()
    }

    fn terms(&self, state: &State<f64, N>, out: &mut Terms<f64, N, R>) {
        self.at(state, |mechanism| mechanism.terms(state, out));
    }

    #[inline(always)]
    fn acceleration(&self, state: &State<f64, N>, out: &mut Acceleration<f64, N, R>) -> bool {
        self.at(state, |mechanism| mechanism.acceleration(state, out))
    }

    // Constraints know no inputs.
    fn position(&self, state: &State<f64, N>, out: &mut Position<f64, N, R>) {
        self.mechanism.position(state, out);
    }

    #[inline(always)]
    fn correction(&self, state: &State<f64, N>, out: &mut Correction<f64, N, R>) -> bool {
        self.mechanism.correction(state, out)
    }

    fn begin(&self, start: &mut Start<f64, N>, t: f64) -> Result<(), StartFault<f64, N>> {
        self.mechanism.begin(start, t)
    }

    fn switches(
        &self,
        state: &State<f64, N>,
        acceleration: &SVector<f64, N>,
        out: &mut Switches<'_, f64>,
    ) -> &'static [Condition] {
        if out.values.is_empty() {
            return self.mechanism.switches(state, acceleration, out);
        }
        self.at(state, |mechanism| {
            mechanism.switches(state, acceleration, out)
        })
    }

    fn energy(&self, state: &State<f64, N>) -> Energy<f64> {
        self.at(state, |mechanism| mechanism.energy(state))
    }

    fn linearised(
        &self,
        state: &State<f64, N>,
        acceleration: &SVector<f64, N>,
        multiplier: &SVector<f64, R>,
        out: &mut Linearised<f64, N, R>,
    ) -> bool {
        self.at(state, |mechanism| {
            mechanism.linearised(state, acceleration, multiplier, out)
        })
    }
}

impl<M, const N: usize> Interface<f64, N> for Driven<M>
where
    M: Interface<f64, N> + Clone,
{
    fn parameter(&self, index: usize) -> Option<f64> {
        self.mechanism.parameter(index)
    }

    fn set_parameter(&mut self, index: usize, value: f64) -> bool {
        self.mechanism.set_parameter(index, value)
    }

    fn set_input(&mut self, index: usize, value: Option<f64>) -> bool {
        self.mechanism.set_input(index, value)
    }

    fn start(&self) -> Start<f64, N> {
        self.mechanism.start()
    }

    fn outputs(&self, state: &State<f64, N>, values: &mut [f64]) {
        self.at(state, |mechanism| mechanism.outputs(state, values));
    }

    fn signals(
        &self,
        state: &State<f64, N>,
        acceleration: &SVector<f64, N>,
        outputs: &mut [f64],
        inputs: &mut [f64],
    ) {
        self.at(state, |mechanism| {
            mechanism.signals(state, acceleration, outputs, inputs);
        });
    }

    fn events(&self, state: &State<f64, N>, values: &mut [f64]) {
        self.at(state, |mechanism| mechanism.events(state, values));
    }

    fn draw(&self, state: &State<f64, N>, canvas: &mut dyn Canvas<f64>) {
        self.at(state, |mechanism| mechanism.draw(state, canvas));
    }

    fn described(
        &self,
        state: &State<f64, N>,
        acceleration: &SVector<f64, N>,
        values: &mut [Described<f64>],
    ) {
        self.at(state, |mechanism| {
            mechanism.described(state, acceleration, values);
        });
    }
}

impl<M, const N: usize> Differentiated<f64, N> for Driven<M>
where
    M: Interface<f64, N> + Differentiated<f64, N> + Clone,
{
    fn partials(
        &self,
        state: &State<f64, N>,
        acceleration: &SVector<f64, N>,
        out: &mut Partials<'_, f64>,
    ) -> bool {
        self.at(state, |mechanism| {
            mechanism.partials(state, acceleration, out)
        })
    }
}
