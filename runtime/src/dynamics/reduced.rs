//! The reduced form: `[DᵀM; A] q̈ = [Dᵀp₁; p₂]`, what users get by default.
//!
//! In:  the terms of a state.
//! Out: `q̈ = A⁺p₂ + D z` with `DᵀMD z = Dᵀ(p₁ − M A⁺p₂)`.
//!
//! Source: Phong & Hoang (2012), section 3. In the metric of the kinetic energy,
//! `w = Lᵀq̈`, it reads: of all `w` that satisfy the constraints the one nearest to
//! `L⁻¹p₁`. Where the rows of `A` are safely independent a Schur complement gives
//! that directly; elsewhere it is built from the tangent space.

use super::{Solver, Source, Which};
use crate::linalg::{guard, passes};
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::SVector;

impl<T: Real, const N: usize, const R: usize> Solver<T, N, R> {
    /// The acceleration, on the cheap path if it is safe.
    pub(super) fn reduced<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        bias: &SVector<T, R>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        if !self.is_factored_at(state) {
            if self.near {
                return self.near_singular(mechanism, state);
            }
            self.factored = None;
            self.factorise_metric(mechanism, Source::Terms, state.t)?;
            let squared = self.factorise_constraints(Source::Terms, Which::All);
            self.begin(squared);
            if !passes(squared, guard()) {
                return self.near_singular(mechanism, state);
            }
        }
        self.counters.cheap_accelerations += 1;
        Ok(self.regular_acceleration(bias))
    }

    /// The acceleration by the factors at hand.
    #[inline]
    pub(super) fn regular_acceleration(&self, bias: &SVector<T, R>) -> SVector<T, N> {
        let mut w = self.free_acceleration(bias);
        self.lifted.correct(&mut w, bias);
        self.lower(w)
    }
}
