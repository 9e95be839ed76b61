//! The cheap path in code that was written for this mechanism.
//!
//! In:  a mechanism that provides [`Mechanism::regular`] and
//!      [`Mechanism::correction`].
//! Out: accelerations and projections by them, where the pivots they hand out are
//!      safe.
//!
//! Not here: what happens elsewhere, and for mechanisms whose rows are redundant
//! everywhere, whose pivots are never safe.

use super::Solver;
use crate::linalg::{definite, guard, passes, straight, weak};
use crate::state::all_finite;
use crate::{DynamicsError, Form, Mechanism, Pivots, Real, Stabilisation, State};
use nalgebra::SVector;

/// Corrections after which the general projection takes over.
const MAX_ITERATIONS: usize = 8;

impl<T: Real, const N: usize, const R: usize> Solver<T, N, R> {
    /// Whether emitted code may be asked for accelerations and projections.
    fn asks_emitted(&self) -> bool {
        self.emitted
            && self.settings.form == Form::Reduced
            && !matches!(self.settings.stabilisation, Stabilisation::Baumgarte { .. })
            && self.rows.all_independent()
            && self.metric.is_of_mass_alone()
    }

    /// The acceleration by emitted code, if there is any and it is safe here.
    #[inline(always)]
    pub(super) fn emitted_acceleration<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Option<SVector<T, N>> {
        if !self.asks_emitted() || self.near && !self.is_safe_at(state) {
            return None;
        }
        self.emitted = mechanism.regular(state, &mut self.regular);
        if !self.emitted {
            return None;
        }
        let squared = squared_sine(&self.regular.pivots, &mut self.rows);
        self.observe_lowest(squared);
        self.begin(squared);
        let trusted = passes(squared, guard()) || passes(squared, weak()) && self.is_safe_at(state);
        let acceleration = &self.regular.acceleration;
        (trusted && all_finite(acceleration)).then_some(*acceleration)
    }

    /// Brings a state onto the constraints by emitted code and returns the squared
    /// sine there; none if there is no such code or it is not safe.
    pub(crate) fn emitted_landing<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Option<T> {
        if !self.asks_emitted() {
            return None;
        }
        let mut before = None;
        for _ in 0..MAX_ITERATIONS {
            if !mechanism.correction(state, &mut self.correction) {
                return None;
            }
            let squared = squared_sine(&self.correction.pivots, &mut self.rows);
            self.observe_lowest(squared);
            let (worst, _) = self.residual(&self.correction.residual);
            if !passes(squared, weak()) || !worst.is_finite() {
                return None;
            }
            let landed = self.is_on_constraints(worst, before);
            if !landed {
                self.counters.projection_iterations += 1;
                state.q += self.correction.position;
            }
            if landed || self.is_straight(worst, squared, &state.v) {
                state.v += self.correction.velocity;
                self.safe_at(state, false);
                return Some(squared);
            }
            before = Some(worst);
        }
        None
    }

    /// Whether the constraints are straight, to round-off, over the corrections of the
    /// residual and of the velocities, so that the state is on them after one.
    #[inline]
    fn is_straight(&self, worst: T, squared_sine: T, velocities: &SVector<T, N>) -> bool {
        let [corrections] = &self.correction.velocity.data.0;
        let [velocities] = &velocities.data.0;
        let (mut turned, mut whole) = (T::zero(), T::zero());
        for ((weight, dv), v) in self.weights.iter().zip(corrections).zip(velocities) {
            turned = (*weight * *dv).mul_add(*dv, turned);
            whole = (*weight * *v).mul_add(*v, whole);
        }
        // The squares of the lengths of a correction and of a position.
        let (moved, reach) = (worst * worst, squared_sine * self.reach * self.reach);
        let (most, round_off) = (straight::<T>(), T::EPSILON);
        moved <= most * most * reach && moved * turned <= round_off * round_off * reach * whole
    }

    #[inline]
    fn observe_lowest(&mut self, squared: T) {
        if squared < self.lowest {
            self.lowest = squared;
        }
    }

    /// An acceleration at a state on the constraints, where the rows are safely
    /// independent.
    pub(super) fn landed_acceleration<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        self.counters.landed_accelerations += 1;
        self.regular_landed(mechanism, state)
    }

    /// As [`landed_acceleration`](Self::landed_acceleration), without counting.
    pub(super) fn regular_landed<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        if let Some(acceleration) = self.emitted_acceleration(mechanism, state) {
            return Ok(acceleration);
        }
        mechanism.terms(state, &mut self.terms);
        let bias = self.stabilised_bias(mechanism, state);
        if !self.is_factored_at(state) {
            self.factorise_terms(mechanism, state)?;
        }
        Ok(self.regular_acceleration(&bias))
    }
}

/// The smallest squared sine that emitted pivots show, zero if the mass matrix is
/// not safely definite; takes note of the sizes of the rows.
#[inline]
fn squared_sine<T: Real, const N: usize, const R: usize>(
    pivots: &Pivots<T, N, R>,
    rows: &mut super::Rows<T, R>,
) -> T {
    let mut sound = true;
    // Pivots that are diagonal entries themselves are not written.
    let [masses] = &pivots.mass_pivots.data.0;
    let [diagonal] = &pivots.mass_diagonal.data.0;
    for (pivot, whole) in masses.iter().zip(diagonal) {
        sound &= *pivot >= definite::<T>() * *whole;
    }
    let mut smallest = T::one();
    for row in 0..R {
        rows.observe(row, pivots.row_squares.data.0[0][row]);
        let ratio = pivots.row_pivots.data.0[0][row] / rows.size(row);
        sound &= ratio.is_finite();
        if ratio < smallest {
            smallest = ratio;
        }
    }
    if sound { smallest } else { T::zero() }
}
