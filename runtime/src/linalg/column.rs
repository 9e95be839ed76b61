//! What the factorisations do to columns.
//!
//! In:  slices of one length.
//! Out: products and norms.
//!
//! Slices, not arrays, so that code outside of the evaluations is compiled once, whatever
//! their length; where the length of a short one is known, the compiler makes use of it.

use crate::Real;

/// Sums that a long product is taken in side by side, so that none waits for another.
const LANES: usize = 8;

/// `aᵀb`.
#[inline]
pub(crate) fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    let mut sum = T::zero();
    if a.len() < 2 * LANES {
        for (a, b) in a.iter().zip(b) {
            sum += *a * *b;
        }
        return sum;
    }
    long_dot(a, b)
}

/// The scalar product of long columns, summed in lanes.
#[inline(never)]
fn long_dot<T: Real>(a: &[T], b: &[T]) -> T {
    let mut sum = T::zero();
    let mut sums = [T::zero(); LANES];
    let (a, a_rest) = a.as_chunks::<LANES>();
    let (b, b_rest) = b.as_chunks::<LANES>();
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    for (a, b) in a_rest.iter().zip(b_rest) {
        sum += *a * *b;
    }
    for part in sums {
        sum += part;
    }
    sum
}

/// Whether all entries are zero.
///
/// All of them are looked at, so that it can be done with several at once.
#[inline]
pub(crate) fn is_zero<T: Real>(entries: &[T]) -> bool {
    let differs = |any, entry: &T| any | (*entry != T::zero());
    !entries.iter().fold(false, differs)
}

/// Whether all entries are finite.
pub(crate) fn is_finite<T: Real>(entries: &[T]) -> bool {
    entries.iter().all(|entry| entry.is_finite())
}

/// How many entries are above a bound.
#[inline(never)]
pub(crate) fn count_above<T: Real>(entries: &[T], least: T) -> usize {
    entries.iter().filter(|entry| **entry > least).count()
}

/// `√(aᵀa)`.
pub(crate) fn norm<T: Real>(a: &[T]) -> T {
    dot(a, a).sqrt()
}

/// The largest absolute entry.
pub(crate) fn largest<T: Real>(entries: &[T]) -> T {
    let entries = entries.iter();
    entries.fold(T::zero(), |most: T, entry| most.max(entry.abs()))
}

/// The sign of an entry in one of the patterns that tell directions apart: one sign for all, and
/// then changes of sign at every, every other, every fourth one, and so on.
pub(crate) fn sign_of(pattern: usize, entry: usize) -> f64 {
    match pattern > 0 && (entry >> (pattern - 1)) % 2 == 1 {
        true => -1.0,
        false => 1.0,
    }
}

/// `target += factor · column`.
#[inline]
pub(crate) fn add_scaled<T: Real>(target: &mut [T], factor: T, column: &[T]) {
    for (target, entry) in target.iter_mut().zip(column) {
        *target = factor.mul_add(*entry, *target);
    }
}

/// `target += factor · matrix · x`, for a matrix of any size, column by column.
pub(crate) fn add_product<T: Real>(target: &mut [T], factor: T, matrix: &[T], x: &[T]) {
    // A matrix without rows has no columns, either.
    for (column, x) in matrix.chunks_exact(target.len().max(1)).zip(x) {
        add_scaled(target, factor * *x, column);
    }
}

/// Two of some columns of one length, to be changed.
pub(crate) fn pair<T>(columns: &mut [T], length: usize, i: usize, j: usize) -> [&mut [T]; 2] {
    let (low, high) = (i.min(j), i.max(j));
    let (before, rest) = columns.split_at_mut(high * length);
    let low = &mut before[low * length..(low + 1) * length];
    let high = &mut rest[..length];
    if i < j { [low, high] } else { [high, low] }
}

/// `factor · column`.
#[inline]
pub(crate) fn scaled<T: Real, const L: usize>(factor: T, column: &[T; L]) -> [T; L] {
    let mut scaled = *column;
    for entry in &mut scaled {
        *entry = factor * *entry;
    }
    scaled
}

/// A column by its entries. For the compiler this is a tenth of
/// [`from_fn`](core::array::from_fn), which has to go back where an entry panics.
#[inline(always)]
pub(crate) fn column<E: Copy + Default, const L: usize>(
    mut entry: impl FnMut(usize) -> E,
) -> [E; L] {
    let mut column = [E::default(); L];
    for (i, place) in column.iter_mut().enumerate() {
        *place = entry(i);
    }
    column
}

/// `column := factor · column`.
#[inline]
pub(crate) fn scale<T: Real>(column: &mut [T], factor: T) {
    for entry in column {
        *entry = factor * *entry;
    }
}
