//! A mechanism, what is changed of it, how it is run, what should come of it.

use bricard_runtime::{Method, Options, StepControl};

/// A run under stress.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// What kind of stress it is: a heading of the table.
    pub kind: &'static str,
    /// The case, in words.
    pub what: &'static str,
    /// The mechanism, by name.
    pub mechanism: &'static str,
    /// Parameters with other values.
    pub set: &'static [(&'static str, f64)],
    /// Inputs held at values.
    pub inputs: &'static [(usize, f64)],
    /// Coordinates, or velocities as `der(name)`, held at the start.
    pub hold: &'static [(&'static str, f64)],
    /// The end of the run (s).
    pub until: f64,
    /// The method.
    pub method: Method,
    /// Relative and absolute tolerance.
    pub tolerance: f64,
    /// What it should come to.
    pub wanted: Wanted,
}

/// What a run should come to.
#[derive(Clone, Copy, Debug)]
pub enum Wanted {
    /// The right answer: the energy adds up to this part of itself, and a run by
    /// another method ends within this distance, relative to the coordinate.
    Right { energy: f64, end: f64 },
    /// The right answer as far as the energy tells, for motions that are chaotic or
    /// faster than their ends can be compared.
    Balanced { energy: f64 },
    /// An error with these words in its message.
    Refused { words: &'static [&'static str] },
}

impl Case {
    /// What most cases have in common.
    pub const USUAL: Self = Self {
        kind: "",
        what: "",
        mechanism: "",
        set: &[],
        inputs: &[],
        hold: &[],
        until: 1.0,
        method: Method::Dop853,
        tolerance: 1e-10,
        wanted: Wanted::Right {
            energy: 1e-8,
            end: 1e-6,
        },
    };

    /// A case with other parameters.
    pub const fn with(self, what: &'static str, set: &'static [(&'static str, f64)]) -> Self {
        Self { what, set, ..self }
    }

    /// A case with another start.
    pub const fn begun(self, what: &'static str, hold: &'static [(&'static str, f64)]) -> Self {
        Self { what, hold, ..self }
    }

    /// How it is run.
    pub fn options(&self) -> Options<f64> {
        self.options_by(self.method, self.tolerance)
    }

    /// How it is run by another method, with another tolerance.
    pub fn options_by(&self, method: Method, tolerance: f64) -> Options<f64> {
        let step_control = StepControl::Adaptive {
            relative: tolerance,
            absolute: tolerance,
        };
        let mut options = Options::new(self.until, method, step_control);
        options.most_steps = Some(MOST_STEPS);
        options
    }
}

/// Steps after which a case counts as hung.
const MOST_STEPS: u64 = 2_000_000;
