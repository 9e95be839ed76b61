//! A force projected onto a few directions.
//!
//! In:  a symmetric matrix, the directions as the first columns of `D`, a force.
//! Out: `D z` with `DᵀMD z = Dᵀf`.
//!
//! The columns are made orthogonal in the matrix one after the other, which is the
//! Cholesky factorisation of `DᵀMD` without a matrix of its size.

use super::dot;
use crate::Real;
use nalgebra::{SMatrix, SVector};

/// `D z`, or the column at which `DᵀMD` is not definite.
#[inline(never)]
pub(crate) fn project_onto<T: Real, const N: usize>(
    mass: &SMatrix<T, N, N>,
    columns: &SMatrix<T, N, N>,
    count: usize,
    force: &SVector<T, N>,
) -> Result<SVector<T, N>, usize> {
    let mut directions = *columns;
    let mut sum = SVector::zeros();
    for k in 0..count {
        let mut direction = SVector::from(directions.data.0[k]);
        let image = mass * direction;
        let square = direction.dot(&image);
        if square <= T::zero() {
            return Err(k);
        }
        for later in k + 1..count {
            let share = dot(&directions.data.0[later], &image.data.0[0]) / square;
            for i in 0..N {
                directions[(i, later)] -= share * direction[i];
            }
        }
        direction *= direction.dot(force) / square;
        sum += direction;
    }
    Ok(sum)
}
