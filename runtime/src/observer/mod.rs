//! Who watches a run.
//!
//! In:  accepted steps, and a [`Probe`] to ask the mechanism with.
//! Out: rows, audits, located passages through singular positions.
//!
//! An observer changes nothing: what it asks is computed apart from the run, and
//! the run gives the same bits with and without it.

mod constraint;
mod energy;
mod probe;
mod quadrature;
#[cfg(feature = "std")]
mod recorder;
mod sampler;

pub use constraint::ConstraintAudit;
pub use energy::EnergyAudit;
pub(crate) use energy::balance;
pub use probe::{OtherBranch, Probe};
#[cfg(feature = "std")]
pub use recorder::Recorder;
pub use sampler::{BadInterval, Grid, Sampler};

use crate::{DynamicsError, Event, Passage, Real, State, Step};
use core::ops::ControlFlow;

/// Something that happened at a time within a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occurrence<T, const N: usize> {
    /// Place of the event in [`Structure::events`](crate::Structure::events).
    pub index: usize,
    /// The event.
    pub event: &'static Event,
    /// Whether its function went up.
    pub rising: bool,
    /// The state at which its function is zero, on the constraints.
    pub state: State<T, N>,
}

/// Watches a run. Each method may break it off: the run then ends there, and its
/// summary says so.
pub trait Observer<T: Real, const N: usize> {
    /// Is shown the initial state.
    ///
    /// # Errors
    ///
    /// What the probe reports; it ends the run.
    fn begin(
        &mut self,
        _state: &State<T, N>,
        _probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        Ok(ControlFlow::Continue(()))
    }

    /// Is shown each accepted step.
    ///
    /// # Errors
    ///
    /// What the probe reports; it ends the run.
    fn step(
        &mut self,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>>;

    /// Is told of an event, before the step in which it is. Breaking off cuts the
    /// step at the event.
    fn event(&mut self, _occurrence: &Occurrence<T, N>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// Is told of a passage through a singular position, at most one step after
    /// the step in which it is.
    fn passage(&mut self, _passage: &Passage<T>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// Whether it asks for states inside a step. If nobody does, methods save the
    /// work for their interpolants.
    fn looks_inside(&self) -> bool {
        true
    }
}
