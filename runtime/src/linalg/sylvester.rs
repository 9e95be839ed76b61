//! How many eigenvalues change their sign from one block to another.
//!
//! In:  two blocks of near-dependent rows, at two states.
//! Out: the number of negative eigenvalues of the one in bases in which the other is the identity.
//!
//! Near a singular configuration the two are nearly multiples of each other, and these are the
//! eigenvalues that change their signs.

use super::add_scaled;
use super::block::{Block, FEW, LONG, Next, make_diagonal, swap};
use super::workspace::Workspace;
use crate::Real;

/// Rows up to which eigenvalues are counted by the characteristic polynomial, whose coefficients
/// lose too many digits for more.
const SEVERAL: usize = 3;

impl<T: Real> Block<'_, T> {
    /// How many eigenvalues change their sign from another block to this one: the number of
    /// negative eigenvalues of this block in bases in which the other one is the identity.
    pub(crate) fn sign_changes_from(
        &self,
        other: &Block<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> usize {
        let (here, there) = (self.all(), other.all());
        let mut small = [[T::zero(); FEW * FEW]; 2];
        for (copy, entries) in small.iter_mut().zip([here, there]) {
            for (copy, entry) in copy.iter_mut().zip(entries) {
                *copy = *entry;
            }
        }
        let mut pivots = [T::zero(); FEW];
        match self.size() {
            0 => None,
            1 => changes(1, &mut small, &mut pivots, Next::Largest),
            FEW => changes(FEW, &mut small, &mut pivots, Next::Largest),
            size => changes_of_many(size, [here, there], workspace),
        }
        .map_or(0, |found| found.count)
    }
}

/// How many eigenvalues change their sign between two blocks of many rows. In the bases of one that
/// is nearly singular, rows that are far from dependence are apart from those that are not; which of
/// the two is nearer, their pivots tell.
fn changes_of_many<T: Real>(
    size: usize,
    blocks: [&[T]; 2],
    workspace: &Workspace<'_, T>,
) -> Option<Changes<T>> {
    let changes = |[first, second]: [&[T]; 2]| {
        workspace.scope(|workspace| {
            let mut copies = [first, second].map(|entries| {
                let copy = workspace.any(entries.len());
                copy.copy_from_slice(entries);
                copy
            });
            // In a short block nothing is spent on the search for zeros.
            let next = match size < LONG {
                true => Next::Largest,
                false => Next::Sparsest(workspace.indices(size)),
            };
            changes(size, &mut copies, workspace.any(size), next)
        })
    };
    let found = changes(blocks)?;
    if found.is_sure {
        return Some(found);
    }
    let reversed = changes([blocks[1], blocks[0]]);
    reversed
        .filter(|it| it.is_sure || it.nearness < found.nearness)
        .or(Some(found))
}

/// How many eigenvalues change their sign.
struct Changes<T> {
    count: usize,
    /// Whether the count does not hang on the bases.
    is_sure: bool,
    /// The smallest pivot of the block whose bases were taken, over the largest.
    nearness: T,
}

/// How many eigenvalues change their sign from the second block to the first one, in bases of the
/// second one; both are used up. `None` where that one is singular.
#[inline(always)]
fn changes<T: Real, E: AsMut<[T]>>(
    size: usize,
    blocks: &mut [E; 2],
    pivots: &mut [T],
    next: Next<'_>,
) -> Option<Changes<T>> {
    let [here, there] = blocks.each_mut().map(|it| it.as_mut());
    make_diagonal(size, [&mut *here, there], pivots, next);
    let scales = &mut pivots[..size];
    let least = scales.iter().fold(scales[0], |least, x| least.min(*x));
    let most = scales.iter().fold(scales[0], |most, x| most.max(*x));
    if least == T::zero() {
        return None;
    }
    scales.iter_mut().for_each(|x| *x = T::one() / x.sqrt());
    let entries = &mut here[..size * size];
    for (row, scale) in entries.chunks_exact_mut(size).zip(&*scales) {
        for (entry, other) in row.iter_mut().zip(&*scales) {
            *entry *= *scale * *other;
        }
    }
    let dominated = match size > SEVERAL {
        true => count_on_diagonal(size, entries),
        false => None,
    };
    Some(Changes {
        is_sure: dominated.is_some() || size <= SEVERAL,
        count: dominated.unwrap_or_else(|| count_negative(size, entries, scales)),
        nearness: least / most,
    })
}

/// How many eigenvalues of a block are negative, if the diagonal tells: where each of its entries
/// is larger than all others of the row together (Gershgorin's theorem).
fn count_on_diagonal<T: Real>(size: usize, entries: &[T]) -> Option<usize> {
    let mut count = 0;
    for (i, row) in entries.chunks_exact(size).enumerate() {
        let all = row.iter().fold(T::zero(), |sum, entry| sum + entry.abs());
        let dominates = row[i].abs() > all - row[i].abs();
        if !dominates {
            return None;
        }
        count += usize::from(row[i] < T::zero());
    }
    Some(count)
}

/// How many eigenvalues of a block are negative: the pivots of rows that are farthest from
/// dependence, and the eigenvalues of the few rows that are left when they are eliminated.
#[inline(always)]
fn count_negative<T: Real>(size: usize, entries: &mut [T], scales: &mut [T]) -> usize {
    let entries = &mut entries[..size * size];
    let eliminated = size.saturating_sub(SEVERAL);
    let mut count = 0;
    for step in 0..eliminated {
        let mut next = step;
        for k in step + 1..size {
            if scales[k] < scales[next] {
                next = k;
            }
        }
        swap(entries, size, step, (next, next));
        scales.swap(step, next);
        let pivot = entries[step * size + step];
        if pivot == T::zero() {
            return count;
        }
        count += usize::from(pivot < T::zero());
        let (done, rest) = entries.split_at_mut((step + 1) * size);
        for row in rest.chunks_exact_mut(size) {
            if row[step] != T::zero() {
                let share = -row[step] / pivot;
                add_scaled(&mut row[step..], share, &done[step * size + step..]);
            }
        }
    }
    let left = |i: usize, j: usize| entries[(eliminated + i) * size + eliminated + j];
    count + count_negative_of_few(size - eliminated, left)
}

/// How many eigenvalues of a block of up to three rows are negative: the changes of sign among the
/// coefficients of its characteristic polynomial at `-λ` (Descartes' rule of signs). The block of
/// sheets at very different distances is no multiple of another, and its symmetric part may have
/// signs that it has not.
fn count_negative_of_few<T: Real>(size: usize, entry: impl Fn(usize, usize) -> T) -> usize {
    let minor = |[i, j]: [usize; 2], [k, l]: [usize; 2]| {
        entry(i, k) * entry(j, l) - entry(i, l) * entry(j, k)
    };
    let principal = |rows| minor(rows, rows);
    let mut coefficients = [entry(0, 0), T::zero(), T::zero()];
    if size > 1 {
        coefficients[0] += entry(1, 1);
        coefficients[1] = principal([0, 1]);
    }
    if size > 2 {
        coefficients[0] += entry(2, 2);
        coefficients[1] += principal([0, 2]) + principal([1, 2]);
        coefficients[2] = entry(0, 0) * principal([1, 2]) - entry(0, 1) * minor([1, 2], [0, 2])
            + entry(0, 2) * minor([1, 2], [0, 1]);
    }
    let (mut negative, mut changes) = (false, 0);
    for coefficient in coefficients.into_iter().filter(|x| *x != T::zero()) {
        changes += usize::from(negative != (coefficient < T::zero()));
        negative = coefficient < T::zero();
    }
    changes
}
