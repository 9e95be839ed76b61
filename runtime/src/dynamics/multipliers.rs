//! The form with Lagrange multipliers: `[M Aᵀ; A 0] [q̈; λ] = [p₁; p₂]`.
//!
//! In:  the terms of a state.
//! Out: `q̈`, or an error at a singular position and near it.
//!
//! Source: Phong & Hoang (2012), eq. 2.10. The matrix is singular where rows of
//! `A` are dependent; a Schur complement of all rows shows how near that is.

use super::{Core, Source};
use crate::linalg::column;
use crate::tolerance::{passes, window};
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::SVector;

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// The acceleration, by elimination of `q̈` and then of the multipliers.
    #[inline(never)]
    pub(super) fn multipliers(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        mechanism.terms(state, &mut self.terms);
        let bias = self.stabilised_bias(mechanism, state);
        self.require_independent_rows(mechanism, state)?;
        self.counters.cheap_accelerations += 1;
        let mut w = self.free_acceleration(&bias);
        self.schur.correct(&mut w, &bias);
        Ok(self.lower(w))
    }

    /// Factorises all rows; an error with the rank if they are not safely
    /// independent. For the forms that need them to be.
    #[inline(never)]
    pub(super) fn require_independent_rows(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        self.factorise_metric(mechanism, Source::Terms, state.t)?;
        self.counters.constraint_factorisations += 1;
        let every_row = column(|row| row);
        let jacobian = &self.terms.jacobian;
        let squared = self
            .schur
            .factorise(&self.metric, jacobian, &self.rows, (every_row, R));
        if passes(squared, window()) {
            return Ok(());
        }
        let rank = self.rank_above(Source::Terms, state.t, window())?;
        Err(DynamicsError::SingularPosition {
            t: state.t,
            form: self.settings.form,
            rank,
            structure: mechanism.structure(),
        })
    }
}
