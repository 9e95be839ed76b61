//! What was done in a run, and how well.
//!
//! In:  what was reached by its segments.
//! Out: a [`Report`].

use crate::number::largest;
use bricard_driver::Reached;
use bricard_runtime::{Counters, Passage, Structure};
use std::time::Duration;

/// What was done in a run, and how well.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Accepted steps.
    pub steps: u64,
    /// Steps that were tried and thrown away.
    pub rejected: u64,
    /// Time it took.
    pub wall: Duration,
    /// The largest error of a constraint equation, in its unit.
    pub constraint_error: f64,
    /// The largest difference between the energy and what it should be (J).
    pub energy_error: f64,
    /// The largest energy that was exchanged between its forms, or supplied (J).
    pub energy_exchanged: f64,
    /// Passages through singular positions.
    pub passages: Vec<Passage<f64>>,
    /// Events: the name and the time (s) of each.
    pub events: Vec<(&'static str, f64)>,
    /// Work by kind.
    pub counters: Counters,
}

impl Report {
    /// Adds what was done in a segment of a mechanism with this structure.
    pub fn add(&mut self, reached: &Reached, structure: &Structure) {
        self.steps += reached.steps;
        self.rejected += reached.rejected;
        self.wall += reached.wall;
        self.constraint_error = largest([self.constraint_error, reached.constraint_error]);
        self.energy_error = largest([self.energy_error, reached.energy_error]);
        self.energy_exchanged = largest([self.energy_exchanged, reached.energy_exchanged]);
        self.passages.extend(&reached.passages);
        let event = |(place, t): &(usize, f64)| Some((structure.events.get(*place)?.name, *t));
        self.events.extend(reached.events.iter().filter_map(event));
        self.counters += reached.counters;
    }
}
