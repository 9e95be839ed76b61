//! States at equal intervals of time.
//!
//! In:  steps.
//! Out: calls of a function, at exact multiples of the interval.

use super::{Observer, Probe};
use crate::{DynamicsError, Real, State, Step};
use core::fmt::{Display, Formatter};
use core::ops::ControlFlow;

/// Rows closer to the end of a step than this multiple of the round-off of time
/// are the end of the step.
const SAME_TIME: f64 = 4.0;

/// An interval between rows that is not a positive number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BadInterval<T>(
    /// The offending value (s).
    pub T,
);

impl<T: Real> Display for BadInterval<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        write!(
            f,
            "the interval between rows must be a positive number of seconds, not {}",
            self.0
        )
    }
}

impl<T: Real> core::error::Error for BadInterval<T> {}

/// The times `t₀ + i·dt`, and how far a run has come.
#[derive(Clone, Debug)]
pub(super) struct Grid<T> {
    every: T,
    origin: T,
    next: u64,
}

impl<T: Real> Grid<T> {
    pub(super) fn new(every: T) -> Result<Self, BadInterval<T>> {
        if every.is_finite() && every > T::zero() {
            Ok(Self {
                every,
                origin: T::zero(),
                next: 0,
            })
        } else {
            Err(BadInterval(every))
        }
    }

    /// The row at `origin` is taken.
    pub(super) fn begin(&mut self, origin: T) {
        self.go_on(origin, 1);
    }

    /// The first rows are taken.
    fn go_on(&mut self, origin: T, rows: u64) {
        self.origin = origin;
        self.next = rows;
    }

    /// Calls `sink` with each row of a step until it breaks off.
    pub(super) fn rows<const N: usize>(
        &mut self,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
        sink: &mut dyn FnMut(&State<T, N>) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        let end = *step.end();
        let same = T::EPSILON * T::from_f64(SAME_TIME) * end.t.abs().max(self.origin.abs());
        loop {
            let t = self.origin + self.every * T::from_f64(self.next as f64);
            if t > end.t + same {
                return Ok(ControlFlow::Continue(()));
            }
            let state = if (t - end.t).abs() <= same {
                State { t, ..end }
            } else {
                let mut inside = step.at(t);
                probe.project(&mut inside)?;
                inside
            };
            self.next += 1;
            if sink(&state).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
    }
}

/// Calls a function with the states at `t₀`, `t₀ + dt`, `t₀ + 2 dt`, …
///
/// Row `i` is at `t₀ + i·dt`: nothing accumulates. States within a step come
/// from its interpolant and are brought back onto the constraints. The function
/// may break the run off.
#[derive(Clone, Debug)]
pub struct Sampler<T, F> {
    grid: Grid<T>,
    sink: F,
}

impl<T: Real, F> Sampler<T, F> {
    /// Calls `sink` every `every` seconds.
    ///
    /// # Errors
    ///
    /// [`BadInterval`] if the interval is not a positive number.
    pub fn new(every: T, sink: F) -> Result<Self, BadInterval<T>> {
        Ok(Self {
            grid: Grid::new(every)?,
            sink,
        })
    }

    /// Goes on where another run ended that began at `origin` (s) and had so many
    /// rows. Beginning anew forgets it.
    pub fn go_on(&mut self, origin: T, rows: u64) {
        self.grid.go_on(origin, rows);
    }
}

impl<T, F, const N: usize> Observer<T, N> for Sampler<T, F>
where
    T: Real,
    F: FnMut(&State<T, N>) -> ControlFlow<()>,
{
    fn begin(
        &mut self,
        state: &State<T, N>,
        _probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        self.grid.begin(state.t);
        Ok((self.sink)(state))
    }

    fn step(
        &mut self,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        self.grid.rows(step, probe, &mut self.sink)
    }
}
