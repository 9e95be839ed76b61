//! Accepted states back onto the constraints: positions, then velocities.
//!
//! In:  a state that a step left off the constraints by its local error.
//! Out: the nearest position with `g = 0` to round-off, in the metric of the
//!      kinetic energy, and the nearest velocity with `A q̇ + b = 0` there.
//!
//! Near a singular position the nearest position may lie on another branch, and a
//! row of size `σ` turns round-off `ε` into a change `ε/σ`. So there a state is
//! moved across its branch only, never along it, and only for a residual that is
//! well above its own round-off. What is left uncorrected is smaller than what the
//! constraint equations can show.

use crate::dynamics::{Limit, Solver, Source, Tangent, Which};
use crate::linalg::{
    acceptable, on_constraint, passes, same_branch, significant, truncation, weak,
};
use crate::{DynamicsError, Mechanism, Real, Stabilisation, State};
use nalgebra::SVector;

/// Corrections after which a position is given up.
const MAX_ITERATIONS: usize = 20;

/// Reduction of the residual by one correction, above which the constraints are
/// factorised anew for the next.
const SLOW: f64 = 0.1;

impl<T: Real, const N: usize, const R: usize> Solver<T, N, R> {
    /// Projects a state, if the settings say so.
    pub(crate) fn project<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if R == 0 || self.settings.stabilisation != Stabilisation::Projection {
            return Ok(());
        }
        self.prepare(mechanism, state)?;
        self.counters.projections += 1;
        self.reach = self.reach.max(self.metric.factor.length(&state.q.data.0[0]));
        self.unsure = false;
        self.project_position(mechanism, state)?;
        if !self.project_velocity(mechanism, state)? {
            self.counters.robust_projections += 1;
            self.learn(mechanism, state)?;
        }
        if state.is_finite() {
            Ok(())
        } else {
            Err(DynamicsError::NotFinite { t: state.t })
        }
    }

    /// The nearest state on the constraints, for an acceleration near a singular
    /// position, and whether it is one: a state too far across its branch stays
    /// where it is.
    pub(crate) fn land<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<(State<T, N>, Limit), DynamicsError<T>> {
        if !self.settings.branch_rows {
            return Ok((*state, Limit::Regular));
        }
        let mut landed = *state;
        self.unsure = false;
        match self.project_position(mechanism, &mut landed) {
            Err(DynamicsError::ProjectionFailed { .. }) => return Ok((*state, Limit::Regular)),
            other => other?,
        }
        self.project_velocity(mechanism, &mut landed)?;
        let limit = if self.unsure { Limit::Regular } else { Limit::Landed };
        Ok((landed, limit))
    }

    /// Newton's iteration on `g = 0`; leaves the terms of the final position in
    /// the buffer. The factors of one iteration serve the next as long as they
    /// reduce the residual well.
    fn project_position<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        let mut before: Option<T> = None;
        let mut cheap = false;
        for iteration in 0..=MAX_ITERATIONS {
            mechanism.position(state, &mut self.position);
            let (worst, row) = self.residual();
            if !worst.is_finite() {
                return Err(DynamicsError::NotFinite { t: state.t });
            }
            let stuck = before.is_some_and(|before| worst > before / T::from_f64(2.0));
            let enough = on_constraint::<T>() * self.round_off();
            if worst <= enough || stuck && worst <= acceptable::<T>() * self.reach {
                return Ok(());
            }
            if iteration == MAX_ITERATIONS {
                let residual = self.position.residual[row].abs();
                return Err(DynamicsError::ProjectionFailed {
                    t: state.t,
                    residual,
                    row,
                });
            }
            if before.is_none_or(|before| worst > before * T::from_f64(SLOW)) {
                self.factorise_metric(mechanism, Source::Position, state.t)?;
                let squared = self.factorise_constraints(Source::Position, Which::Holonomic);
                cheap = passes(squared, weak());
            }
            self.counters.projection_iterations += 1;
            state.q += if cheap {
                let mut w = [T::zero(); N];
                self.lifted.correct(&mut w, &-self.position.residual);
                self.lower(w)
            } else {
                self.singular_position_correction(mechanism, state)?
            };
            before = Some(worst);
        }
        Ok(())
    }

    /// One linear solve for `A q̇ + b = 0` at the position in the buffer; whether it
    /// took the cheap path. Then its factors are kept for the acceleration at the
    /// same position.
    fn project_velocity<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
) -> Result<bool, DynamicsError<T>> {
        self.factored = None;
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        let squared = self.factorise_constraints(Source::Position, Which::All);
        let cheap = passes(squared, weak());
        let gap = -(self.position.jacobian * state.v + self.position.drift);
        if cheap {
            let mut w = [T::zero(); N];
            self.lifted.correct(&mut w, &gap);
            state.v += self.lower(w);
            self.factored = Some((state.t, state.q));
        } else {
            state.v += self.singular_velocity_correction(mechanism, state, &gap)?;
        }
        Ok(cheap)
    }

    /// The change of position across the branch that closes the residual, as far
    /// as the residual means something.
    fn singular_position_correction<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        let tangent = self.refined_tangent(mechanism, state, Which::Holonomic)?;
        let uncertainty = significant::<T>() * self.round_off();
        let speed = self.metric.factor.length(&state.v.data.0[0]) * T::from_f64(3.0);
        let (rate, mut unsure) = (tangent.rate(), false);
        let worth = |value: T, size: T| {
            let means_something = value > truncation() && size > uncertainty;
            let near = size * rate <= same_branch::<T>() * value * value * speed;
            unsure |= means_something && !near;
            means_something && near
        };
        let gap = self.scaled(&-self.position.residual);
        let w = tangent.close(&gap, worth);
        self.unsure |= unsure;
        Ok(self.lower(w))
    }

    /// The change of velocity across the branch that closes the velocity level.
    ///
    /// Across the branch the position is known only to `ε/σ`, and where the rows
    /// change at the rate `k` the velocity level then has an error of `k ε/σ` that
    /// no velocity is to blame for.
    fn singular_velocity_correction<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        gap: &SVector<T, R>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let tangent = self.refined_tangent(mechanism, state, Which::All)?;
        let speed = T::EPSILON * self.metric.factor.length(&state.v.data.0[0]);
        let off = self.round_off().max(self.residual().0);
        let rate = tangent.rate();
        let worth = |value: T, size: T| {
            value > truncation() && size > significant::<T>() * (speed + rate * off / value)
        };
        Ok(self.lower(tangent.close(&self.scaled(gap), worth)))
    }

    /// The tangent space at the position in the buffer, its weak directions as the
    /// rows see them.
    fn refined_tangent<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        which: Which,
    ) -> Result<Tangent<T, N, R>, DynamicsError<T>> {
        let mut tangent =
            self.tangent(mechanism, state, Source::Position, which, Limit::Regular)?;
        let not_finite = |_| DynamicsError::NotFinite { t: state.t };
        tangent.refine().map_err(not_finite)?;
        Ok(tangent)
    }

    /// The largest constraint error at the position in the buffer, as a length in
    /// the metric, and its row. Not finite if any row is not.
    fn residual(&self) -> (T, usize) {
        let mut worst = (T::zero(), 0);
        for row in 0..R {
            let size = self.position.residual[row].abs() * self.rows.scale(row);
            if size > worst.0 || !size.is_finite() {
                worst = (size, row);
            }
        }
        worst
    }

    /// The round-off of a position, as a length in the metric.
    fn round_off(&self) -> T {
        T::EPSILON * self.reach
    }
}
