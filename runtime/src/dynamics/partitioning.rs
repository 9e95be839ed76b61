//! The form with independent and dependent coordinates:
//! `DᵀMD q̈ᵢ = Dᵀ(p₁ − M q̈ₚ)`, `q̈ = q̈ₚ + D q̈ᵢ`.
//!
//! In:  the terms of a state.
//! Out: `q̈`, or an error at a singular position and near it.
//!
//! Source: Phong & Hoang (2012), eqs. 2.16–2.25, with `D = [E; −A_d⁻¹Aᵢ]`. The
//! dependent coordinates are chosen by pivoting, anew at every state, so that
//! `A_d` is as well conditioned as the position allows.

use super::Core;
use crate::linalg::{Elimination, project_onto};
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::{SMatrix, SVector};

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// The acceleration, by elimination of the dependent coordinates.
    #[inline(never)]
    pub(super) fn partitioning(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        mechanism.terms(state, &mut self.terms);
        let bias = self.stabilised_bias(mechanism, state);
        self.require_independent_rows(mechanism, state)?;
        self.counters.cheap_accelerations += 1;
        let mut jacobian = self.terms.jacobian;
        for row in 0..R {
            jacobian
                .row_mut(row)
                .iter_mut()
                .for_each(|x| *x *= self.rows.scale(row));
        }
        let right = SVector::from(self.scaled(&bias));
        let eliminated = Elimination::new(&jacobian, &right, &self.units());
        let particular = particular(&eliminated);
        let (null_space, free) = null_space(&eliminated);
        let mut force = self.terms.force;
        self.terms.take_inertia(&mut force, &particular);
        let (mass, along) = (self.terms.mass.as_slice(), force.as_mut_slice());
        let null_space = &null_space.as_slice()[..N * free];
        let t = state.t;
        project_onto(mass, null_space, along, &self.memory.workspace())
            .map(|()| particular + force)
            .map_err(|column| DynamicsError::MassSingular {
                t,
                coordinate: independent(&eliminated, column),
                structure: mechanism.structure(),
            })
    }
}

/// `q̈ₚ`: dependent coordinates from `p₂`, independent ones zero.
fn particular<T: Real, const N: usize, const R: usize>(
    eliminated: &Elimination<T, N, R>,
) -> SVector<T, N> {
    let mut particular = SVector::zeros();
    for k in 0..eliminated.rank {
        particular[eliminated.dependent[k]] = eliminated.offset[k];
    }
    particular
}

/// The coordinate that moves in a column of `D` and in no other.
fn independent<T: Real, const N: usize, const R: usize>(
    eliminated: &Elimination<T, N, R>,
    column: usize,
) -> usize {
    let dependent = &eliminated.dependent[..eliminated.rank];
    let mut independent = (0..N).filter(|j| !dependent.contains(j));
    independent.nth(column).unwrap_or(column)
}

/// The columns of `D`, and how many there are.
#[inline(never)]
fn null_space<T: Real, const N: usize, const R: usize>(
    eliminated: &Elimination<T, N, R>,
) -> (SMatrix<T, N, N>, usize) {
    let dependent = &eliminated.dependent[..eliminated.rank];
    let mut columns = SMatrix::zeros();
    let mut count = 0;
    for independent in (0..N).filter(|j| !dependent.contains(j)) {
        columns[(independent, count)] = T::one();
        for (k, &j) in dependent.iter().enumerate() {
            columns[(j, count)] = -eliminated.table[(k, independent)];
        }
        count += 1;
    }
    (columns, count)
}
