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
    let mut chosen = [0; N];
    let found = independent_rows(&mut axes, count, |_| false, T::zero(), &mut chosen);
    let mut free = SMatrix::zeros();
    for (column, &j) in free.data.0.iter_mut().zip(&chosen[..found]) {
        let axis = &axes.data.0[j];
        *column = scaled(T::one() / norm(axis), axis);
    }
    free
}

/// Subtracts from a vector its parts along orthonormal directions.
pub(crate) fn remove<T: Real, const N: usize>(x: &mut [T; N], directions: &[[T; N]]) {
    for direction in directions {
        let share = dot(direction, x);
        add_scaled(x, -share, direction);
    }
}
