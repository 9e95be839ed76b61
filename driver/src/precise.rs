//! Motions to many more digits than runs have, to compare runs with.
//!
//! In:  what is changed of a mechanism, and the times that are asked about.
//! Out: states, rounded.
//!
//! Not here: numbers of so many digits. Whoever has them provides [`Precise`].

use crate::any::Given;
use crate::link::Ends;
use crate::serve::listen;
use crate::wire::{Answer, Question, send};
use std::io::{self, Write};
use std::process::{Command, ExitCode};

/// A mechanism in numbers of many digits. What fails says why in words.
pub trait Precise {
    /// The coordinates at the end of a motion.
    fn exact(&mut self, changes: &Changes, until: f64) -> Result<Exact, String>;
    /// States around a passage through a singular position.
    fn path(&mut self, around: &Around) -> Result<Path, String>;
}

/// What is changed of a mechanism, by place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// Parameters, and their values.
    pub parameters: Vec<(usize, f64)>,
    /// Inputs, and the values they are held at.
    pub inputs: Vec<(usize, f64)>,
    /// Values given at the start.
    pub given: Vec<Given>,
}

/// Coordinates at the end of a motion, rounded, and how far they may be off.
#[derive(Clone, Debug, PartialEq)]
pub struct Exact {
    /// The coordinates.
    pub end: Vec<f64>,
    /// What two computations of them differ by.
    pub error: f64,
}

/// Which states are asked for around a passage.
#[derive(Clone, Debug, PartialEq)]
pub struct Around {
    /// About when the singular position is passed (s).
    pub about: f64,
    /// For each state, how far the fastest coordinate is from the passage (m, rad), and
    /// how long before that the state is (s).
    pub places: Vec<(f64, f64)>,
    /// States so much later are asked for, too (s).
    pub span: f64,
}

/// A passage, and the rows that were asked for around it.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// When the singular position is passed (s).
    pub passage: f64,
    /// Rows of time, coordinates and velocities, in the order of time.
    pub rows: Vec<Vec<f64>>,
}

impl Around {
    /// The times that are asked for relative to the passage (s), in rising order, if the
    /// fastest coordinate passes it with a given speed (m/s, rad/s).
    pub fn times(&self, speed: f64) -> Vec<f64> {
        let start = |(distance, before): &(f64, f64)| distance / speed - before;
        let starts = self.places.iter().map(start);
        let mut times: Vec<f64> = starts.flat_map(|t| [t, t + self.span]).collect();
        times.retain(|t| self.about + t > 0.0);
        times.sort_by(f64::total_cmp);
        times
    }
}

/// Answers what is asked about a mechanism until nobody asks any more: the whole of a
/// program's `main`.
pub fn serve_precise(mut mechanism: Box<dyn Precise>) -> ExitCode {
    let mut out = io::stdout();
    for question in listen(|_: &Question| {}) {
        let answer = match question {
            Question::Exact(changes, until) => Answer::Exact(mechanism.exact(&changes, until)),
            Question::Path(around) => Answer::Path(mechanism.path(&around)),
        };
        if send(&mut out, &answer).and_then(|()| out.flush()).is_err() {
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

/// A mechanism in a program of its own.
#[derive(Debug)]
pub struct PreciseLink(Ends);

impl PreciseLink {
    /// Starts a program that [`serve_precise`]s a mechanism.
    ///
    /// # Errors
    ///
    /// What the system says.
    pub fn start(program: Command) -> io::Result<Self> {
        Ok(Self(Ends::start(program)?))
    }
}

impl Precise for PreciseLink {
    fn exact(&mut self, changes: &Changes, until: f64) -> Result<Exact, String> {
        match self.0.ask(&Question::Exact(changes.clone(), until))? {
            Answer::Exact(exact) => exact,
            Answer::Path(_) => Err(Ends::NONSENSE.to_string()),
        }
    }

    fn path(&mut self, around: &Around) -> Result<Path, String> {
        match self.0.ask(&Question::Path(around.clone()))? {
            Answer::Path(path) => path,
            Answer::Exact(_) => Err(Ends::NONSENSE.to_string()),
        }
    }
}
