//! Cholesky factor of a symmetric positive definite matrix.
//!
//! In:  `M`, `N × N`.
//! Out: `L` with `M = L Lᵀ`, or the pivot that is not safely positive; products
//!      with `L⁻¹`, `L⁻ᵀ` and `Lᵀ`; whether `M` is safely definite at all.
//!
//! Not here: what to do with a matrix that is only semi-definite.

use super::{definite, norm};
use crate::Real;
use nalgebra::SMatrix;

/// Whether a symmetric matrix is safely positive definite, whatever the units and
/// the order of its rows.
///
/// [`Cholesky::factorise`] takes the rows as they come. Of a semi-definite matrix with
/// a tiny diagonal entry it divides round-off by that entry, and sees no pivot vanish.
/// Here the largest pivot, relative to its diagonal entry, goes first.
pub(crate) fn is_definite<T: Real, const N: usize>(matrix: &SMatrix<T, N, N>) -> bool {
    let mut rest = *matrix;
    let mut done = [false; N];
    for _ in 0..N {
        let ratio = |j: &usize| rest[(*j, *j)] / matrix[(*j, *j)];
        let larger = |best: Option<usize>, j: usize| match best {
            Some(b) if ratio(&b) >= ratio(&j) => Some(b),
            _ => Some(j),
        };
        let open = (0..N).filter(|&j| !done[j]);
        let Some(next) = open.fold(None, larger) else {
            break;
        };
        let pivot = rest[(next, next)];
        // False for NaN, too.
        let is_large = pivot > definite::<T>() * matrix[(next, next)];
        if !is_large {
            return false;
        }
        done[next] = true;
        for j in (0..N).filter(|&j| !done[j]) {
            let share = rest[(next, j)] / pivot;
            for i in (0..N).filter(|&i| !done[i]) {
                let change = share * rest[(next, i)];
                rest[(i, j)] -= change;
            }
        }
    }
    true
}

/// The lower factor `L`; entries above the diagonal are not used.
#[derive(Clone, Debug)]
pub(crate) struct Cholesky<T, const N: usize> {
    lower: SMatrix<T, N, N>,
}

/// The first row whose pivot is not safely positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NotDefinite {
    pub(crate) row: usize,
}

impl<T: Real, const N: usize> Default for Cholesky<T, N> {
    fn default() -> Self {
        Self {
            lower: SMatrix::zeros(),
        }
    }
}

impl<T: Real, const N: usize> Cholesky<T, N> {
    /// Factorises `matrix`, of which the lower triangle is read.
    ///
    /// A pivot is compared with its diagonal entry, so the decision does not
    /// depend on the units of the rows. NaN and infinity are not definite.
    pub(crate) fn factorise(&mut self, matrix: &SMatrix<T, N, N>) -> Result<(), NotDefinite> {
        let lower = &mut self.lower.data.0;
        let source = &matrix.data.0;
        for j in 0..N {
            let (done, rest) = lower.split_at_mut(j);
            let column = &mut rest[0];
            column[j..].copy_from_slice(&source[j][j..]);
            for earlier in done.iter() {
                let factor = earlier[j];
                for i in j..N {
                    column[i] -= factor * earlier[i];
                }
            }
            let pivot = column[j];
            if !(pivot > definite::<T>() * source[j][j] && pivot.is_finite()) {
                return Err(NotDefinite { row: j });
            }
            let root = pivot.sqrt();
            let inverse = T::one() / root;
            column[j] = root;
            for entry in &mut column[j + 1..] {
                *entry *= inverse;
            }
        }
        Ok(())
    }

    /// `x := L⁻¹ x`.
    #[inline]
    pub(crate) fn forward(&self, x: &mut [T; N]) {
        let lower = &self.lower.data.0;
        for j in 0..N {
            let value = x[j] / lower[j][j];
            x[j] = value;
            for i in j + 1..N {
                x[i] -= value * lower[j][i];
            }
        }
    }

    /// `x := L⁻ᵀ x`.
    #[inline]
    pub(crate) fn backward(&self, x: &mut [T; N]) {
        let lower = &self.lower.data.0;
        for j in (0..N).rev() {
            let mut value = x[j];
            for i in j + 1..N {
                value -= lower[j][i] * x[i];
            }
            x[j] = value / lower[j][j];
        }
    }

    /// `L x`.
    pub(crate) fn product(&self, x: &[T; N]) -> [T; N] {
        let mut product = [T::zero(); N];
        for (j, column) in self.lower.data.0.iter().enumerate() {
            for i in j..N {
                product[i] += x[j] * column[i];
            }
        }
        product
    }

    /// `√(xᵀ M x)`, the length of `x` in the metric of the matrix.
    pub(crate) fn length(&self, x: &[T; N]) -> T {
        norm(&self.transposed_product(x))
    }

    /// `Lᵀ x`.
    pub(crate) fn transposed_product(&self, x: &[T; N]) -> [T; N] {
        let mut product = [T::zero(); N];
        for (j, column) in self.lower.data.0.iter().enumerate() {
            for i in j..N {
                product[j] += column[i] * x[i];
            }
        }
        product
    }
}
