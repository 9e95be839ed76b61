//! Whether the energy adds up.
//!
//! In:  steps.
//! Out: the largest difference between the energy and what it should be.
//!
//! `E(t) − E(0) = ∫ power dt`, with [`Energy::balance`] for `E`. Where nothing
//! supplies or takes power the integral is zero and isn't computed.
//!
//! [`Energy::balance`]: crate::Energy::balance

use super::{Observer, Probe};
use crate::{DynamicsError, Energy, Real, State, Step, Watched};
use core::ops::ControlFlow;

/// Compares the energy with the power that was supplied.
///
/// The power is integrated over each step's interpolant by Gauss's formula of
/// order 8, so that the result is as accurate as the interpolant.
#[derive(Clone, Copy, Debug, Default)]
pub struct EnergyAudit<T> {
    start: T,
    supplied: T,
    /// What the sum of the supplied energy lost to round-off so far.
    lost: T,
    conservative: bool,
    error: T,
    largest: T,
}

impl<T: Real> EnergyAudit<T> {
    /// Nothing seen yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The largest difference so far (J).
    pub fn largest(&self) -> T {
        self.largest
    }

    /// The difference at the end of the last step (J), with its sign.
    pub fn last(&self) -> T {
        self.error
    }

    /// The energy supplied so far (J).
    pub fn supplied(&self) -> T {
        self.supplied
    }

    /// Goes on where the audit of an earlier part of the run ended: from the energy
    /// at its start and what was supplied since (J).
    pub(crate) fn go_on(&mut self, start: T, supplied: T) {
        self.start = start;
        self.supplied = supplied;
    }

    /// Adds to the supplied energy without losing small parts (Kahan).
    fn supply(&mut self, energy: T) {
        let part = energy - self.lost;
        let sum = self.supplied + part;
        self.lost = (sum - self.supplied) - part;
        self.supplied = sum;
    }
}

/// The energy whose balance is kept, or which of its parts is not finite.
pub(crate) fn balance<T: Real>(t: T, energy: &Energy<T>) -> Result<T, DynamicsError<T>> {
    if energy.balance.is_finite() {
        return Ok(energy.balance);
    }
    let quantity = if energy.kinetic.is_finite() {
        Watched::PotentialEnergy
    } else {
        Watched::KineticEnergy
    };
    Err(DynamicsError::WatchedNotFinite { t, quantity })
}

/// Gauss's formula with four nodes on [0, 1], exact for polynomials of degree 7:
/// `(node, weight)`.
fn gauss<T: Real>() -> [(T, T); 4] {
    let number = T::from_f64;
    let root = number(2.0) / number(7.0) * (number(6.0) / number(5.0)).sqrt();
    let inner = (number(3.0) / number(7.0) - root).sqrt() / number(2.0);
    let outer = (number(3.0) / number(7.0) + root).sqrt() / number(2.0);
    let half = number(0.5);
    let part = number(30.0).sqrt() / number(72.0);
    let (more, less) = (number(0.25) + part, number(0.25) - part);
    [
        (half - outer, less),
        (half - inner, more),
        (half + inner, more),
        (half + outer, less),
    ]
}

impl<T: Real, const N: usize> Observer<T, N> for EnergyAudit<T> {
    fn begin(
        &mut self,
        state: &State<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        *self = Self::default();
        self.start = balance(state.t, &probe.energy(state))?;
        self.conservative = probe.structure().conservative;
        Ok(ControlFlow::Continue(()))
    }

    fn step(
        &mut self,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        if !self.conservative {
            let h = step.length();
            let mut mean = T::zero();
            for (node, weight) in gauss::<T>() {
                let t = step.start().t + h * node;
                let power = probe.power(&step.at(t))?;
                if !power.is_finite() {
                    let quantity = Watched::Power;
                    return Err(DynamicsError::WatchedNotFinite { t, quantity });
                }
                mean += weight * power;
            }
            self.supply(mean * h);
        }
        let balance = balance(step.end().t, &probe.energy(step.end()))?;
        self.error = balance - self.start - self.supplied;
        self.largest = self.largest.max(self.error.abs());
        Ok(ControlFlow::Continue(()))
    }

    fn looks_inside(&self) -> bool {
        !self.conservative
    }
}
