//! Accepted states back onto the constraints: positions, then velocities.
//!
//! In:  a state that a step left off the constraints by its local error.
//! Out: the nearest position with `g = 0` to round-off, in the metric of the
//!      kinetic energy, and the nearest velocity with `A q̇ + b = 0` there.
//!
//! Not here: what to do where rows of `A` are near-dependent
//! ([`crate::dynamics`], `follow.rs`), and where their gradients jump (`kink.rs`).

use crate::dynamics::{CoordinateScale, Core, MAX_ITERATIONS, Source, Which};
use crate::tolerance::{contraction, critical, negligible, passes, regular, round_off, window};
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::SVector;

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Projects a state, if the settings say so, past another sheet where that is nearer.
    pub(crate) fn project<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        self.session.trial.strays = false;
        if R == 0 || self.session.at_rest {
            return finite(state);
        }
        if !self.is_prepared() {
            self.prepare(&mechanism, state)?;
        }
        if self.session.chart.is_some() && self.follows() && self.is_beside() {
            let mut placed = *state;
            self.project_onto_sheet(&mechanism, &mut placed)?;
            if self.is_projected() {
                self.counters.projections += 1;
                *state = placed;
            }
        } else if self.is_projected() {
            let stepped = *state;
            self.project_regular(mechanism, state)?;
            if self.session.trial.is_moved {
                self.verify_smooth(&mechanism, &stepped, state)?;
            }
            if !self.rows.all_independent() {
                self.verify_velocity(&mechanism, state)?;
            }
            self.counters.projections += 1;
        } else {
            self.session.trial.end = self.sine_where_it_is(&mechanism, state)?;
        }
        finite(state)
    }

    /// Projects a state where the constraints are regular.
    fn project_regular<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        self.safe = None;
        self.session.trial.is_moved = false;
        let emitted = self.emitted_projection(mechanism, state)?;
        self.session.trial.by_emitted = emitted.is_some();
        let squared = match emitted {
            Some(squared) => squared,
            None => {
                self.expected = false;
                self.session.trial.is_moved = true;
                self.project_by_iteration(&mechanism, state)?
            }
        };
        self.session.trial.end = squared;
        Ok(())
    }

    /// Refuses velocities that redundant rows contradict: what is projected satisfies the chosen
    /// rows.
    #[inline(never)]
    fn verify_velocity(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        // The runtime's own projection has evaluated this position last.
        if self.session.trial.by_emitted {
            mechanism.position(state, &mut self.position);
        }
        let error = self.position.speed(&state.v);
        let (worst, row) = self.residual(&error);
        let (driven, _) = self.residual(&self.position.drift);
        let rate = self.metric.factor.length(&state.v.data.0[0]) + driven;
        // What would take 1e31 s to move it by its size is at rest: there round-off would be compared
        // with round-off.
        let rest = self.coordinate_scale.range * T::EPSILON * T::EPSILON;
        // A comparison with NaN is false, so that an error that is NaN is refused.
        match worst <= regular::<T>() * rate + rest {
            true => Ok(()),
            false => Err(violated(mechanism, state, (row, error[row].abs()))),
        }
    }

    /// The squared sine at a state that nothing projects. The factors also serve the acceleration
    /// there.
    #[inline(never)]
    fn sine_where_it_is(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<T, DynamicsError<T>> {
        mechanism.position(state, &mut self.position);
        let squared = self.sine_at_end(mechanism, state)?;
        if !passes(squared, window()) {
            return self.leave_to_chart(mechanism, state, squared);
        }
        self.safe = Some((state.t, state.q));
        Ok(squared)
    }

    /// The squared sine at the end of a trial step, whose position is in the buffer, with the
    /// factors.
    fn sine_at_end(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        end: &State<T, N>,
    ) -> Result<T, DynamicsError<T>> {
        self.factorise_trial(mechanism, Source::Position, end.t)?;
        let squared = self.factorise_constraints(Source::Position, Which::All);
        self.session.trial.lowest = self.session.trial.lowest.min(squared);
        Ok(squared)
    }

    /// Newton's iteration on `g = 0`, then one linear solve for `A q̇ + b = 0`; the
    /// squared sine there.
    ///
    /// The factors of one iteration serve the next as long as they reduce the residual well;
    /// the last ones also serve the acceleration at the same position.
    #[inline(never)]
    fn project_by_iteration(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &mut State<T, N>,
    ) -> Result<T, DynamicsError<T>> {
        let mut before: Option<T> = None;
        for _ in 0..MAX_ITERATIONS {
            mechanism.position(state, &mut self.position);
            let worst = self.finite_residual(state)?;
            if self.is_on_constraints(worst, before) {
                let squared = self.sine_at_end(mechanism, state)?;
                if !passes(squared, window()) {
                    return self.leave_to_chart(mechanism, state, squared);
                }
                self.project_velocity(state);
                return Ok(squared);
            }
            if before.is_none_or(|before| worst > before * contraction()) {
                self.factorise_trial(mechanism, Source::Position, state.t)?;
                let squared = self.factorise_constraints(Source::Position, Which::Holonomic);
                if !passes(squared, window()) {
                    return self.leave_to_chart(mechanism, state, squared);
                }
            }
            self.counters.projection_iterations += 1;
            let mut w = [T::zero(); N];
            self.schur.correct(&mut w, &-self.position.residual);
            state.q += self.lower(w);
            before = Some(worst);
        }
        Err(self.failed(mechanism, state))
    }

    /// Near a singular configuration: the published method leaves the state where it is.
    #[cold]
    fn leave_to_chart(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        squared: T,
    ) -> Result<T, DynamicsError<T>> {
        if !self.follows() {
            return Ok(squared);
        }
        Err(self.want_chart(mechanism, state.t))
    }

    /// One linear solve for `A q̇ + b = 0` with the factors of the position in the
    /// buffer, which are kept.
    fn project_velocity(&mut self, state: &mut State<T, N>) {
        let gap = -self.position.speed(&state.v);
        let mut w = [T::zero(); N];
        self.schur.correct(&mut w, &gap);
        state.v += self.lower(w);
        self.safe = Some((state.t, state.q));
    }

    /// Whether the largest constraint error is round-off, or no longer grows smaller
    /// and is small enough.
    pub(crate) fn is_on_constraints(&self, worst: T, before: Option<T>) -> bool {
        let stuck = before.is_some_and(|before| worst > before / T::from_f64(2.0));
        worst <= round_off::<T>() * self.coordinate_scale.size || stuck && self.is_negligible(worst)
    }

    /// Whether a constraint error is small enough, if it can't be smaller.
    pub(crate) fn is_negligible(&self, worst: T) -> bool {
        let CoordinateScale { size, range, .. } = self.coordinate_scale;
        worst <= (negligible::<T>() * range).max(round_off::<T>() * critical() * size)
    }

    /// The largest of some constraint errors, as a length in the metric, and its row.
    /// Not finite if any row is not.
    pub(crate) fn residual(&self, residual: &SVector<T, R>) -> (T, usize) {
        let mut worst = (T::zero(), 0);
        for row in 0..R {
            let size = residual[row].abs() * self.rows.scale[row];
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

    /// The error of a projection by emitted code that gives up at a state: the same iteration
    /// with other factors would not end either.
    #[cold]
    #[inline(never)]
    pub(crate) fn lost(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> DynamicsError<T> {
        mechanism.position(state, &mut self.position);
        match self.finite_residual(state) {
            Ok(_) => self.failed(mechanism, state),
            Err(error) => error,
        }
    }

    /// The error of a projection that gives up at the position in the buffer.
    pub(crate) fn failed(
        &self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> DynamicsError<T> {
        let (_, row) = self.residual(&self.position.residual);
        violated(mechanism, state, (row, self.position.residual[row].abs()))
    }
}

/// The error of a row that is violated by so much at a state.
pub(crate) fn violated<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    state: &State<T, N>,
    (row, residual): (usize, T),
) -> DynamicsError<T> {
    DynamicsError::ProjectionFailed {
        t: state.t,
        residual,
        row,
        structure: mechanism.structure(),
    }
}

/// Refuses a state that is not finite.
fn finite<T: Real, const N: usize>(state: &State<T, N>) -> Result<(), DynamicsError<T>> {
    if state.is_finite() {
        Ok(())
    } else {
        Err(DynamicsError::NotFinite { t: state.t })
    }
}
