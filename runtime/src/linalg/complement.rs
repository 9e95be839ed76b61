//! Orthonormal bases of what directions leave.
//!
//! In:  orthonormal directions, or what takes away what they decide.
//! Out: vectors without their parts along them, a basis of the rest.

use super::column::{add_scaled, dot, norm, scale};
use super::{Workspace, independent_columns};
use crate::Real;

/// Fills `basis` with as many orthonormal vectors of length `n` as it has room for: a basis of
/// what is left of the axes when `remove` takes away what is decided. Where less is left, the
/// last ones are zero.
pub(crate) fn orthonormal<T: Real>(
    basis: &mut [T],
    n: usize,
    remove: &dyn Fn(&mut [T]),
    workspace: &Workspace<'_, T>,
) {
    workspace.scope(|workspace| {
        let axes = workspace.numbers(n * n);
        for (j, axis) in axes.chunks_exact_mut(n).enumerate() {
            axis[j] = T::one();
            // The second time takes the round-off of the first.
            remove(axis);
            remove(axis);
        }
        let chosen = workspace.indices(basis.len() / n);
        let found = independent_columns(axes, n, &|_| false, T::zero(), chosen);
        basis.fill(T::zero());
        for (target, j) in basis.chunks_exact_mut(n).zip(&chosen[..found]) {
            let vector = &axes[j * n..][..n];
            add_scaled(target, T::one() / norm(vector), vector);
        }
    });
}

/// Makes independent vectors of length `n` a basis of what they span, the same as
/// [`orthonormal`] finds where all else is taken away.
pub(crate) fn orthonormalise<T: Real>(basis: &mut [T], n: usize, workspace: &Workspace<'_, T>) {
    let count = basis.len() / n;
    if count == 0 {
        return;
    }
    for i in 0..count {
        let (done, rest) = basis.split_at_mut(i * n);
        let vector = &mut rest[..n];
        // The second time takes the round-off of the first.
        remove(vector, done);
        remove(vector, done);
        scale(vector, T::one() / norm(vector));
    }
    workspace.scope(|workspace| {
        let vectors = workspace.any(basis.len());
        vectors.copy_from_slice(basis);
        // What is left of the axes, in this basis.
        let axes = workspace.any(basis.len());
        for (k, entry) in axes.iter_mut().enumerate() {
            *entry = vectors[k % count * n + k / count];
        }
        let chosen = workspace.indices(count);
        independent_columns(axes, count, &|_| false, T::zero(), chosen);
        basis.fill(T::zero());
        for (target, j) in basis.chunks_exact_mut(n).zip(&*chosen) {
            let shares = &axes[j * count..][..count];
            let size = norm(shares);
            for (share, vector) in shares.iter().zip(vectors.chunks_exact(n)) {
                if *share != T::zero() {
                    add_scaled(target, *share / size, vector);
                }
            }
        }
    });
}

/// Subtracts from a vector its parts along orthonormal directions.
pub(crate) fn remove<T: Real>(x: &mut [T], directions: &[T]) {
    for direction in directions.chunks_exact(x.len()) {
        let share = dot(direction, x);
        add_scaled(x, -share, direction);
    }
}
