//! Rows at equal intervals of time, kept.
//!
//! In:  steps.
//! Out: the states.

use super::{BadInterval, Grid, Observer, Probe};
use crate::{DynamicsError, Real, State, Step};
use core::ops::ControlFlow;
use std::vec::Vec;

/// Keeps the states at `t₀`, `t₀ + dt`, `t₀ + 2 dt`, …, see
/// [`Sampler`](super::Sampler).
///
/// What was recorded before a run failed stays recorded, until another run begins.
#[derive(Clone, Debug)]
pub struct Recorder<T, const N: usize> {
    grid: Grid<T>,
    rows: Vec<State<T, N>>,
}

impl<T: Real, const N: usize> Recorder<T, N> {
    /// Keeps a state every `every` seconds.
    ///
    /// # Errors
    ///
    /// [`BadInterval`] if the interval is not a positive number.
    pub fn new(every: T) -> Result<Self, BadInterval<T>> {
        Ok(Self {
            grid: Grid::new(every)?,
            rows: Vec::new(),
        })
    }

    /// Makes the next run the continuation of one that began at `origin` (s) and had so many
    /// rows, as [`Sampler::go_on`](super::Sampler::go_on) does. What is recorded stays, and
    /// later rows are added to it.
    pub fn go_on(&mut self, origin: T, rows: u64) {
        self.grid.go_on(origin, rows);
    }

    /// The states so far.
    pub fn rows(&self) -> &[State<T, N>] {
        &self.rows
    }

    /// The states, to keep.
    pub fn into_rows(self) -> Vec<State<T, N>> {
        self.rows
    }
}

impl<T: Real, const N: usize> Observer<T, N> for Recorder<T, N> {
    fn begin(
        &mut self,
        state: &State<T, N>,
        _probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        if self.grid.begin(state.t) {
            self.rows.clear();
            self.rows.push(*state);
        }
        Ok(ControlFlow::Continue(()))
    }

    fn step(
        &mut self,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        while let Some(row) = self.grid.row(step, probe)? {
            self.rows.push(row);
        }
        Ok(ControlFlow::Continue(()))
    }
}
