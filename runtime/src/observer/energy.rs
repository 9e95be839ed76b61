//! Whether the energy adds up.
//!
//! In:  steps.
//! Out: the largest difference between the energy and what it should be.
//!
//! `E(t) − E(0) = ∫ power dt`, with [`Energy::balance`] for `E`. Where nothing
//! supplies or takes power the integral is zero and isn't computed.
//!
//! [`Energy::balance`]: crate::Energy::balance

use super::quadrature::Integral;
use super::{Observer, Probe};
use crate::{DynamicsError, Energy, Real, State, Step, Watched};
use core::ops::ControlFlow;

/// What a step may be off by in units of its tolerance, so that it is not asked whether the
/// integral of the power is; the same of fixed steps, relative to the energy.
const PART: f64 = 10.0;
const OF_FIXED: f64 = 1e-6;
/// The least of both, in units of round-off.
const ROUND_OFF: f64 = 1e3;
/// What is exchanged counts as no less than this part of the energies, in units of round-off:
/// where a mechanism rests, that of many steps adds up.
const RESTS: f64 = 1e6;

/// Compares the energy with the power that was supplied.
///
/// The power is integrated over each step's interpolant by Gauss's formula of
/// order 8, on parts of it where it changes fast, so that the result is as accurate as the
/// interpolant.
#[derive(Clone, Copy, Debug)]
pub struct EnergyAudit<T> {
    start: T,
    supplied: T,
    /// What the sum of the supplied energy lost to round-off so far.
    lost: T,
    conservative: bool,
    /// By which part of the energy a step may be off before the power is integrated again.
    accuracy: T,
    error: T,
    largest: T,
    /// The potential energy at the start.
    potential: T,
    exchanged: T,
}

impl<T: Real> Default for EnergyAudit<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real> EnergyAudit<T> {
    /// Nothing seen yet.
    pub fn new() -> Self {
        Self::of(None)
    }

    /// An audit that has seen nothing yet, for steps of an accepted relative error, or of a fixed
    /// length.
    pub(crate) fn of(tolerance: Option<T>) -> Self {
        let number = T::from_f64;
        let part = tolerance.map_or(number(OF_FIXED), |tolerance| tolerance * number(PART));
        Self::with_accuracy(part.max(T::EPSILON * number(ROUND_OFF)))
    }

    fn with_accuracy(accuracy: T) -> Self {
        Self {
            start: T::zero(),
            supplied: T::zero(),
            lost: T::zero(),
            conservative: false,
            accuracy,
            error: T::zero(),
            largest: T::zero(),
            potential: T::zero(),
            exchanged: T::zero(),
        }
    }

    /// The largest difference so far (J).
    pub fn largest(&self) -> T {
        self.largest
    }

    /// The largest energy so far that was kinetic, taken from the potential energy, or supplied
    /// (J): what [`largest`](Self::largest) is to be compared with. No less than may be round-off
    /// of the energies.
    pub fn exchanged(&self) -> T {
        self.exchanged
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
        self.error = self.start - start - supplied;
        self.start = start;
        self.supplied = supplied;
    }

    /// The energy that is supplied within a step which changes the energy by so much.
    ///
    /// If that is not the same but for `least`, the step is off by it or the integral is,
    /// whose parts tell which.
    fn supplied_in<const N: usize>(
        &self,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
        change: T,
        least: T,
    ) -> Result<T, DynamicsError<T>> {
        let mut power = |t: T| {
            let power = probe.power(&step.at(t))?;
            match power.is_finite() {
                true => Ok(power),
                false => Err(DynamicsError::WatchedNotFinite {
                    t,
                    quantity: Watched::Power,
                }),
            }
        };
        let whole = Integral::over(&mut power, step.start().t, step.length())?;
        if (change - whole.value).abs() <= least {
            return Ok(whole.value);
        }
        whole.refined(&mut power, self.accuracy, least)
    }

    /// Takes note of how much energy was exchanged until a step ended with these energies.
    fn observe(&mut self, energy: &Energy<T>) {
        let Energy {
            kinetic, potential, ..
        } = *energy;
        let round_off = T::EPSILON * T::from_f64(RESTS) * (kinetic.abs() + potential.abs());
        let forms = [
            kinetic.abs(),
            (potential - self.potential).abs(),
            self.supplied.abs(),
            round_off,
        ];
        self.exchanged = forms.into_iter().fold(self.exchanged, T::max);
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

impl<T: Real, const N: usize> Observer<T, N> for EnergyAudit<T> {
    fn begin(
        &mut self,
        state: &State<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        *self = Self::with_accuracy(self.accuracy);
        let energy = probe.energy(state);
        self.start = balance(state.t, &energy)?;
        self.potential = energy.potential;
        self.observe(&energy);
        self.conservative = probe.structure().conservative;
        Ok(ControlFlow::Continue(()))
    }

    fn step(
        &mut self,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        let energy = probe.energy(step.end());
        let balance = balance(step.end().t, &energy)?;
        if !self.conservative {
            let size = energy.kinetic.abs() + energy.potential.abs() + self.supplied.abs();
            let change = balance - self.start - self.supplied - self.error;
            let supplied = self.supplied_in(step, probe, change, size * self.accuracy)?;
            self.supply(supplied);
        }
        self.error = balance - self.start - self.supplied;
        self.largest = self.largest.max(self.error.abs());
        self.observe(&energy);
        Ok(ControlFlow::Continue(()))
    }

    fn looks_inside(&self) -> bool {
        !self.conservative
    }
}
