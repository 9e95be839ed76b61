//! The form with independent and dependent coordinates:
//! `DᵀMD q̈ᵢ = Dᵀ(p₁ − M q̈ₚ)`, `q̈ = q̈ₚ + D q̈ᵢ`.
//!
//! In:  the terms of a state.
//! Out: `q̈`, or an error at a singular position and near it.
//!
//! Source: Phong & Hoang (2012), eqs. 2.16–2.25, with `D = [E; −A_d⁻¹Aᵢ]`. The
//! dependent coordinates are chosen by pivoting, anew at every state, so that
//! `A_d` is as well conditioned as the position allows.

use super::Solver;
use crate::linalg::Elimination;
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::{SMatrix, SVector};

impl<T: Real, const N: usize, const R: usize> Solver<T, N, R> {
    /// The acceleration, by elimination of the dependent coordinates.
    pub(super) fn partitioning<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        mechanism.terms(state, &mut self.terms);
        let bias = self.stabilised_bias(mechanism, state);
        self.require_independent_rows(mechanism, state)?;
        self.counters.cheap_accelerations += 1;
        let weight = SVector::from_fn(|j, _| {
            let mass = self.terms.mass[(j, j)];
            if mass > T::zero() {
                T::one() / mass.sqrt()
            } else {
                T::one()
            }
        });
        let mut jacobian = self.terms.jacobian;
        for row in 0..R {
            jacobian
                .row_mut(row)
                .iter_mut()
                .for_each(|x| *x *= self.rows.scale(row));
        }
        let right = SVector::from(self.scaled(&bias));
        let eliminated = Elimination::new(&jacobian, &right, &weight);
        let particular = particular(&eliminated);
        let (null_space, free) = null_space(&eliminated);
        let force = self.terms.force - self.terms.mass * particular;
        let t = state.t;
        project_onto(&self.terms.mass, &null_space, free, &force)
            .map(|change| particular + change)
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

/// `D z` with `DᵀMD z = Dᵀf`; the column at which `DᵀMD` is not definite if it is
/// not. `D` is the first `count` columns.
///
/// The columns are made orthogonal in the metric one after the other, which is the
/// Cholesky factorisation of `DᵀMD` without a matrix of its size.
fn project_onto<T: Real, const N: usize>(
    mass: &SMatrix<T, N, N>,
    columns: &SMatrix<T, N, N>,
    count: usize,
    force: &SVector<T, N>,
) -> Result<SVector<T, N>, usize> {
    let mut directions = *columns;
    let mut sum = SVector::zeros();
    for k in 0..count {
        let mut direction: SVector<T, N> = directions.column(k).into_owned();
        let image = mass * direction;
        let square = direction.dot(&image);
        if square <= T::zero() {
            return Err(k);
        }
        for later in k + 1..count {
            let share = directions.column(later).dot(&image) / square;
            for i in 0..N {
                directions[(i, later)] -= share * direction[i];
            }
        }
        direction *= direction.dot(force) / square;
        sum += direction;
    }
    Ok(sum)
}
