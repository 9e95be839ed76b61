//! Accepted states back onto the constraints: positions, then velocities.
//!
//! In:  a state that a step left off the constraints by its local error.
//! Out: the nearest position with `g = 0` to round-off, in the metric of the
//!      kinetic energy, and the nearest velocity with `A q̇ + b = 0` there.
//!
//! Not here: what to do where rows of `A` vanish ([`settle`]).

mod settle;

use crate::dynamics::{Solver, Source, Which};
use crate::linalg::{acceptable, on_constraint, passes, weak};
use crate::{DynamicsError, Mechanism, Real, Stabilisation, State};
use nalgebra::SVector;

/// Corrections after which a position is given up.
const MAX_ITERATIONS: usize = 20;

/// Reduction of the residual by one correction, above which the constraints are
/// factorised anew for the next.
const SLOW: f64 = 0.1;

impl<T: Real, const N: usize, const R: usize> Solver<T, N, R> {
    /// Projects an accepted state, if the settings say so.
    pub(crate) fn project<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if R == 0 || self.settings.stabilisation != Stabilisation::Projection {
            return Ok(());
        }
        if !self.is_prepared() {
            self.prepare(mechanism, state)?;
        }
        self.counters.projections += 1;
        self.observe_reach(mechanism, state);
        (self.safe, self.bridged) = (None, None);
        if let Some(squared) = self.emitted_landing(mechanism, state) {
            self.observe_sine(squared);
            self.expected = !self.near;
        } else {
            let squared = self.land_without_emitted(mechanism, state)?;
            self.observe_sine(squared);
            self.expect_regular();
        }
        if self.safe.is_none() {
            self.counters.robust_projections += 1;
            if self.bridged.is_none() {
                self.learn(mechanism, state)?;
            }
        }
        if state.is_finite() {
            Ok(())
        } else {
            Err(DynamicsError::NotFinite { t: state.t })
        }
    }

    /// Brings a state onto the constraints and returns the smallest squared sine of
    /// the constraints there. Where that is safe it is noted, and the factors are
    /// kept for the acceleration at the same position.
    pub(crate) fn land<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Result<T, DynamicsError<T>> {
        (self.safe, self.bridged) = (None, None);
        match self.emitted_landing(mechanism, state) {
            Some(squared) => Ok(squared),
            None => self.land_without_emitted(mechanism, state),
        }
    }

    /// As [`land`](Self::land), where emitted code does not serve.
    #[inline(never)]
    fn land_without_emitted<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Result<T, DynamicsError<T>> {
        if let Some(squared) = self.land_by_iteration(mechanism, state)? {
            return Ok(squared);
        }
        if self.bridge(mechanism, state)? {
            return Ok(T::zero());
        }
        self.settle(mechanism, state)?;
        Ok(self.factorise_constraints(Source::Position, Which::All))
    }

    /// As [`land`](Self::land) where the constraints are regular; none if they are
    /// not, and the state is anywhere.
    pub(crate) fn land_regular<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Result<Option<T>, DynamicsError<T>> {
        match self.emitted_landing(mechanism, state) {
            Some(squared) => Ok(Some(squared)),
            None => self.land_by_iteration(mechanism, state),
        }
    }

    /// As [`land_regular`](Self::land_regular), without emitted code.
    fn land_by_iteration<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Result<Option<T>, DynamicsError<T>> {
        if self.project_position(mechanism, state)? {
            self.factorise_metric(mechanism, Source::Position, state.t)?;
            let squared = self.factorise_constraints(Source::Position, Which::All);
            if passes(squared, weak()) {
                self.project_velocity(state);
                return Ok(Some(squared));
            }
        }
        Ok(None)
    }

    /// Newton's iteration on `g = 0`; leaves the terms of the final position in
    /// the buffer. `false` if it came too near a singular position to go on.
    ///
    /// The factors of one iteration serve the next as long as they reduce the
    /// residual well.
    fn project_position<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Result<bool, DynamicsError<T>> {
        let mut before: Option<T> = None;
        for _ in 0..MAX_ITERATIONS {
            mechanism.position(state, &mut self.position);
            let worst = self.finite_residual(state)?;
            if self.is_on_constraints(worst, before) {
                return Ok(true);
            }
            if before.is_none_or(|before| worst > before * T::from_f64(SLOW)) {
                self.factorise_metric(mechanism, Source::Position, state.t)?;
                let squared = self.factorise_constraints(Source::Position, Which::Holonomic);
                if !passes(squared, weak()) {
                    return Ok(false);
                }
            }
            self.counters.projection_iterations += 1;
            let mut w = [T::zero(); N];
            self.lifted.correct(&mut w, &-self.position.residual);
            state.q += self.lower(w);
            before = Some(worst);
        }
        Err(self.failed(mechanism, state))
    }

    /// One linear solve for `A q̇ + b = 0` with the factors of the position in the
    /// buffer, which are kept.
    fn project_velocity(&mut self, state: &mut State<T, N>) {
        let gap = -(self.position.jacobian * state.v + self.position.drift);
        let mut w = [T::zero(); N];
        self.lifted.correct(&mut w, &gap);
        state.v += self.lower(w);
        self.safe_at(state, true);
    }

    /// Whether the largest constraint error is round-off, or no longer grows smaller
    /// and is small enough.
    pub(crate) fn is_on_constraints(&self, worst: T, before: Option<T>) -> bool {
        let stuck = before.is_some_and(|before| worst > before / T::from_f64(2.0));
        let enough = on_constraint::<T>() * self.round_off();
        worst <= enough || stuck && worst <= acceptable::<T>() * self.reach
    }

    /// The largest of some constraint errors, as a length in the metric, and its row.
    /// Not finite if any row is not.
    pub(crate) fn residual(&self, residual: &SVector<T, R>) -> (T, usize) {
        let mut worst = (T::zero(), 0);
        for row in 0..R {
            let size = residual[row].abs() * self.rows.scale(row);
            if size > worst.0 || !size.is_finite() {
                worst = (size, row);
            }
        }
        worst
    }

    /// The largest constraint error, or an error if it is not finite.
    fn finite_residual(&self, state: &State<T, N>) -> Result<T, DynamicsError<T>> {
        let (worst, _) = self.residual(&self.position.residual);
        if worst.is_finite() {
            Ok(worst)
        } else {
            Err(DynamicsError::NotFinite { t: state.t })
        }
    }

    /// The error of a projection that gives up at the position in the buffer.
    fn failed<M: Mechanism<T, N, R> + ?Sized>(
        &self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> DynamicsError<T> {
        let (_, row) = self.residual(&self.position.residual);
        let residual = self.position.residual[row].abs();
        DynamicsError::ProjectionFailed {
            t: state.t,
            residual,
            row,
            structure: mechanism.structure(),
        }
    }

    /// The round-off of a position, as a length in the metric.
    fn round_off(&self) -> T {
        T::EPSILON * self.reach
    }
}
