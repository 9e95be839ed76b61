//! The robust path: which directions the constraints leave free, at any position.
//!
//! In:  rows `Â` of the constraints in the metric and scaled to size one, and
//!      branch rows `K̂`, scaled likewise.
//! Out: an orthonormal basis of the metric space: strong directions, which the
//!      rows decide; branch directions, which the rows differentiated once more
//!      decide where the rows themselves vanish; what the vanishing rows still
//!      decide; and the free rest, the tangent space of the motion.
//!
//! Rows that are redundant everywhere decide nothing in either and drop out. At
//! rest in a singular position there are no branch rows (they are linear in the
//! velocities), and the tangent space is the whole null space of `A`, as in
//! Phong & Hoang (2012).

use super::{Metric, Rows, Which};
use crate::linalg::{
    Breakdown, add_scaled, branch_rank, dot, independent, norm, orthogonalise, tangible, useless,
};
use crate::{Branch, Real};
use nalgebra::{SMatrix, SVector};

/// The basis and what was decided about it.
///
/// Columns `0..strong` of `basis` are strong directions, `strong..branch` branch
/// directions, `branch..used` what else is decided, `used..N` free. Each decided
/// column has a left vector and a singular value.
pub(crate) struct Tangent<T, const N: usize, const R: usize> {
    pub(super) basis: SMatrix<T, N, N>,
    pub(super) left: SMatrix<T, R, R>,
    pub(super) values: SVector<T, N>,
    /// `Â` and `K̂`, a row in each column.
    pub(super) rows: SMatrix<T, N, R>,
    pub(super) slopes: SMatrix<T, N, R>,
    slope_bias: [T; R],
    which: Which,
    pub(crate) strong: usize,
    /// How many of the decided columns, the strong ones among them, the rows alone
    /// point to.
    pub(crate) aimed: usize,
    pub(crate) branch: usize,
    pub(crate) used: usize,
}

impl<T: Real, const N: usize, const R: usize> Tangent<T, N, R> {
    /// Lifts and scales the rows; decides nothing yet.
    pub(crate) fn new(
        metric: &Metric<T, N>,
        rows: &mut Rows<T, R>,
        jacobian: &SMatrix<T, R, N>,
        which: Which,
    ) -> Self {
        let mut lifted = SMatrix::zeros();
        for row in 0..R {
            if !rows.takes_part(row, which) {
                continue;
            }
            let vector = metric.lift(jacobian, row);
            rows.observe(row, dot(&vector, &vector));
            add_scaled(&mut lifted.data.0[row], rows.scale(row), &vector);
        }
        let mut basis: SMatrix<T, N, N> = SMatrix::zeros();
        basis.fill_diagonal(T::one());
        Self {
            basis,
            left: SMatrix::zeros(),
            values: SVector::zeros(),
            rows: lifted,
            slopes: SMatrix::zeros(),
            slope_bias: [T::zero(); R],
            which,
            strong: 0,
            aimed: 0,
            branch: 0,
            used: 0,
        }
    }

    /// Takes the directions that the rows decide with singular values above
    /// `threshold`, at most `limit`.
    pub(crate) fn take_strong(&mut self, threshold: T, limit: usize) -> Result<(), Breakdown> {
        let rows = self.rows;
        self.take(&rows, 0, N, threshold, limit)?;
        self.strong = self.used;
        self.aimed = self.used;
        self.branch = self.used;
        Ok(())
    }

    /// As [`take_strong`](Self::take_strong) at a state on the constraints: rows are
    /// strong down to where round-off is too large in them. The rows below still say
    /// which directions are free, better than the branch rows, which then only say
    /// what happens in the others.
    ///
    /// A group of singular values of nearly one size is not divided.
    pub(crate) fn take_landed(&mut self, limit: usize) -> Result<(), Breakdown> {
        self.take_strong(tangible(), limit)?;
        self.aimed = self.used;
        let together = T::from_f64(1.5);
        while self.strong > 0 {
            let value = self.values[self.strong - 1];
            let below = self.strong < self.used && value < self.values[self.strong] * together;
            if value >= useless() && !below {
                break;
            }
            self.strong -= 1;
        }
        self.branch = self.strong;
        Ok(())
    }

    /// As at a state nearby where `strong` and `aimed` directions were taken.
    pub(crate) fn take_counted(&mut self, strong: usize, aimed: usize) -> Result<(), Breakdown> {
        self.take_strong(T::zero(), strong)?;
        let rows = self.rows;
        self.take(&rows, self.strong, N, T::zero(), aimed)?;
        self.aimed = self.used;
        Ok(())
    }

    /// Takes the directions that branch rows decide among those that are not strong.
    pub(crate) fn take_branch(
        &mut self,
        metric: &Metric<T, N>,
        rows: &Rows<T, R>,
        branch: &Branch<T, N, R>,
        limit: usize,
    ) -> Result<(), Breakdown> {
        let mut largest = T::zero();
        for row in (0..R).filter(|&row| rows.takes_part(row, self.which)) {
            let vector = metric.lift(&branch.slope, row);
            add_scaled(&mut self.slopes.data.0[row], rows.scale(row), &vector);
            self.slope_bias[row] = rows.scale(row) * branch.bias[row];
            largest = largest.max(norm(&self.slopes.data.0[row]));
        }
        let slopes = self.slopes;
        let threshold = branch_rank::<T>() * largest;
        self.take(&slopes, self.used, N, threshold, limit)?;
        let end = self.used;
        self.used = self.strong;
        self.take(&slopes, self.strong, end, threshold, end)?;
        self.branch = self.used;
        Ok(())
    }

