//! What the factorisations do to columns, which nalgebra stores as arrays.
//!
//! In:  arrays of one length.
//! Out: products and norms, without bounds checks since the length is a type.

use crate::Real;

/// Sums that a long product is taken in side by side, so that none waits for another.
const LANES: usize = 8;

/// `aᵀb`.
#[inline(always)]
pub(crate) fn dot<T: Real, const L: usize>(a: &[T; L], b: &[T; L]) -> T {
    let mut sum = T::zero();
    if L < 2 * LANES {
        for i in 0..L {
            sum += a[i] * b[i];
        }
        return sum;
    }
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

/// `√(aᵀa)`.
pub(crate) fn norm<T: Real, const L: usize>(a: &[T; L]) -> T {
    dot(a, a).sqrt()
}

/// `target += factor · column`.
#[inline(always)]
pub(crate) fn add_scaled<T: Real, const L: usize>(target: &mut [T; L], factor: T, column: &[T; L]) {
    for i in 0..L {
        target[i] = factor.mul_add(column[i], target[i]);
    }
}

/// `factor · column`.
#[inline(always)]
pub(crate) fn scaled<T: Real, const L: usize>(factor: T, column: &[T; L]) -> [T; L] {
    column.map(|entry| factor * entry)
}

/// Turns two columns about each other: `(c a − s b, s a + c b)`.
#[inline(always)]
pub(super) fn turn<T: Real, const L: usize>(a: &mut [T; L], b: &mut [T; L], c: T, s: T) {
    for i in 0..L {
        let (x, y) = (a[i], b[i]);
        a[i] = c * x - s * y;
        b[i] = s * x + c * y;
    }
}
