//! The cheap path: constraints factorised where they are far from singular.
//!
//! In:  `A` and the metric `M = L Lᵀ`.
//! Out: the Schur complement `S = A M⁻¹ Aᵀ` of independent rows as LDLᵀ, with the
//!      squared sine that tells whether it may be used.
//!
//! Not here: anything that works near a singular position.

use super::{Metric, Rows};
use crate::Real;
use crate::linalg::{Gram, add_scaled, dot};
use nalgebra::{SMatrix, SVector};

/// Independent rows in the metric, `L⁻¹Aᵀ`, and the factor of their Gram matrix.
#[derive(Clone, Debug)]
pub(crate) struct Lifted<T, const N: usize, const R: usize> {
    vectors: SMatrix<T, N, R>,
    gram: Gram<T, R>,
    list: [usize; R],
    count: usize,
}

impl<T: Real, const N: usize, const R: usize> Default for Lifted<T, N, R> {
    fn default() -> Self {
        Self {
            vectors: SMatrix::zeros(),
            gram: Gram::default(),
            list: [0; R],
            count: 0,
        }
    }
}

impl<T: Real, const N: usize, const R: usize> Lifted<T, N, R> {
    /// Factorises the first `count` rows of `list` and returns the smallest
    /// squared sine of a row against the rows before it.
    pub(crate) fn factorise(
        &mut self,
        metric: &Metric<T, N>,
        jacobian: &SMatrix<T, R, N>,
        rows: &mut Rows<T, R>,
        (list, count): ([usize; R], usize),
    ) -> T {
        (self.list, self.count) = (list, count);
        for (k, &row) in list[..count].iter().enumerate() {
            let vector = metric.lift(jacobian, row);
            rows.observe(row, dot(&vector, &vector));
            self.vectors.data.0[k] = vector;
        }
        self.gram
            .factorise(&self.vectors, count, |k| rows.size(list[k]))
    }

    /// Adds to `w` the shortest change after which `A L⁻ᵀ w = right`.
    #[inline]
    pub(crate) fn correct(&self, w: &mut [T; N], right: &SVector<T, R>) {
        let vectors = &self.vectors.data.0[..self.count];
        let mut multiplier = [T::zero(); R];
        for ((entry, vector), &row) in multiplier.iter_mut().zip(vectors).zip(&self.list) {
            *entry = right[row] - dot(vector, w);
        }
        self.gram.solve(&mut multiplier);
        for (entry, vector) in multiplier.iter().zip(vectors) {
            add_scaled(w, *entry, vector);
        }
    }
}