    /// Takes what the vanishing rows still decide above `threshold`.
    pub(crate) fn take_rest(&mut self, threshold: T, limit: usize) -> Result<(), Breakdown> {
        let rows = self.rows;
        self.take(&rows, self.used, N, threshold, limit)
    }

    /// Orthogonalises `matrix · basis` in the columns `from..to` after removing
    /// the left vectors already used, and takes the columns above `threshold`.
    pub(super) fn take(
        &mut self,
        matrix: &SMatrix<T, N, R>,
        from: usize,
        to: usize,
        threshold: T,
        limit: usize,
    ) -> Result<(), Breakdown> {
        let mut images: SMatrix<T, R, N> = SMatrix::zeros();
        for j in from..to {
            let image = &mut images.data.0[j];
            for (entry, row) in image.iter_mut().zip(&matrix.data.0) {
                *entry = dot(row, &self.basis.data.0[j]);
            }
            for left in &self.left.data.0[..self.used.min(R)] {
                add_scaled(image, -dot(left, image), left);
            }
        }
        orthogonalise(
            &mut images.data.0[from..to],
            &mut self.basis.data.0[from..to],
        )?;
        for image in &images.data.0[from..to] {
            let size = norm(image);
            let enough = size > threshold && self.used < limit.min(R);
            if !enough {
                break;
            }
            let mut left = [T::zero(); R];
            if size > T::zero() {
                add_scaled(&mut left, T::one() / size, image);
            }
            self.left.data.0[self.used] = left;
            self.values[self.used] = size;
            self.used += 1;
        }
        Ok(())
    }

    /// The `w` nearest to `free` that satisfies what was decided: `Â w = right` in
    /// the strong directions, `K̂ w = κ̂` in the branch directions. The latter lacks
    /// `Â` times the jerk, see [`across`](Self::across).
    pub(crate) fn solve(&self, right: &[T; R], free: &[T; N]) -> [T; N] {
        let mut w = [T::zero(); N];
        self.advance(&mut w, &self.rows, right, 0..self.strong);
        for direction in &self.basis.data.0[self.used..] {
            add_scaled(&mut w, dot(direction, free), direction);
        }
        self.advance(
            &mut w,
            &self.slopes,
            &self.slope_bias,
            self.strong..self.branch,
        );
        self.advance(&mut w, &self.rows, right, self.branch..self.used);
        w
    }

    /// How a branch direction answers to the jerk: for the left vector returned
    /// first, the solution moves by minus the second, times the product of the left
    /// vector with `Â` times the jerk.
    pub(crate) fn across(&self, j: usize) -> ([T; R], [T; N]) {
        let mut w = [T::zero(); N];
        add_scaled(&mut w, T::one() / self.values[j], &self.basis.data.0[j]);
        if self.branch < self.used {
            self.advance(&mut w, &self.rows, &[T::zero(); R], self.branch..self.used);
        }
        (self.left.data.0[j], w)
    }

    /// Moves `w` along some decided directions until their rows are satisfied.
    pub(super) fn advance(
        &self,
        w: &mut [T; N],
        matrix: &SMatrix<T, N, R>,
        right: &[T; R],
        range: core::ops::Range<usize>,
    ) {
        let mut gap = *right;
        for (entry, row) in gap.iter_mut().zip(&matrix.data.0) {
            *entry -= dot(row, w);
        }
        for j in range {
            let share = dot(&self.left.data.0[j], &gap) / self.values[j];
            add_scaled(w, share, &self.basis.data.0[j]);
        }
    }

    /// How many directions are decided with singular values above `threshold`.
    pub(crate) fn rank(&self, threshold: T) -> usize {
        let decided = self.values.data.0[0][..self.used].iter();
        decided.filter(|value| **value > threshold).count()
    }

    /// Whether rows that are not zero elsewhere vanish here, and the velocity does not
    /// say how they change.
    pub(crate) fn at_rest_with_vanished_rows(&self, rows: &Rows<T, R>) -> bool {
        let vanished = |row: usize| {
            rows.takes_part(row, self.which)
                && rows.scale(row) > T::zero()
                && norm(&self.rows.data.0[row]) < independent()
                && norm(&self.slopes.data.0[row]) < independent()
        };
        (0..R).any(vanished)
    }

    /// The scaled rows in the metric.
    pub(crate) fn rows(&self) -> &SMatrix<T, N, R> {
        &self.rows
    }

    /// The decided directions.
    pub(crate) fn decided(&self) -> impl Iterator<Item = &[T; N]> {
        self.basis.data.0[..self.used].iter()
    }

    /// The free directions.
    pub(crate) fn free(&self) -> impl Iterator<Item = &[T; N]> {
        self.basis.data.0[self.used..].iter()
    }

    /// Singular values of the decided directions, in falling order within each
    /// kind.
    pub(crate) fn values(&self) -> &[T] {
        &self.values.data.0[0][..self.used]
    }
}
