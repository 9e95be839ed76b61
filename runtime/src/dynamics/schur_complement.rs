//! The cheap path: constraints factorised where they are far from singular.
//!
//! In:  `A` and the metric `M = U Uᵀ`.
//! Out: the Schur complement `S = A M⁻¹ Aᵀ` of independent rows as LDLᵀ, with the
//!      squared sine that tells whether it may be used.
//!
//! Not here: anything that works near a singular position.

use super::{Metric, Rows};
use crate::Real;
use crate::linalg::{Gram, add_scaled, dot};
use nalgebra::{SMatrix, SVector};

/// Independent rows in the metric, `U⁻¹Aᵀ`, and the factor of their Gram matrix.
#[derive(Clone, Debug)]
pub(crate) struct SchurComplement<T, const N: usize, const R: usize> {
    vectors: SMatrix<T, N, R>,
    gram: Gram<T, R>,
    list: [usize; R],
    count: usize,
}

impl<T: Real, const N: usize, const R: usize> Default for SchurComplement<T, N, R> {
    fn default() -> Self {
        Self {
            vectors: SMatrix::zeros(),
            gram: Gram::default(),
            list: [0; R],
            count: 0,
        }
    }
}

impl<T: Real, const N: usize, const R: usize> SchurComplement<T, N, R> {
    /// Factorises the first `count` rows of `list` and returns the smallest
    /// squared sine of a row against the rows before it.
    pub(crate) fn factorise(
        &mut self,
        metric: &Metric<T, N>,
        jacobian: &SMatrix<T, R, N>,
        rows: &Rows<T, R>,
        (list, count): ([usize; R], usize),
    ) -> T {
        (self.list, self.count) = (list, count);
        for (k, &row) in list[..count].iter().enumerate() {
            self.vectors.data.0[k] = metric.lift(jacobian, row);
        }
        self.gram
            .factorise(&self.vectors, count, |k| rows.size[list[k]])
    }

    /// Adds to `w` the shortest change after which `A U⁻ᵀ w = right`.
    #[inline]
    pub(crate) fn correct(&self, w: &mut [T; N], right: &SVector<T, R>) {
        let multiplier = self.steps(w, right);
        for (entry, vector) in multiplier.iter().zip(&self.vectors.data.0[..self.count]) {
            add_scaled(w, *entry, vector);
        }
    }

    /// The multipliers `λ` of `M q̈ + Aᵀλ = p₁`, where `w` is the acceleration that the
    /// forces alone would give; zero for the rows that depend on the others.
    pub(crate) fn multiplier(&self, w: &[T; N], right: &SVector<T, R>) -> SVector<T, R> {
        let steps = self.steps(w, right);
        let mut multiplier = SVector::zeros();
        for (step, &row) in steps[..self.count].iter().zip(&self.list) {
            multiplier[row] = -*step;
        }
        multiplier
    }

    /// How far to go along each row for `A U⁻ᵀ w = right`.
    #[inline]
    fn steps(&self, w: &[T; N], right: &SVector<T, R>) -> [T; R] {
        let mut steps = [T::zero(); R];
        let vectors = self.vectors.data.0[..self.count].iter().zip(&self.list);
        for (step, (vector, &row)) in steps.iter_mut().zip(vectors) {
            *step = right[row] - dot(vector, w);
        }
        self.gram.solve(&mut steps);
        steps
    }
}
