//! Motions to many more digits than runs have, to compare runs with.
//!
//! In:  what is changed of a mechanism, and the times that are asked about.
//! Out: states, rounded.
//!
//! Not here: numbers of so many digits. Whoever has them provides [`Precise`].

use crate::any::Given;

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
