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
    for i in 0..n {
        order[i] = i;
        sizes[i] = T::zero();
        for entry in &matrix[i * n..(i + 1) * n] {
            sizes[i] = sizes[i].max(entry.size());
        }
    }
    for k in 0..n {
        let mut pivot = k;
        for i in k + 1..n {
            if matrix[i * n + k].size() / sizes[i] > matrix[pivot * n + k].size() / sizes[pivot] {
                pivot = i;
            }
        }
        let size = matrix[pivot * n + k].size();
        if !size.is_finite() || size == T::zero() {
            return false;
        }
        order.swap(k, pivot);
        sizes.swap(k, pivot);
        for j in 0..n {
            matrix.swap(k * n + j, pivot * n + j);
        }
        for i in k + 1..n {
            let factor = matrix[i * n + k] / matrix[k * n + k];
            matrix[i * n + k] = factor;
            for j in k + 1..n {
                matrix[i * n + j] = matrix[i * n + j] - factor * matrix[k * n + j];
            }
        }
    }
    true
}

/// `x = A⁻¹ y` with the factors and the order of the rows.
pub(super) fn solve<T: Real, F: Entry<T>>(factors: &[F], order: &[usize], y: &[F], x: &mut [F]) {
    let n = order.len();
    for i in 0..n {
        x[i] = y[order[i]];
        for j in 0..i {
            x[i] = x[i] - factors[i * n + j] * x[j];
        }
    }
    for i in (0..n).rev() {
        for j in i + 1..n {
            x[i] = x[i] - factors[i * n + j] * x[j];
        }
        x[i] = x[i] / factors[i * n + i];
    }
}
