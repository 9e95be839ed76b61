//! What was done in a run, and how well.
//!
//! In:  the summaries of its legs.
//! Out: a [`Report`].

use crate::number::largest;
use bricard_runtime::{Counters, Passage, Summary};
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
    /// Passages through singular positions.
    pub passages: Vec<Passage<f64>>,
    /// Events: the name and the time (s) of each.
    pub events: Vec<(&'static str, f64)>,
    /// Work by kind.
    pub counters: Counters,
}

impl Report {
    /// Adds what was done in a leg.
    pub fn add<const N: usize>(&mut self, summary: &Summary<f64, N>) {
        self.steps += summary.steps;
        self.rejected += summary.rejected;
        let constraint = summary.constraint_error.map_or(0.0, |error| error.position);
        self.constraint_error = largest([self.constraint_error, constraint]);
        let energy = summary.energy_error.unwrap_or(0.0);
        self.energy_error = largest([self.energy_error, energy]);
        self.counters += summary.counters;
    }
}
