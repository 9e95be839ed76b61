//! How the acceleration changes with the state.
//!
//! In:  a mechanism that provides [`Mechanism::linearised`], a state on its
//!      constraints.
//! Out: `∂q̈/∂q`, `∂q̈/∂q̇`, by the factors of `M` and `A M⁻¹ Aᵀ`.
//!
//! Not here: what is done near singular positions, where `A M⁻¹ Aᵀ` has no factors.

use super::Core;
use crate::tolerance::{passes, window};
use crate::{AccelerationJacobian, Linearised, Mechanism, Real, Stabilisation, State};
use nalgebra::{SMatrix, SVector};

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// The derivatives of the acceleration where the constraints are regular; `None`
    /// near singular positions, and where constraint errors take part in it.
    #[inline(never)]
    pub(crate) fn acceleration_jacobian(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Option<AccelerationJacobian<T, N>> {
        let stabilised = matches!(self.settings.stabilisation, Stabilisation::Baumgarte { .. });
        // What conditions that the motion slides along let through is not in the linearisation.
        let slides = self.conditions.decided.sliding != 0;
        if stabilised || slides || self.session.chart.is_some() || self.session.at_rest {
            return None;
        }
        mechanism.terms(state, &mut self.terms);
        let squared = self.factorise_terms(mechanism, state).ok()?;
        if R > 0 && !passes(squared, window()) {
            return None;
        }
        let bias = self.terms.bias;
        let free = self.free_acceleration(&bias);
        let multiplier = self.schur.multiplier(&free, &bias);
        let acceleration = self.regular_acceleration(&bias);
        let mut out = Linearised::default();
        out.sides = self.terms.sides;
        mechanism
            .linearised(state, &acceleration, &multiplier, &mut out)
            .then(|| AccelerationJacobian {
                q: self.changes(&out.force_by_position, &out.row_by_position),
                v: self.changes(&out.force_by_velocity, &out.row_by_velocity),
            })
    }

    /// How the acceleration changes with applied forces, `∂q̈/∂p₁`, at the state at which
    /// [`acceleration_jacobian`](Self::acceleration_jacobian) was found last.
    pub(crate) fn compliance(&self) -> SMatrix<T, N, N> {
        self.changes(&SMatrix::identity(), &SMatrix::zeros())
    }

    /// The `δq̈` of `M δq̈ + Aᵀδλ = force`, `A δq̈ = row`, column by column.
    fn changes(&self, force: &SMatrix<T, N, N>, row: &SMatrix<T, R, N>) -> SMatrix<T, N, N> {
        let mut changes = SMatrix::zeros();
        for (j, change) in changes.data.0.iter_mut().enumerate() {
            let row = SVector::from(row.data.0[j]);
            let force = SVector::from(force.data.0[j]);
            let jacobian = &self.terms.jacobian;
            let mut w = self.metric.force(&force, jacobian, &row, &self.rows);
            self.metric.factor.forward(&mut w);
            self.schur.correct(&mut w, &row);
            *change = self.lower(w).data.0[0];
        }
        changes
    }
}
