//! How many eigenvalues change their sign from one block to another.
//!
//! In:  two blocks of near-dependent rows, at two states.
//! Out: the number of negative eigenvalues of the symmetric part of the one in bases in which
//!      the other is the identity, by Sylvester's law of inertia.
//!
//! Near a singular configuration the two are nearly multiples of each other, and these are the
//! eigenvalues that change their signs. Those of two and three rows are taken themselves.

use super::add_scaled;
use super::block::{Block, FEW, LONG, Next, make_diagonal, swap};
use super::workspace::Workspace;
use crate::Real;

/// Near-dependent rows up to which eigenvalues are counted by the characteristic polynomial, whose
/// coefficients lose too many digits for more.
const SEVERAL: usize = 3;

impl<T: Real> Block<'_, T> {
    /// How many eigenvalues change their sign from another block to this one: the
    /// number of negative eigenvalues of the symmetric part of this block in bases in
    /// which the other one is the identity.
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
        let [first, second] = &mut small;
        let mut pivots = [T::zero(); FEW];
        match self.size() {
            0 => 0,
            1 => count_changes(1, [first, second], &mut pivots, Next::Largest),
            FEW => count_changes(FEW, [first, second], &mut pivots, Next::Largest),
            size => workspace.scope(|workspace| {
                let copies = [here, there].map(|entries| {
                    let copy = workspace.any(entries.len());
                    copy.copy_from_slice(entries);
                    copy
                });
                // In a short block nothing is spent on the search for zeros.
                let next = match size < LONG {
                    true => Next::Largest,
                    false => Next::Sparsest(workspace.indices(size)),
                };
                count_changes(size, copies, workspace.any(size), next)
            }),
        }
    }
}

/// How many eigenvalues of a block of two or three rows are negative in bases in which another one
/// is this diagonal: the changes of sign among the coefficients of its characteristic polynomial at
/// `-λ` (Descartes' rule of signs). The block of sheets at very different distances is no multiple
/// of another, and its symmetric part may have signs that it has not.
fn count_negative_of_few<T: Real>(size: usize, here: &[T], diagonal: &[T]) -> usize {
    let entry = |i: usize, j: usize| here[i * size + j] / diagonal[i];
    let minor = |[i, j]: [usize; 2], [k, l]: [usize; 2]| {
        entry(i, k) * entry(j, l) - entry(i, l) * entry(j, k)
    };
    let principal = |rows| minor(rows, rows);
    let mut coefficients = [entry(0, 0) + entry(1, 1), principal([0, 1]), T::zero()];
    if size == SEVERAL {
        coefficients = [
            coefficients[0] + entry(2, 2),
            coefficients[1] + principal([0, 2]) + principal([1, 2]),
            entry(0, 0) * principal([1, 2]) - entry(0, 1) * minor([1, 2], [0, 2])
                + entry(0, 2) * minor([1, 2], [0, 1]),
        ];
    }
    let mut negative = false;
    let mut changes = 0;
    for coefficient in coefficients.into_iter().filter(|x| *x != T::zero()) {
        changes += usize::from(negative != (coefficient < T::zero()));
        negative = coefficient < T::zero();
    }
    changes
}

/// How many eigenvalues change their sign from the second block to the first one, which are
/// used up.
#[inline(always)]
fn count_changes<T: Real>(
    size: usize,
    [here, there]: [&mut [T]; 2],
    pivots: &mut [T],
    next: Next<'_>,
) -> usize {
    make_diagonal(size, [here, there], pivots, next);
    let scales = &mut pivots[..size];
    if scales.contains(&T::zero()) {
        return 0;
    }
    if size == FEW || size == SEVERAL {
        return count_negative_of_few(size, here, scales);
    }
    scales.iter_mut().for_each(|x| *x = T::one() / x.sqrt());
    let symmetric = &mut there[..size * size];
    for i in 0..size {
        for j in 0..size {
            let sum = here[i * size + j] + here[j * size + i];
            symmetric[i * size + j] = sum * scales[i] * scales[j];
        }
    }
    let dominated = match size > FEW {
        true => count_on_diagonal(size, symmetric),
        false => None,
    };
    dominated.unwrap_or_else(|| count_negative(size, symmetric))
}

/// How many eigenvalues of a symmetric block are negative, if the diagonal tells: where each
/// of its entries is larger than all others of the row together (Gershgorin's theorem).
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

/// How many eigenvalues of a symmetric block are negative: by Sylvester's law of inertia, from
/// symmetric elimination with the largest diagonal entry first. A product of blocks that are
/// nearly multiples of each other has no diagonal that vanishes before the rest does.
#[inline(always)]
fn count_negative<T: Real>(size: usize, entries: &mut [T]) -> usize {
    let entries = &mut entries[..size * size];
    let mut count = 0;
    for step in 0..size {
        let diagonal = |k: usize| entries[k * size + k].abs();
        let mut next = step;
        for k in step + 1..size {
            if diagonal(k) > diagonal(next) {
                next = k;
            }
        }
        swap(entries, size, step, (next, next));
        let pivot = entries[step * size + step];
        if pivot == T::zero() {
            break;
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
    count
}
