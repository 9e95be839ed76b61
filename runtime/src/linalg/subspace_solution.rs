//! The solution of a symmetric system in the subspace of a few directions.
//!
//! In:  a symmetric matrix, the directions as the columns of `D`, a force.
//! Out: `D z` with `DᵀMD z = Dᵀf`.
//!
//! The columns are made orthogonal in the matrix one after the other, which is the
//! Cholesky factorisation of `DᵀMD` without a matrix of its size.

use super::small::with_size;
use super::{Workspace, add_product, add_scaled, dot};
use crate::Real;

/// Replaces a force by the solution `D z`; the column at which `DᵀMD` is not definite, where
/// one is.
pub(crate) fn solve_in_subspace<T: Real>(
    mass: &[T],
    columns: &[T],
    force: &mut [T],
    workspace: &Workspace<'_, T>,
) -> Result<(), usize> {
    workspace.scope(|workspace| {
        let room = workspace.any(columns.len() + 2 * force.len());
        let (directions, room) = room.split_at_mut(columns.len());
        let (image, sum) = room.split_at_mut(force.len());
        directions.copy_from_slice(columns);
        sum.fill(T::zero());
        with_size!(
            force.len(),
            |N| add_subspace_solution_of(N, mass, directions, force, image, sum),
            add_subspace_solution(mass, directions, force, image, sum)
        )?;
        force.copy_from_slice(sum);
        Ok(())
    })
}

/// Adds `D z` to a sum, with room for a vector; `D` is used up.
#[inline(never)]
pub(crate) fn add_subspace_solution<T: Real>(
    mass: &[T],
    directions: &mut [T],
    force: &[T],
    image: &mut [T],
    sum: &mut [T],
) -> Result<(), usize> {
    add_subspace_solution_of(force.len(), mass, directions, force, image, sum)
}

/// Adds `D z` to a sum, for `n` coordinates: the compiler knows their number where it is constant.
#[inline(always)]
fn add_subspace_solution_of<T: Real>(
    n: usize,
    mass: &[T],
    directions: &mut [T],
    force: &[T],
    image: &mut [T],
    sum: &mut [T],
) -> Result<(), usize> {
    let (force, image, sum) = (&force[..n], &mut image[..n], &mut sum[..n]);
    for k in 0..directions.len() / n.max(1) {
        let (direction, later) = directions[k * n..].split_at_mut(n);
        image.fill(T::zero());
        add_product(image, T::one(), &mass[..n * n], direction);
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
