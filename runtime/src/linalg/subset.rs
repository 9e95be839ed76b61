//! A well-conditioned independent subset of vectors.
//!
//! In:  `R` vectors of length `N`, how many are wanted, and which come first.
//! Out: their indices.
//!
//! Not here: how many are independent. That needs singular values.

use super::{add_scaled, dot};
use crate::Real;
use nalgebra::SMatrix;

/// Chooses `count` columns of `vectors`, each the one farthest from the span of
/// those before it, and returns how many were found; their indices are the first
/// entries of `chosen`.
///
/// Columns with `first` are taken before all others while one of them is farther
/// than `threshold` from the span. `vectors` is used up.
pub(crate) fn independent_rows<T: Real, const N: usize, const R: usize>(
    vectors: &mut SMatrix<T, N, R>,
    count: usize,
    first: impl Fn(usize) -> bool,
    threshold: T,
    chosen: &mut [usize; R],
) -> usize {
    let x = &mut vectors.data.0;
    let mut found = 0;
    while found < count.min(R) {
        let free = |i: &usize| !chosen[..found].contains(i);
        let distance = |i: usize| dot(&x[i], &x[i]);
        let farthest = |best: Option<usize>, i: usize| match best {
            Some(b) if distance(b) >= distance(i) => Some(b),
            _ => Some(i),
        };
        let next = (0..R)
            .filter(free)
            .filter(|&i| first(i) && distance(i) > threshold * threshold)
            .fold(None, farthest)
            .or_else(|| (0..R).filter(free).fold(None, farthest));
        let Some(next) = next else { break };
        let size = distance(next);
        let enough = size > threshold * threshold;
        if !enough {
            break;
        }
        chosen[found] = next;
        found += 1;
        remove_direction(x, next, size);
    }
    found
}

/// Subtracts from every column its part along column `pivot`, which is kept.
fn remove_direction<T: Real, const N: usize, const R: usize>(
    x: &mut [[T; N]; R],
    pivot: usize,
    size: T,
) {
    let direction = x[pivot];
    for (i, column) in x.iter_mut().enumerate() {
        if i != pivot {
            let share = dot(&direction, column) / size;
            add_scaled(column, -share, &direction);
        }
    }
}
