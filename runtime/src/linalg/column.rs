//! What the factorisations do to columns, which nalgebra stores as arrays.
//!
//! In:  arrays of one length.
//! Out: products and norms, without bounds checks since the length is a type.

use crate::Real;

/// `aᵀb`.
#[inline(always)]
pub(crate) fn dot<T: Real, const L: usize>(a: &[T; L], b: &[T; L]) -> T {
    let mut sum = T::zero();
    for i in 0..L {
        sum += a[i] * b[i];
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
        target[i] += factor * column[i];
    }
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
