//! LDLᵀ of a Gram matrix, with the angle of each row to the rows before it.
//!
//! In:  `k ≤ R` vectors of length `N` and their reference sizes.
//! Out: the factor of `S_ij = xᵢᵀxⱼ`, and the smallest squared sine.
//!
//! Not here: pivoting. The order of the rows is the caller's, and a small sine
//! tells the caller that this factor is not to be used.

use super::block::LONG;
use super::dot;
use crate::Real;
use nalgebra::SMatrix;

/// `S = L D Lᵀ`: unit lower factor below the diagonal, pivots on it.
#[derive(Clone, Debug)]
pub(crate) struct Gram<T, const R: usize> {
    factor: SMatrix<T, R, R>,
    count: usize,
}

impl<T: Real, const R: usize> Default for Gram<T, R> {
    fn default() -> Self {
        Self {
            factor: SMatrix::zeros(),
            count: 0,
        }
    }
}

impl<T: Real, const R: usize> Gram<T, R> {
    /// Factorises the Gram matrix of the first `count` columns of `vectors` and
    /// returns the smallest ratio of a pivot to its vector's reference size
    /// squared: the squared sine of the angle to the vectors before it, if the
    /// vector has its reference size.
    ///
    /// The result is zero if a pivot is not positive, or anything is not finite;
    /// the factor is then not complete.
    pub(crate) fn factorise<const N: usize>(
        &mut self,
        vectors: &SMatrix<T, N, R>,
        count: usize,
        reference: impl Fn(usize) -> T,
    ) -> T {
        self.count = count.min(R);
        let x = &vectors.data.0;
        let f = &mut self.factor.data.0;
        let mut smallest = T::one();
        for j in 0..self.count {
            let (done, rest) = f.split_at_mut(j);
            let column = &mut rest[0];
            for i in j..self.count {
                column[i] = dot(&x[i], &x[j]);
            }
            for (k, earlier) in done.iter().enumerate() {
                let factor = earlier[j] * earlier[k];
                if R >= LONG && factor == T::zero() {
                    continue;
                }
                for i in j..self.count {
                    column[i] -= factor * earlier[i];
                }
            }
            let pivot = column[j];
            let ratio = pivot / reference(j);
            if !(ratio > T::zero() && pivot.is_finite()) {
                return T::zero();
            }
            smallest = smallest.min(ratio);
            let inverse = T::one() / pivot;
            for entry in &mut column[j + 1..self.count] {
                *entry *= inverse;
            }
        }
        smallest
    }

    /// `x := S⁻¹ x` in the first entries of `x`.
    #[inline]
    pub(crate) fn solve(&self, x: &mut [T; R]) {
        let f = &self.factor.data.0;
        for j in 0..self.count {
            let value = x[j];
            for i in j + 1..self.count {
                x[i] -= value * f[j][i];
            }
        }
        for j in (0..self.count).rev() {
            let mut value = x[j] / f[j][j];
            for i in j + 1..self.count {
                value -= f[j][i] * x[i];
            }
            x[j] = value;
        }
    }
}
