//! A well-conditioned independent subset of vectors.
//!
//! In:  vectors of one length, how many are wanted, and which come first.
//! Out: their indices.
//!
//! Not here: how many are independent. That needs singular values.

use super::column::pair;
use super::{add_scaled, dot};
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
