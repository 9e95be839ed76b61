//! How far off the constraints a run came.
//!
//! In:  the ends of steps.
//! Out: the largest errors.

use super::{Observer, Probe};
use crate::{ConstraintError, DynamicsError, Real, State, Step, Watched};
use core::ops::ControlFlow;

/// Keeps the largest constraint errors at the ends of steps.
#[derive(Clone, Copy, Debug, Default)]
pub struct ConstraintAudit<T> {
    largest: ConstraintError<T>,
}

impl<T: Real> ConstraintAudit<T> {
    /// Nothing seen yet.
    pub fn new() -> Self {
        Self {
            largest: ConstraintError {
                position: T::zero(),
                velocity: T::zero(),
            },
        }
    }

    /// The largest errors so far, of positions and of velocities, each on its
    /// own.
    pub fn largest(&self) -> ConstraintError<T> {
        self.largest
    }

    fn look<const N: usize>(
        &mut self,
        state: &State<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        let error = probe.constraint_error(state);
        self.largest.position = self.largest.position.max(error.position);
        self.largest.velocity = self.largest.velocity.max(error.velocity);
        if (error.position + error.velocity).is_finite() {
            Ok(ControlFlow::Continue(()))
        } else {
            let (t, quantity) = (state.t, Watched::ConstraintError);
            Err(DynamicsError::WatchedNotFinite { t, quantity })
        }
    }
}

impl<T: Real, const N: usize> Observer<T, N> for ConstraintAudit<T> {
    fn begin(
        &mut self,
        state: &State<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        *self = Self::new();
        self.look(state, probe)
    }

    fn step(
        &mut self,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        self.look(step.end(), probe)
    }

    fn looks_inside(&self) -> bool {
        false
    }
}
