//! A force projected onto a few directions.
//!
//! In:  a symmetric matrix, the directions as columns of `D`, a force.
//! Out: `D z` with `DᵀMD z = Dᵀf`.
//!
//! The columns are made orthogonal in the matrix one after the other, which is the
//! Cholesky factorisation of `DᵀMD` without a matrix of its size.

use super::{Workspace, add_product, add_scaled, dot};
use crate::Real;

/// Replaces a force by `D z`; the column at which `DᵀMD` is not definite, where one is.
pub(crate) fn project_onto<T: Real>(
    mass: &[T],
    columns: &[T],
    force: &mut [T],
    workspace: &Workspace<'_, T>,
) -> Result<(), usize> {
    let n = force.len();
    workspace.scope(|workspace| {
        let directions = workspace.numbers(columns.len());
        let (image, sum) = (workspace.numbers(n), workspace.numbers(n));
        directions.copy_from_slice(columns);
        for k in 0..columns.len() / n {
            let (done, later) = directions.split_at_mut((k + 1) * n);
            let direction = &done[k * n..];
            image.fill(T::zero());
            add_product(image, T::one(), mass, direction);
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
        force.copy_from_slice(sum);
        Ok(())
    })
}
