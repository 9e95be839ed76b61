//! The reduced form: `[DᵀM; A] q̈ = [Dᵀp₁; p₂]`, what users get by default.
//!
//! In:  the terms of a state.
//! Out: `q̈ = A⁺p₂ + D z` with `DᵀMD z = Dᵀ(p₁ − M A⁺p₂)`.
//!
//! Source: Phong & Hoang (2012), section 3. In the metric of the kinetic energy,
//! `w = Uᵀq̈`, it reads: of all `w` that satisfy the constraints the one nearest to
//! `U⁻¹p₁`. Where the rows of `A` are safely independent a Schur complement gives
//! that directly; elsewhere the tangent space of the sheet does ([`super::follow`]).

use super::{Core, Source, Which};
use crate::tolerance::{passes, window};
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::SVector;

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// The acceleration.
    pub(super) fn reduced(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        if self.session.chart.is_some() {
            return self.acceleration_on_sheet(mechanism, state);
        }
        mechanism.terms(state, &mut self.terms);
        if !self.is_factored_at(state) {
            let squared = self.factorise_terms(mechanism, state)?;
            if !passes(squared, window()) {
                return self.without_rank(mechanism, state);
            }
        }
        self.counters.cheap_accelerations += 1;
        let bias = self.stabilised_bias(mechanism, state);
        Ok(self.regular_acceleration(&bias))
    }

    /// Where constraint rows are near-dependent and there is no chart.
    #[cold]
    fn without_rank(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        if self.settings.published {
            return self.published(mechanism, state);
        }
        Err(self.want_chart(mechanism, state.t))
    }

    /// Factorises metric and constraints of the terms in the buffer and returns the
    /// smallest squared sine of a row.
    pub(super) fn factorise_terms(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<T, DynamicsError<T>> {
        self.factorise_trial(mechanism, Source::Terms, state.t)?;
        let squared = self.factorise_constraints(Source::Terms, Which::All);
        self.session.observe(state, squared);
        Ok(squared)
    }

    /// The acceleration by the factors at hand.
    #[inline]
    pub(super) fn regular_acceleration(&self, bias: &SVector<T, R>) -> SVector<T, N> {
        let mut w = self.free_acceleration(bias);
        self.schur.correct(&mut w, bias);
        self.lower(w)
    }
}
