//! From a state to its acceleration: what all forms have in common.
//!
//! In:  a mechanism and a state.
//! Out: `q̈`, finite or an error.
//!
//! Not here: the forms, which have a file each.

use super::{Core, Source};
use crate::state::all_finite;
use crate::tolerance::{passes, window};
use crate::{DynamicsError, Form, Mechanism, Real, Stabilisation, State};
use nalgebra::SVector;

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// The acceleration in the form of the settings.
    #[inline(always)]
    pub(crate) fn acceleration<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let mut acceleration = SVector::zeros();
        if self.expected && passes(self.evaluate(mechanism, state, &mut acceleration), window()) {
            self.counters.cheap_accelerations += 1;
        } else {
            acceleration = self.careful_acceleration(&mechanism, state)?;
        }
        Ok(acceleration)
    }

    /// The acceleration where emitted code may not be called before anything else is asked, or was
    /// not safe.
    #[inline(never)]
    fn careful_acceleration(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        if !self.is_prepared() {
            self.prepare(mechanism, state)?;
        }
        if self.session.at_rest {
            return self.acceleration_at_rest(mechanism, state);
        }
        if let Some(acceleration) = self.emitted_acceleration(mechanism, state) {
            self.counters.cheap_accelerations += 1;
            self.expect_regular();
            return Ok(acceleration);
        }
        self.general_acceleration(mechanism, state)
    }

    /// The acceleration by the runtime's own solves.
    fn general_acceleration(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let acceleration = if R == 0 {
            self.unconstrained(mechanism, state)?
        } else {
            match self.settings.form {
                Form::Reduced => self.reduced(mechanism, state)?,
                Form::Full => self.full(mechanism, state)?,
                Form::Multipliers => self.multipliers(mechanism, state)?,
                Form::Partitioning => self.partitioning(mechanism, state)?,
            }
        };
        if all_finite(&acceleration) {
            Ok(acceleration)
        } else {
            Err(DynamicsError::NotFinite { t: state.t })
        }
    }

    /// `M q̈ = p₁`, for a mechanism without constraints.
    #[inline(never)]
    fn unconstrained(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        mechanism.terms(state, &mut self.terms);
        self.factorise_metric(mechanism, Source::Terms, state.t)?;
        self.counters.cheap_accelerations += 1;
        let mut acceleration = self.terms.force;
        let column = &mut acceleration.data.0[0];
        self.metric.factor.forward(column);
        self.metric.factor.backward(column);
        Ok(acceleration)
    }

    /// `p₂`, or `p₂ − 2α(A q̇ + b) − β²g` after Baumgarte (1972).
    pub(super) fn stabilised_bias(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> SVector<T, R> {
        let Stabilisation::Baumgarte { alpha, beta } = self.settings.stabilisation else {
            return self.terms.bias;
        };
        mechanism.position(state, &mut self.position);
        let velocity = self.position.speed(&state.v);
        self.terms.bias - velocity * (alpha + alpha) - self.position.residual * (beta * beta)
    }

    /// `w = U⁻¹p₁`: the acceleration that the forces alone would give, in
    /// coordinates in which the kinetic energy is half the square of the velocity.
    #[inline]
    pub(crate) fn free_acceleration(&self, bias: &SVector<T, R>) -> [T; N] {
        let mut w = self
            .metric
            .force(&self.terms.force, &self.terms.jacobian, bias, &self.rows);
        self.metric.factor.forward(&mut w);
        w
    }

    /// `U⁻ᵀw`: back to the mechanism's own coordinates.
    #[inline]
    pub(crate) fn lower(&self, mut w: [T; N]) -> SVector<T, N> {
        self.metric.factor.backward(&mut w);
        SVector::from(w)
    }

    /// The right-hand sides of rows scaled to size one.
    pub(crate) fn scaled(&self, right: &SVector<T, R>) -> [T; R] {
        let mut scaled = self.rows.scale;
        for (scale, right) in scaled.iter_mut().zip(right.as_slice()) {
            *scale *= *right;
        }
        scaled
    }

    /// Whether the general factors at hand belong to this position.
    #[inline]
    pub(super) fn is_factored_at(&self, state: &State<T, N>) -> bool {
        let is_at = |(t, q): &(T, SVector<T, N>)| *t == state.t && q.data.0 == state.q.data.0;
        self.safe.as_ref().is_some_and(is_at)
    }
}
