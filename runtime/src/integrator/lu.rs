//! Square linear systems, real or complex, by Gaussian elimination.
//!
//! In:  an `N × N` matrix as rows.
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

/// `P A = L U`, with `L` below and `U` on and above the diagonal of one matrix.
#[derive(Clone, Debug)]
pub(super) struct Lu<F, const N: usize> {
    factors: [[F; N]; N],
    order: [usize; N],
}

impl<F, const N: usize> Lu<F, N> {
    /// Factorises; `None` if the matrix is singular or not finite.
    pub(super) fn new<T: Real>(matrix: [[F; N]; N]) -> Option<Self>
    where
        F: Entry<T>,
    {
        let mut sizes =
            matrix.map(|row| row.iter().fold(T::zero(), |most: T, x| most.max(x.size())));
        let mut this = Self {
            factors: matrix,
            order: core::array::from_fn(|i| i),
        };
        for k in 0..N {
            let mut pivot = k;
            for i in k + 1..N {
                let relative = |i: usize| this.factors[i][k].size() / sizes[i];
                if relative(i) > relative(pivot) {
                    pivot = i;
                }
            }
            let size = this.factors[pivot][k].size();
            if !size.is_finite() || size == T::zero() {
                return None;
            }
            this.factors.swap(k, pivot);
            this.order.swap(k, pivot);
            sizes.swap(k, pivot);
            this.eliminate(k);
        }
        Some(this)
    }

    /// Subtracts row `k` from the rows below, so that column `k` is zero there,
    /// and keeps the factors in its place.
    fn eliminate<T>(&mut self, k: usize)
    where
        F: Entry<T>,
    {
        let pivot = self.factors[k];
        for row in self.factors.iter_mut().skip(k + 1) {
            let factor = row[k] / pivot[k];
            row[k] = factor;
            for j in k + 1..N {
                row[j] = row[j] - factor * pivot[j];
            }
        }
    }

    /// `A⁻¹ y`.
    pub(super) fn solve<T>(&self, y: &[F; N]) -> [F; N]
    where
        F: Entry<T>,
    {
        let mut x = self.order.map(|i| y[i]);
        for i in 0..N {
            for j in 0..i {
                x[i] = x[i] - self.factors[i][j] * x[j];
            }
        }
        for i in (0..N).rev() {
            for j in i + 1..N {
                x[i] = x[i] - self.factors[i][j] * x[j];
            }
            x[i] = x[i] / self.factors[i][i];
        }
        x
    }
}
