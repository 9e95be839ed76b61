//! Square linear systems, real or complex, by Gaussian elimination.
//!
//! In:  a square matrix as rows, one after the other.
//! Out: its factors, and solutions.
//!
//! Rows are compared after division by their largest entry, so that the choice
//! of pivots does not depend on the units of the rows.

use crate::Real;
use core::ops::{Div, Mul, Sub};
use nalgebra::Complex;

/// What a matrix can consist of.
pub(super) trait Entry<T>:
    Copy + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// A norm.
    fn size(self) -> T;
}

impl<T: Real> Entry<T> for T {
    fn size(self) -> T {
        self.abs()
    }
}

impl<T: Real> Entry<T> for Complex<T> {
    fn size(self) -> T {
        self.re.abs() + self.im.abs()
    }
}

/// Factorises a matrix in its place, `P A = L U` with `L` below and `U` on and above the
/// diagonal, with room for the order of its rows and their sizes;
/// whether it is regular and finite.
pub(super) fn factorise<T: Real, F: Entry<T>>(
    matrix: &mut [F],
    order: &mut [usize],
    sizes: &mut [T],
) -> bool {
    let n = order.len();
    let sizes = &mut sizes[..n];
    for i in 0..n {
        order[i] = i;
        let row = matrix[i * n..][..n].iter();
        sizes[i] = row.fold(T::zero(), |most: T, entry| most.max(entry.size()));
    }
    for k in 0..n {
        let (mut pivot, mut size) = (k, matrix[k * n + k].size());
        if k + 1 < n {
            let mut most = size / sizes[k];
            for i in k + 1..n {
                let other = matrix[i * n + k].size();
                let ratio = other / sizes[i];
                if ratio > most {
                    (pivot, size, most) = (i, other, ratio);
                }
            }
        }
        if !size.is_finite() || size == T::zero() {
            return false;
        }
        let (above, below) = matrix.split_at_mut((k + 1) * n);
        let row = &mut above[k * n..];
        if pivot != k {
            order.swap(k, pivot);
            sizes.swap(k, pivot);
            row.swap_with_slice(&mut below[(pivot - k - 1) * n..][..n]);
        }
        let row = &row[k..];
        for i in 0..n - k - 1 {
            let other = &mut below[i * n + k..][..row.len()];
            let factor = other[0] / row[0];
            other[0] = factor;
            for (entry, above) in other[1..].iter_mut().zip(&row[1..]) {
                *entry = *entry - factor * *above;
            }
        }
    }
    true
}

/// `x = A⁻¹ y` with the factors and the order of the rows.
#[inline]
pub(super) fn solve<T: Real, F: Entry<T>>(factors: &[F], order: &[usize], y: &[F], x: &mut [F]) {
    let n = order.len();
    let (y, x) = (&y[..n], &mut x[..n]);
    for i in 0..n {
        let row = &factors[i * n..][..n];
        let mut value = y[order[i]];
        for j in 0..i {
            value = value - row[j] * x[j];
        }
        x[i] = value;
    }
    for i in (0..n).rev() {
        let row = &factors[i * n..][..n];
        let mut value = x[i];
        for j in i + 1..n {
            value = value - row[j] * x[j];
        }
        x[i] = value / row[i];
    }
}
