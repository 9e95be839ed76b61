//! Whether the energy of a trial step changed as the forces say.
//!
//! In:  the ends of a trial step with a chart, or of one that may need it.
//! Out: nothing, or a refusal: the motion left its sheet.

use super::Core;
use crate::linalg::is_zero;
use crate::singular::Obstacle;
use crate::{DynamicsError, Mechanism, Real, State};

/// Energy that a step may lose, in units of its tolerance. By experiment: with more, steps cut
/// the corners of narrow gaps; with less, round-off in gaps ends runs.
const ENERGY: f64 = 10.0;
/// Energy that a step of fixed length may lose, relative to the kinetic energy.
const ENERGY_OF_FIXED: f64 = 1e-4;
/// A step rests if nothing moves by more than this part of how far it may in one that is not long,
/// in units of round-off.
const REST: f64 = 1e3;
/// Round-off of the energy, in units of that of a number.
const ENERGY_ROUND_OFF: f64 = 1e3;

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// By how much the power of forces with their conditions held, as they are in a step, differs at
    /// both of its ends from what the states say.
    #[inline(never)]
    pub(super) fn held_powers(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        ends: [&State<T, N>; 2],
    ) -> Result<[T; 2], DynamicsError<T>> {
        let mut more = [T::zero(); 2];
        if self.conditions.decided.list.is_empty() {
            return Ok(more);
        }
        for (more, state) in more.iter_mut().zip(ends) {
            if self.conditions.decided.sliding != 0 {
                // The weights of the forces are those of this state.
                self.sliding_acceleration(mechanism, state)?;
            }
            *more = self.held_power(mechanism, state);
        }
        Ok(more)
    }

    /// The energy must not have changed by more than the power that was supplied and the
    /// accepted error explain. Constraints that move do work of their own, and are not
    /// judged.
    #[inline(never)]
    pub(super) fn verify_energy(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        (start, end): (&State<T, N>, &State<T, N>),
        held: [T; 2],
    ) -> Result<(), DynamicsError<T>> {
        if self.rests(start, end) {
            return Ok(());
        }
        // A law of time may stop at either end.
        let still = mechanism.structure().scleronomic;
        for state in [start, end].into_iter().skip(usize::from(still)) {
            mechanism.position(state, &mut self.position);
            if !is_zero(self.position.drift.as_slice()) {
                return Ok(());
            }
        }
        let (mut before, mut after) = (mechanism.energy(start), mechanism.energy(end));
        (before.power, after.power) = (before.power + held[0], after.power + held[1]);
        let half = (end.t - start.t) * T::from_f64(0.5);
        // By the trapezoidal rule, whose error is less than what the power changes by.
        let supplied = half * (before.power + after.power);
        let uncertainty = half * (after.power - before.power).abs();
        let kinetic = before.kinetic.max(after.kinetic);
        let potential = (after.potential - before.potential).abs();
        let size = kinetic.max(potential);
        let part = match self.session.tolerance {
            Some(tolerance) => tolerance * T::from_f64(ENERGY),
            None => T::from_f64(ENERGY_OF_FIXED),
        };
        // Forces that hold a body do work one against the other.
        let terms = before.balance.abs() + size + half * (held[0].abs() + held[1].abs());
        let round_off = T::from_f64(ENERGY_ROUND_OFF) * T::EPSILON * terms;
        let change = (after.balance - before.balance - supplied).abs();
        // A comparison with NaN is false, so that an energy that is NaN does not count as kept.
        let kept = change <= part * size + uncertainty + round_off;
        if kept {
            Ok(())
        } else {
            Err(self.refusal(mechanism, Obstacle::LeftSheet, end.t))
        }
    }

    /// Whether a mechanism rests, as friction holds it: at the speeds at both ends no coordinate
    /// would move by more than round-off. The energies of such speeds are no measure of each other.
    fn rests(&self, start: &State<T, N>, end: &State<T, N>) -> bool {
        let length = end.t - start.t;
        let there = [start, end].map(|state| State {
            q: start.q + state.v * length,
            ..*state
        });
        let stretch = there.iter().map(|there| self.stretch(start, there));
        let most = stretch.fold(self.stretch(start, end), |most: T, one| most.max(one));
        most <= T::from_f64(REST) * T::EPSILON
    }
}
