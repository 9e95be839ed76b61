//! A mechanism, where it is, and how it is integrated.
//!
//! In:  numbers.
//! Out: numbers and texts, in places that don't move.
//!
//! Functions that can fail give 0, or 1 with the reason as text. Those that give several
//! numbers say how many. What doesn't exist fails.
//!
//! Not here: whole runs (`session_run`).

use crate::row::numbers;
use crate::run::Log;
use crate::{Text, describe};
use bricard_runtime::{
    Audit, Form, Initial, Interface, Mechanism, Method, Options, Picture, Probe, Settings,
    Stabilisation, Start, State, StepControl, Stepper,
};
use core::fmt::{Display, Write};

/// The version of the exported functions; `js/index.js` refuses another.
pub const VERSION: u32 = 3;
/// Numbers that can be read at once: the rows of most runs.
pub const ROOM: usize = 1 << 17;
/// The answer of what has succeeded.
pub(crate) const DONE: u32 = 0;
/// The answer of what has failed.
pub(crate) const FAILED: u32 = 1;

/// What is known of a coordinate or velocity at the start; nothing where the description
/// decides.
type Given = Option<Initial<f64>>;

/// A mechanism, where it is, and how it is integrated.
pub struct Session<M, const N: usize, const R: usize> {
    pub(crate) mechanism: M,
    given: [[Given; N]; 2],
    /// The method, its steps, the form of the equations.
    pub(crate) options: Options<f64>,
    pub(crate) motion: Option<Motion<N, R>>,
    pub(crate) log: Log,
    pub(crate) numbers: &'static mut [f64; ROOM],
    text: Text,
}

/// A motion that has begun.
pub(crate) struct Motion<const N: usize, const R: usize> {
    pub(crate) state: State<f64, N>,
    stepper: Stepper<f64, N, R>,
}

