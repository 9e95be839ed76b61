//! Constraints whose gradient vanishes wherever they hold.
//!
//! In:  a state at which a combination of rows loses its gradient.
//! Out: whether that is like a square.

use super::CoordinateScale;
use super::erased::Constrained;
use super::singular_values::{SingularValueDecomposition, second_derivatives};
use crate::Real;
use crate::equations::At;
use crate::linalg::{Workspace, add_scaled, diagonalise, dot, orthonormal, remove};

/// Second derivatives below this part of the largest count as zero.
const FLAT: f64 = 1e-3;
/// How far, relative to the coordinates, the neighbours lie that tell whether constraints
/// that touch zero go through it.
const ASIDE: f64 = 1e-2;

/// Whether the combination of rows that loses its gradient at a state is like a square
/// that vanishes along a line, or a sum of squares that vanishes at a point: its second
/// derivatives have one sign but for directions along which it is flat, and there it
/// does not become negative.
pub(super) fn has_one_sign<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    decomposition: &SingularValueDecomposition<'_, T>,
    rank: usize,
    workspace: &Workspace<'_, T>,
) -> bool {
    let n = state.q.len();
    let count = n - rank;
    let combination = decomposition.left(rank);
    let kernel = workspace.numbers(n * count);
    let strong = decomposition.decided(rank);
    orthonormal(kernel, n, &|axis| remove(axis, strong), workspace);
    let second = workspace.numbers(count * count);
    let vectors = workspace.numbers(count * count);
    second_derivatives(solver, state, combination, kernel, second, workspace);
    diagonalise(second, vectors, count);
    let values = || second.iter().step_by(count + 1);
    let most = values().fold(T::zero(), |most: T, value| most.max(value.abs()));
    let flat = |value: &T| value.abs() <= most * T::from_f64(FLAT);
    let mut steep = values()
        .filter(|value| !flat(value))
        .map(|value| value.sign());
    let Some(sign) = steep
        .next()
        .filter(|first| steep.all(|other| other == *first))
    else {
        return false;
    };
    let (along, moved) = (workspace.numbers(n), workspace.numbers(n));
    let CoordinateScale { size, range, .. } = solver.known().coordinate_scale;
    for (value, vector) in values().zip(vectors.chunks_exact(count)) {
        if !flat(value) {
            continue;
        }
        along.fill(T::zero());
        for (share, axis) in vector.iter().zip(kernel.chunks_exact(n)) {
            add_scaled(along, *share, axis);
        }
        solver.known().lower(along);
        for side in [range, -range] {
            moved.copy_from_slice(state.q);
            add_scaled(moved, side * T::from_f64(ASIDE), along);
            solver.locate(state.t, moved);
            if value_of(solver, combination, workspace) * sign < -T::EPSILON * size {
                return false;
            }
        }
    }
    true
}

/// The value of a combination of constraints where they were evaluated last.
fn value_of<T: Real>(
    solver: &dyn Constrained<T>,
    combination: &[T],
    workspace: &Workspace<'_, T>,
) -> T {
    workspace.scope(|workspace| {
        let right = workspace.numbers(combination.len());
        solver.known().scaled(solver.constraints().residual, right);
        dot(combination, right)
    })
}
