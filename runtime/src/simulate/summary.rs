//! What a run did.
//!
//! In:  counts.
//! Out: [`Summary`].

use crate::{ConstraintError, Counters, Real, State, Step};
use core::fmt::{Display, Formatter};

/// What a run did, up to its end or its failure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary<T, const N: usize> {
    /// The last good state.
    pub end: State<T, N>,
    /// Accepted steps.
    pub steps: u64,
    /// Trial steps that were thrown away.
    pub rejected: u64,
    /// Accelerations.
    pub evaluations: u64,
    /// What the solver did for them; what observers asked isn't counted.
    pub counters: Counters,
    /// Events.
    pub events: u64,
    /// Passages through singular positions, if they were looked for.
    pub passages: Option<u64>,
    /// The largest constraint errors, if they were audited.
    pub constraint_error: Option<ConstraintError<T>>,
    /// The largest difference between the energy and what the power supplied
    /// makes it (J), if it was audited.
    pub energy_error: Option<T>,
    /// The largest energy that was exchanged between its forms, or supplied (J), if it was audited.
    pub energy_exchanged: Option<T>,
    /// What the power has supplied since the run began (J), if it was audited.
    pub energy_supplied: Option<T>,
    /// Whether an observer broke the run off before its end.
    pub stopped: bool,
}

impl<T: Real, const N: usize> Summary<T, N> {
    /// Nothing done yet.
    pub(super) fn at(start: State<T, N>) -> Self {
        Self {
            end: start,
            steps: 0,
            rejected: 0,
            evaluations: 0,
            counters: Counters::default(),
            events: 0,
            passages: None,
            constraint_error: None,
            energy_error: None,
            energy_exchanged: None,
            energy_supplied: None,
            stopped: false,
        }
    }

    /// Counts an accepted step.
    pub(super) fn count(&mut self, step: &Step<T, N>) {
        self.steps += 1;
        self.rejected += u64::from(step.rejected());
        self.evaluations += u64::from(step.evaluations());
    }
}

impl<T: Real, const N: usize> Display for Summary<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        let Self {
            steps,
            rejected,
            evaluations,
            ..
        } = self;
        write!(
            f,
            "t = {} s after {steps} steps, {rejected} rejected, and {evaluations} accelerations",
            self.end.t
        )?;
        if let Some(passages) = self.passages {
            write!(f, "; {passages} passages through singular positions")?;
        }
        if self.counters.undetermined > 0 {
            f.write_str(
                "; undetermined: the mechanism was at rest in a singular position, where nothing \
                 says which branch it takes",
            )?;
        }
        if let Some(ConstraintError { position, .. }) = self.constraint_error {
            write!(f, "; largest constraint error {:.1e}", position.to_f64())?;
        }
        if let Some(error) = self.energy_error {
            write!(f, "; energy balance off by {:.1e} J", error.to_f64())?;
        }
        Ok(())
    }
}
