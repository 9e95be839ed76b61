//! Orthonormal bases of what directions leave.
//!
//! In:  orthonormal directions, or what takes away what they decide.
//! Out: vectors without their parts along them, a basis of the rest.

use super::column::{add_scaled, dot, norm, scaled};
use super::subset::independent_rows;
use crate::Real;
use nalgebra::SMatrix;

/// An orthonormal basis, in the first columns, of what is left of the axes when `remove`
/// takes away what is decided.
pub(crate) fn orthonormal<T: Real, const N: usize>(
    count: usize,
    remove: impl Fn(&mut [T; N]),
) -> SMatrix<T, N, N> {
    let mut axes: SMatrix<T, N, N> = SMatrix::identity();
    for axis in &mut axes.data.0 {
        // The second time takes the round-off of the first.
        remove(axis);
        remove(axis);
    }
    basis(axes, count)
}

/// An orthonormal basis, in the first columns, of what some vectors span.
#[inline(never)]
fn basis<T: Real, const N: usize>(mut vectors: SMatrix<T, N, N>, count: usize) -> SMatrix<T, N, N> {
    let mut chosen = [0; N];
    let first = |_| false;
    let found = independent_rows(&mut vectors, count, &first, T::zero(), &mut chosen);
    let mut basis = SMatrix::zeros();
    for (column, &j) in basis.data.0.iter_mut().zip(&chosen[..found]) {
        let vector = &vectors.data.0[j];
        *column = scaled(T::one() / norm(vector), vector);
    }
    basis
}

/// Subtracts from a vector its parts along orthonormal directions.
#[inline(never)]
pub(crate) fn remove<T: Real, const N: usize>(x: &mut [T; N], directions: &[[T; N]]) {
    for direction in directions {
        let share = dot(direction, x);
        add_scaled(x, -share, direction);
    }
}
