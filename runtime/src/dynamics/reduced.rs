//! The reduced form: `[DᵀM; A] q̈ = [Dᵀp₁; p₂]`, what users get by default.
//!
//! In:  the terms of a state.
//! Out: `q̈ = A⁺p₂ + D z` with `DᵀMD z = Dᵀ(p₁ − M A⁺p₂)`.
//!
//! Source: Phong & Hoang (2012), section 3. In the metric of the kinetic energy,
//! `w = Lᵀq̈`, it reads: of all `w` that satisfy the constraints the one nearest to
//! `L⁻¹p₁`. Where the rows of `A` are safely independent a Schur complement gives
//! that directly; elsewhere it is built from the tangent space.

use super::{Limit, Solver, Source, Which};
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
        let shared = self.is_factored_at(state);
        let cheap = shared || {
            self.factored = None;
            self.factorise_metric(mechanism, Source::Terms, state.t)?;
            self.factorise_constraints(Source::Terms, Which::All)
        };
        let mut w = self.free_acceleration(bias);
        if cheap {
            self.counters.cheap_accelerations += 1;
            self.lifted.correct(&mut w, bias);
            return Ok(self.lower(w));
        }
        self.counters.robust_accelerations += 1;
        let (all, regular) = (Which::All, Limit::Regular);
        let tangent = self.tangent(mechanism, state, Source::Terms, all, regular)?;
        if tangent.strong == self.rows.regular(Which::All) {
            self.choose_rows(tangent.rows());
        }
        Ok(self.lower(tangent.solve(&self.scaled(bias), &w)))
    }
}
