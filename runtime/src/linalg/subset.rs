//! A well-conditioned independent subset of vectors.
//!
//! In:  vectors of one length, how many are wanted, and which come first.
//! Out: their indices, or how much better than given ones they can be at most.
//!
//! Not here: how many are independent. That needs singular values.

use super::column::pair;
use super::{Workspace, add_scaled, dot, scale, solve_upper};
use crate::Real;

/// Chooses columns of length `n` in `x`, as many as there is room for, each the one farthest
/// from the span of those before it, and returns how many were found; their indices are the
/// first entries of `chosen`.
///
/// Columns with `first` are taken before all others while one of them is farther
/// than `threshold` from the span. `x` is used up.
pub(crate) fn independent_columns<T: Real>(
    x: &mut [T],
    n: usize,
    first: &dyn Fn(usize) -> bool,
    threshold: T,
    chosen: &mut [usize],
) -> usize {
    let least = threshold * threshold;
    for found in 0..chosen.len() {
        // The index of the farthest, whether it comes first, and how far it is.
        let mut best = None;
        for (i, column) in x.chunks_exact(n).enumerate() {
            if chosen[..found].contains(&i) {
                continue;
            }
            let size = dot(column, column);
            let farther = (first(i) && size > least, size);
            let stays = |(_, known): (usize, (bool, T))| match known.0 == farther.0 {
                true => known.1 >= farther.1,
                false => known.0,
            };
            if !best.is_some_and(stays) {
                best = Some((i, farther));
            }
        }
        let Some((next, (_, size))) = best else {
            return found;
        };
        // A comparison with NaN is false, so that nothing of a size that is NaN is chosen.
        let enough = size > least;
        if !enough {
            return found;
        }
        chosen[found] = next;
        remove_direction(x, n, next, size);
    }
    chosen.len()
}

/// Subtracts from every column its part along column `pivot`, which is kept.
fn remove_direction<T: Real>(x: &mut [T], n: usize, pivot: usize, size: T) {
    for i in 0..x.len() / n {
        if i != pivot {
            let [column, direction] = pair(x, n, i, pivot);
            let share = dot(direction, column) / size;
            add_scaled(column, -share, direction);
        }
    }
}

/// A bound of how many times the volume that the first `m` columns of length `n` in `x` span may
/// be that of any other `m` of all these columns: not finite where the first ones are dependent.
/// `x` is used up.
///
/// With the first columns `V = QR`, another column is `Vc + e`, `e` at right angles to all of `V`.
/// By Hadamard's inequality each one that comes in multiplies the volume at most by
/// `√(|c|² + |e|²/σ²)`, `σ` being the smallest singular value of `V`, which is at least
/// `1/‖R⁻¹‖` in Frobenius' norm.
pub(crate) fn exchange_bound<T: Real>(
    x: &mut [T],
    n: usize,
    m: usize,
    workspace: &Workspace<'_, T>,
) -> T {
    let triangle = workspace.numbers(m * m);
    let (own, others) = x.split_at_mut(m * n);
    for j in 0..m {
        let (before, column) = own.split_at_mut(j * n);
        let column = &mut column[..n];
        let shares = &mut triangle[j * m..][..m];
        remove_shares(before, column, shares);
        shares[j] = dot(column, column).sqrt();
        scale(column, T::one() / shares[j]);
    }
    let solution = workspace.any(m);
    let mut inverse = T::zero();
    for j in 0..m {
        solution.fill(T::zero());
        solution[j] = T::one();
        solve_upper(triangle, solution);
        inverse += dot(solution, solution);
    }
    let mut bound = T::one();
    for column in others.chunks_exact_mut(n) {
        remove_shares(own, column, solution);
        solve_upper(triangle, solution);
        let factor = dot(solution, solution) + dot(column, column) * inverse;
        // What is not a number stays one.
        bound = match factor <= T::one() {
            true => bound,
            false => bound * factor,
        };
    }
    bound.sqrt()
}

/// Subtracts from a column its part along each of some orthonormal ones, and tells its shares.
fn remove_shares<T: Real>(directions: &[T], column: &mut [T], shares: &mut [T]) {
    for (direction, share) in directions.chunks_exact(column.len()).zip(shares) {
        *share = dot(direction, column);
        add_scaled(column, -*share, direction);
    }
}
