//! The constraint Jacobian decomposed by singular values.
//!
//! In:  a Jacobian, the scales of its rows and columns.
//! Out: least-change solutions of `J x = y`, damped or truncated.

use super::scales::Scales;
use crate::Real;
use crate::linalg::{Breakdown, dot, orthogonalise};
use nalgebra::{SMatrix, SVector};

/// `Ĵ = U Σ Vᵀ` with `Ĵ = rows · J · columns`.
#[derive(Clone, Debug)]
pub(super) struct Decomposition<T, const N: usize, const R: usize> {
    /// `σ_i u_i`, largest first.
    left: SMatrix<T, R, N>,
    /// `v_i`.
    right: SMatrix<T, N, N>,
    /// `σ_i`.
    values: SVector<T, N>,
}

impl<T: Real, const N: usize, const R: usize> Decomposition<T, N, R> {
    /// Decomposes a Jacobian in these scales.
    pub(super) fn new(
        jacobian: &SMatrix<T, R, N>,
        scales: &Scales<T, N, R>,
    ) -> Result<Self, Breakdown> {
        let left = SMatrix::<T, R, N>::from_fn(|k, j| {
            scales.rows[k] * jacobian[(k, j)] * scales.columns[j]
        });
        Self::of(left)
    }

    /// Decomposes a matrix that is scaled already.
    pub(super) fn of(mut left: SMatrix<T, R, N>) -> Result<Self, Breakdown> {
        let mut right =
            SMatrix::<T, N, N>::from_fn(|i, j| if i == j { T::one() } else { T::zero() });
        orthogonalise(&mut left.data.0, &mut right.data.0)?;
        let values = SVector::from_fn(|i, _| dot(&left.data.0[i], &left.data.0[i]).sqrt());
        Ok(Self {
            left,
            right,
            values,
        })
    }

    /// The unknowns `x` of least norm that solve `Ĵ x = y` as well as the
    /// singular values above `cut` can, damped by `damping` (relative to the
    /// square of the largest); and by how much `|y|²` falls to `|y − Ĵ x|²`.
    pub(super) fn solve(&self, y: &SVector<T, R>, cut: T, damping: T) -> (SVector<T, N>, T) {
        let mut x = SVector::zeros();
        let mut fall = T::zero();
        for i in 0..self.rank(cut) {
            let square = self.values[i] * self.values[i];
            let damping = damping * self.largest() * self.largest();
            let product = dot(&self.left.data.0[i], &y.data.0[0]);
            let share = product / (square + damping);
            let kept = damping / (square + damping);
            fall += product * product / square * (T::one() - kept * kept);
            for j in 0..N {
                x[j] += self.right[(j, i)] * share;
            }
        }
        (x, fall)
    }

    /// `y` without what the singular values above `cut` can produce.
    pub(super) fn unreachable(&self, y: &SVector<T, R>, cut: T) -> SVector<T, R> {
        let mut rest = *y;
        for i in 0..self.rank(cut) {
            let value = self.values[i];
            let share = dot(&self.left.data.0[i], &rest.data.0[0]) / (value * value);
            for k in 0..R {
                rest[k] -= self.left[(k, i)] * share;
            }
        }
        rest
    }

    /// The unknowns that each column of `v_i` stands for, where the matrix leaves
    /// them free at `cut`; the other columns are zero.
    pub(super) fn null_space(&self, cut: T) -> SMatrix<T, N, N> {
        let mut basis = self.right;
        for column in basis.data.0.iter_mut().take(self.rank(cut)) {
            *column = [T::zero(); N];
        }
        basis
    }

    /// The largest singular value.
    pub(super) fn largest(&self) -> T {
        self.values
            .iter()
            .fold(T::zero(), |most: T, x| most.max(*x))
    }

    /// How many singular values are above `cut`.
    pub(super) fn rank(&self, cut: T) -> usize {
        (0..N).take_while(|&i| self.values[i] > cut).count()
    }
}
