//! A force projected onto a few directions.
//!
//! In:  a symmetric matrix, the directions as the columns of `D`, a force.
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
    workspace.scope(|workspace| {
        let directions = workspace.numbers(columns.len());
        directions.copy_from_slice(columns);
        let (image, sum) = (
            workspace.numbers(force.len()),
            workspace.numbers(force.len()),
        );
        add_along(mass, directions, force, image, sum)?;
        force.copy_from_slice(sum);
        Ok(())
    })
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
    Ok(())
}