impl<M, const N: usize, const R: usize> Session<M, N, R>
where
    M: Mechanism<f64, N, R> + Interface<f64, N>,
{
    /// A mechanism that is not assembled yet, to be integrated with an error per step of
    /// 1e-9; numbers are read in the place that is given, which is too large for a stack.
    pub fn new(mechanism: M, numbers: &'static mut [f64; ROOM]) -> Self {
        let mut options = Options::dop853(0.0, 1e-9);
        options.audit = Audit {
            passages: true,
            ..Audit::NONE
        };
        Self {
            mechanism,
            given: [[None; N]; 2],
            options,
            motion: None,
            log: Log::EMPTY,
            numbers,
            text: Text::new(),
        }
    }

    /// How many coordinates the description declares; behind these stand the integrals of
    /// states of the first order, which are internal.
    fn freedoms(&self) -> usize {
        self.mechanism.structure().freedoms().len()
    }

    /// The version of these functions.
    pub fn version(&self) -> u32 {
        VERSION
    }

    /// Where numbers are read.
    pub fn numbers(&self) -> *const f64 {
        self.numbers.as_ptr()
    }

    /// The numbers themselves, for programs of Rust.
    pub fn read(&self) -> &[f64] {
        &self.numbers[..]
    }

    /// The text itself, for programs of Rust.
    pub fn told(&self) -> &str {
        core::str::from_utf8(self.text.bytes()).unwrap_or_default()
    }

    /// Where text is read.
    pub fn text(&self) -> *const u8 {
        self.text.bytes().as_ptr()
    }

    /// How many bytes the text has.
    pub fn length(&self) -> u32 {
        self.text.bytes().len() as u32
    }

    /// Writes what the mechanism has, as JSON.
    pub fn describe(&mut self) -> u32 {
        self.text.clear();
        match describe::describe(self.mechanism.structure(), &mut self.text) {
            Ok(()) => DONE,
            Err(_) => self.fail(&"the description of the mechanism is too long"),
        }
    }

    /// A parameter; NaN if there is none at this place.
    pub fn parameter(&self, index: u32) -> f64 {
        self.mechanism.parameter(index as usize).unwrap_or(f64::NAN)
    }

    /// Sets a parameter. A motion that has begun goes on with it.
    pub fn set_parameter(&mut self, index: u32, value: f64) -> u32 {
        if !value.is_finite() {
            return self.refuse(value);
        }
        match self.mechanism.set_parameter(index as usize, value) {
            true => DONE,
            false => self.fail(&"there is no parameter at this place"),
        }
    }

    /// Holds an input at a value.
    pub fn set_input(&mut self, index: u32, value: f64) -> u32 {
        if !value.is_finite() {
            return self.refuse(value);
        }
        self.input(index, Some(value))
    }

    /// Returns an input to its default law.
    pub fn free_input(&mut self, index: u32) -> u32 {
        self.input(index, None)
    }

    fn input(&mut self, index: u32, value: Option<f64>) -> u32 {
        match self.mechanism.set_input(index as usize, value) {
            true => DONE,
            false => self.fail(&"there is no input at this place"),
        }
    }

    /// Gives a coordinate at the start, a velocity, which come after all coordinates, or a
    /// state of the first order, which come last: held, or a guess.
    pub fn begin(&mut self, place: u32, value: f64, held: u32) -> u32 {
        if !value.is_finite() {
            return self.refuse(value);
        }
        let freedoms = self.freedoms();
        let [q, v] = &mut self.given;
        match q.iter_mut().take(freedoms).chain(v).nth(place as usize) {
            Some(given) => {
                let held = held != 0;
                *given = Some(Initial { value, held });
                DONE
            }
            None => self.fail(&"there is no coordinate at this place"),
        }
    }

    /// What is known of a coordinate, velocity or state at the start: two numbers, its value
    /// and whether it is held, which is 1.
    pub fn start(&mut self, place: u32) -> u32 {
        let start = self.beginning();
        let q = start.q.iter().take(self.freedoms());
        match q.chain(&start.v).nth(place as usize) {
            Some(Initial { value, held }) => {
                self.numbers[..2].copy_from_slice(&[*value, f64::from(u8::from(*held))]);
                DONE
            }
            None => self.fail(&"there is no coordinate at this place"),
        }
    }

    /// Forgets what was given of the start.
    pub fn forget(&mut self) -> u32 {
        self.given = [[None; N]; 2];
        DONE
    }

    /// Chooses a method with steps of one length (s).
    pub fn fixed(&mut self, method: u32, step: f64) -> u32 {
        self.choose(method, StepControl::Fixed { step })
    }

    /// Chooses a method whose steps follow the accepted error.
    pub fn adaptive(&mut self, method: u32, relative: f64, absolute: f64) -> u32 {
        self.choose(method, StepControl::Adaptive { relative, absolute })
    }

    fn choose(&mut self, method: u32, step_control: StepControl<f64>) -> u32 {
        let Some(method) = method_of(method) else {
            return self.fail(&"there is no method of this number");
        };
        self.take(Options {
            method,
            step_control,
            ..self.options
        })
    }

    /// Chooses the form of the equations, and what keeps the state on the constraints:
    /// projection, nothing, or Baumgarte's gains. Then bits: 1 for passages as published, 2
    /// for steps across jumps of forces, 4 for runs that keep the energy.
    pub fn settings(&mut self, form: u32, way: u32, alpha: f64, beta: f64, bits: u32) -> u32 {
        let Some(form) = form_of(form) else {
            return self.fail(&"there is no form of this number");
        };
        let stabilisation = match way {
            0 => Stabilisation::Projection,
            1 => Stabilisation::None,
            2 if alpha > 0.0 && beta > 0.0 && (alpha + beta).is_finite() => {
                Stabilisation::Baumgarte { alpha, beta }
            }
            2 => return self.fail(&"the gains of Baumgarte's stabilisation must be positive"),
            _ => return self.fail(&"there is no stabilisation of this number"),
        };
        self.take(Options {
            settings: Settings {
                form,
                stabilisation,
                published: bits & 1 != 0,
                across_switches: bits & 2 != 0,
            },
            keep_energy: bits & 4 != 0,
            ..self.options
        })
    }

    /// Takes options, if steps can be made with them.
    fn take(&mut self, options: Options<f64>) -> u32 {
        match Stepper::new(options.method, options.step_control, options.settings) {
            Ok(stepper) => {
                self.options = options;
                if let Some(motion) = &mut self.motion {
                    motion.stepper = stepper;
                }
                DONE
            }
            Err(error) => self.fail(&error),
        }
    }

    /// The start: what was given, and else what the description says.
    fn beginning(&self) -> Start<f64, N> {
        let mut start = self.mechanism.start();
        let given = self.given.as_flattened();
        for (start, given) in start.q.iter_mut().chain(&mut start.v).zip(given) {
            *start = given.unwrap_or(*start);
        }
        start
    }

    /// Puts the mechanism together at `t = 0`, where a motion then begins.
    pub fn assemble(&mut self) -> u32 {
        let start = self.beginning();
        let state = match bricard_runtime::assemble(&self.mechanism, &start, 0.0) {
            Ok(state) => state,
            Err(error) => return self.fail(&error),
        };
        let Options {
            method,
            step_control,
            settings,
            ..
        } = self.options;
        match Stepper::new(method, step_control, settings) {
            Ok(stepper) => {
                self.motion = Some(Motion { state, stepper });
                DONE
            }
            Err(error) => self.fail(&error),
        }
    }

    /// Changes one number of the state: the time, a coordinate, a velocity, a state of the
    /// first order.
    pub fn place(&mut self, index: u32, value: f64) -> u32 {
        if !value.is_finite() {
            return self.refuse(value);
        }
        let Some(motion) = &mut self.motion else {
            return self.not_begun();
        };
        let freedoms = self.mechanism.structure().freedoms().len();
        let State { t, q, v } = &mut motion.state;
        let place = core::iter::once(t).chain(q.iter_mut().take(freedoms));
        let place = place.chain(v.iter_mut());
        match place.into_iter().nth(index as usize) {
            Some(place) => {
                *place = value;
                DONE
            }
            None => self.fail(&"there is no number of the state at this place"),
        }
    }

    /// Moves on to a time (s).
    pub fn advance(&mut self, time: f64) -> u32 {
        let Some(Motion { state, stepper }) = &mut self.motion else {
            return self.not_begun();
        };
        let span = time - state.t;
        match stepper.step(&self.mechanism, state, span) {
            Ok(()) => DONE,
            Err(error) => self.fail(&error),
        }
    }

    /// Time, coordinates, velocities, states of the first order; how many numbers.
    pub fn state(&mut self) -> u32 {
        let Some(motion) = &self.motion else {
            return 0;
        };
        let structure = self.mechanism.structure();
        let state = numbers(&motion.state, structure);
        for (place, number) in self.numbers.iter_mut().zip(state) {
            *place = number;
        }
        (1 + structure.freedoms().len() + N) as u32
    }

    /// The outputs.
    pub fn outputs(&mut self) -> u32 {
        let Some(Motion { state, stepper }) = &mut self.motion else {
            return self.not_begun();
        };
        let mut solver = stepper.solver().clone();
        let count = self.mechanism.structure().outputs.len().min(ROOM);
        let mut system = solver.on(&self.mechanism);
        match Probe::outputs(&mut system, state, &mut self.numbers[..count], &mut []) {
            Ok(()) => DONE,
            Err(error) => self.fail(&error),
        }
    }

    /// Kinetic and potential energy (J), and the power (W) that is supplied.
    pub fn energy(&mut self) -> u32 {
        let Some(motion) = &self.motion else {
            return 0;
        };
        let energy = self.mechanism.energy(&motion.state);
        self.numbers[..3].copy_from_slice(&[energy.kinetic, energy.potential, energy.power]);
        3
    }

    /// Accelerations, the rates of states of the first order, then the generalized reaction
    /// forces of the constraints.
    pub fn forces(&mut self) -> u32 {
        let Some(Motion { state, stepper }) = &mut self.motion else {
            return self.not_begun();
        };
        let freedoms = self.mechanism.structure().freedoms().len();
        match stepper.solver().clone().on(&self.mechanism).reaction(state) {
            Ok((acceleration, reaction)) => {
                let reaction = reaction.iter().take(freedoms);
                let numbers = acceleration.iter().chain(reaction);
                for (place, number) in self.numbers.iter_mut().zip(numbers) {
                    *place = *number;
                }
                DONE
            }
            Err(error) => self.fail(&error),
        }
    }

    /// How many numbers can be read at once.
    pub fn room(&self) -> u32 {
        ROOM as u32
    }

    /// The picture; see [`Picture`]. One of more numbers than there is room for is not
    /// complete.
    pub fn draw(&mut self) -> u32 {
        let Some(motion) = &self.motion else {
            return 0;
        };
        let mut picture = Picture::new(&mut self.numbers[..]);
        self.mechanism.draw(&motion.state, &mut picture);
        picture.length() as u32
    }

    pub(crate) fn not_begun(&mut self) -> u32 {
        self.fail(&"the mechanism isn't assembled yet")
    }

    fn refuse(&mut self, value: f64) -> u32 {
        self.fail(&format_args!("a number is wanted, not {value}"))
    }

    /// Takes note of a reason. One that has no room is cut.
    pub(crate) fn fail(&mut self, reason: &dyn Display) -> u32 {
        self.text.clear();
        match write!(self.text, "{reason}") {
            Ok(()) | Err(_) => FAILED,
        }
    }
}

fn method_of(number: u32) -> Option<Method> {
    Method::ALL.get(number as usize).copied()
}

fn form_of(number: u32) -> Option<Form> {
    Form::ALL.get(number as usize).copied()
}
