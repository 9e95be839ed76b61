//! A mechanism, where it is, and how it is integrated.
//!
//! In:  numbers.
//! Out: numbers and texts, in places that don't move.
//!
//! Functions that can fail give 0, or 1 with the reason as text. Those that give several
//! numbers say how many. What doesn't exist fails.

use crate::{Picture, Text, describe};
use bricard_runtime::{
    Initial, Interface, Mechanism, Method, Probe, Settings, State, StepControl, Stepper,
};
use core::fmt::{Display, Write};

/// The version of the exported functions; `js/index.js` refuses another.
pub const VERSION: u32 = 1;
/// Numbers that can be read at once.
pub const ROOM: usize = 1 << 12;
/// The answer of what has succeeded.
const DONE: u32 = 0;
/// The answer of what has failed.
const FAILED: u32 = 1;

/// What is known of a coordinate or velocity at the start; nothing where the description
/// decides.
type Given = Option<Initial<f64>>;

/// A mechanism, where it is, and how it is integrated.
pub struct Session<M, const N: usize, const R: usize> {
    mechanism: M,
    given: [[Given; N]; 2],
    method: Method,
    step_control: StepControl<f64>,
    motion: Option<Motion<N, R>>,
    numbers: [f64; ROOM],
    text: Text,
}

/// A motion that has begun.
struct Motion<const N: usize, const R: usize> {
    state: State<f64, N>,
    stepper: Stepper<f64, N, R>,
}

impl<M, const N: usize, const R: usize> Session<M, N, R>
where
    M: Mechanism<f64, N, R> + Interface<f64, N>,
{
    /// A mechanism that is not assembled yet, to be integrated with an error per step of
    /// 1e-9.
    pub fn new(mechanism: M) -> Self {
        Self {
            mechanism,
            given: [[None; N]; 2],
            method: Method::Dop853,
            step_control: StepControl::Adaptive {
                relative: 1e-9,
                absolute: 1e-9,
            },
            motion: None,
            numbers: [0.0; ROOM],
            text: Text::new(),
        }
    }

    /// The version of these functions.
    pub fn version(&self) -> u32 {
        VERSION
    }

    /// Where numbers are read.
    pub fn numbers(&self) -> *const f64 {
        self.numbers.as_ptr()
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

    /// Gives a coordinate at the start, or a velocity, which come after all coordinates:
    /// held, or a guess.
    pub fn begin(&mut self, place: u32, value: f64, held: u32) -> u32 {
        if !value.is_finite() {
            return self.refuse(value);
        }
        match self.given.as_flattened_mut().get_mut(place as usize) {
            Some(given) => {
                let held = held != 0;
                *given = Some(Initial { value, held });
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
        match Stepper::new(method, step_control, Settings::default()) {
            Ok(stepper) => {
                (self.method, self.step_control) = (method, step_control);
                if let Some(motion) = &mut self.motion {
                    motion.stepper = stepper;
                }
                DONE
            }
            Err(error) => self.fail(&error),
        }
    }

    /// Puts the mechanism together at `t = 0`, where a motion then begins.
    pub fn assemble(&mut self) -> u32 {
        let mut start = self.mechanism.start();
        let [q, v] = &self.given;
        for (start, given) in start
            .q
            .iter_mut()
            .chain(&mut start.v)
            .zip(q.iter().chain(v))
        {
            *start = given.unwrap_or(*start);
        }
        let state = match bricard_runtime::assemble(&self.mechanism, &start, 0.0) {
            Ok(state) => state,
            Err(error) => return self.fail(&error),
        };
        match Stepper::new(self.method, self.step_control, Settings::default()) {
            Ok(stepper) => {
                self.motion = Some(Motion { state, stepper });
                DONE
            }
            Err(error) => self.fail(&error),
        }
    }

    /// Changes one number of the state: the time, a coordinate, or a velocity.
    pub fn place(&mut self, index: u32, value: f64) -> u32 {
        if !value.is_finite() {
            return self.refuse(value);
        }
        let Some(motion) = &mut self.motion else {
            return self.not_begun();
        };
        let State { t, q, v } = &mut motion.state;
        let place = core::iter::once(t).chain(q.iter_mut()).chain(v.iter_mut());
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

    /// Time, coordinates, velocities.
    pub fn state(&mut self) -> u32 {
        let Some(motion) = &self.motion else {
            return 0;
        };
        let State { t, q, v } = &motion.state;
        let numbers = core::iter::once(t).chain(q).chain(v);
        for (place, number) in self.numbers.iter_mut().zip(numbers) {
            *place = *number;
        }
        (2 * N + 1) as u32
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

    /// Accelerations, then the generalized reaction forces of the constraints.
    pub fn forces(&mut self) -> u32 {
        let Some(Motion { state, stepper }) = &mut self.motion else {
            return self.not_begun();
        };
        match stepper.solver().clone().on(&self.mechanism).reaction(state) {
            Ok((acceleration, reaction)) => {
                let numbers = acceleration.iter().chain(&reaction);
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
        let mut picture = Picture::new(&mut self.numbers);
        self.mechanism.draw(&motion.state, &mut picture);
        picture.length() as u32
    }

    fn not_begun(&mut self) -> u32 {
        self.fail(&"the mechanism isn't assembled yet")
    }

    fn refuse(&mut self, value: f64) -> u32 {
        self.fail(&format_args!("a number is wanted, not {value}"))
    }

    /// Takes note of a reason. One that has no room is cut.
    fn fail(&mut self, reason: &dyn Display) -> u32 {
        self.text.clear();
        match write!(self.text, "{reason}") {
            Ok(()) | Err(_) => FAILED,
        }
    }
}

fn method_of(number: u32) -> Option<Method> {
    let all = [
        Method::Rk4,
        Method::Dp5,
        Method::Dop853,
        Method::Radau5,
        Method::Radau9,
    ];
    all.get(number as usize).copied()
}
