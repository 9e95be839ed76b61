//! A part of a run.
//!
//! In:  [`Segment`]: where it begins, how to integrate, what to record.
//! Out: [`Reached`]: where it ended, and what was done.

use bricard_runtime::{Counters, Options, Origin, Passage};
use std::ops::ControlFlow;
use std::time::Duration;

use crate::column::Column;

/// Steps of a segment that ends before the run.
pub(crate) const STEPS: u64 = 1000;
/// Steps by which it is longer where it would end next to a singular position.
pub(crate) const EXTRA_STEPS: u64 = 100;
/// It doesn't end where constraints are independent by less than this sine: a
/// passage through a singular position belongs to one segment.
pub(crate) const CALM_SINE: f64 = 0.3;

/// A part of a run, or the whole of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Method, end, form of the equations; the beginning of the run if this is a later
    /// part of it.
    pub options: Options<f64>,
    /// Time, coordinates, velocities; `None`: the assembled start.
    pub from: Option<Vec<f64>>,
    /// Distance of the rows (s); a row after each step if there is none.
    pub every: Option<f64>,
    /// Columns besides time, coordinates and velocities.
    pub columns: Vec<Column>,
    /// Rows of earlier parts.
    pub rows: u64,
    /// Whether it ends after so many steps that a checkpoint is worth its while.
    pub short: bool,
}

/// Where a part of a run ended, and what was done in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Reached {
    /// Time, coordinates, velocities.
    pub state: Vec<f64>,
    /// The beginning of the run, and what was supplied since.
    pub origin: Origin<f64>,
    /// Rows of this part and of earlier ones.
    pub rows: u64,
    /// Why it could not go on.
    pub error: Option<String>,
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
    /// Events: the place in [`Structure::events`](bricard_runtime::Structure::events) and
    /// the time (s) of each.
    pub events: Vec<(usize, f64)>,
    /// Work by kind.
    pub counters: Counters,
}

/// Watches a part of a run. Each method may break it off.
pub trait Watch {
    /// Takes a row: time, coordinates, velocities, states of the first order, added
    /// columns.
    fn row(&mut self, values: &[f64]) -> ControlFlow<()>;
    /// Is told how far the run has come (s), one or more steps after the last time.
    fn at(&mut self, t: f64, steps: u64) -> ControlFlow<()>;
}
