//! A force projected onto a few directions.
//!
//! In:  a symmetric matrix, the directions as the columns of `D`, a force.
//! Out: `D z` with `DᵀMD z = Dᵀf`.
//!
//! The columns are made orthogonal in the matrix one after the other, which is the
//! Cholesky factorisation of `DᵀMD` without a matrix of its size.

use super::{add_scaled, dot};
use crate::Real;
use nalgebra::{SMatrix, SVector};

/// `D z` for the first `count` columns, or the column at which `DᵀMD` is not definite.
#[inline(never)]
pub(crate) fn project_onto<T: Real, const N: usize>(
    mass: &SMatrix<T, N, N>,
    columns: &SMatrix<T, N, N>,
    count: usize,
    force: &SVector<T, N>,
) -> Result<SVector<T, N>, usize> {
    let mut directions = *columns;
    let directions = &mut directions.as_mut_slice()[..N * count];
    let (mut sum, mut image) = (SVector::<T, N>::zeros(), [T::zero(); N]);
    let (mass, force) = (mass.as_slice(), force.as_slice());
    add_along(mass, directions, force, &mut image, sum.as_mut_slice())?;
    Ok(sum)
}

/// Adds `D z` to a sum, with room for a vector; `D` is used up.
#[inline(never)]
pub(crate) fn add_along<T: Real>(
    mass: &[T],
    directions: &mut [T],
    force: &[T],
    image: &mut [T],
    sum: &mut [T],
) -> Result<(), usize> {
    let n = force.len().max(1);
    for k in 0..directions.len() / n {
        let (direction, later) = directions[k * n..].split_at_mut(n);
        image.fill(T::zero());
        for (column, entry) in mass.chunks_exact(n).zip(&*direction) {
            add_scaled(image, *entry, column);
        }
        let square = dot(direction, image);
        if square <= T::zero() {
            return Err(k);
        }
        for later in later.chunks_exact_mut(n) {
            let share = dot(later, image) / square;
            add_scaled(later, -share, direction);
        }
        add_scaled(sum, dot(direction, force) / square, direction);
    }
    Ok(())
}
