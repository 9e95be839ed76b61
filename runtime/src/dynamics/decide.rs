//! Which directions are decided, by the rows or by the branch rows.
//!
//! In:  a [`Tangent`] with its solid rows.
//! Out: its other decisions, by singular values of what those rows leave of the others.
//!
//! Left vectors, which combine rows, are turned by Jacobi's rotations until what they
//! combine is orthogonal. There are as many as there are other rows: on a long chain
//! those of its weak loops.

use super::tangent::Level;
use super::{Metric, Rows, Tangent};
use crate::linalg::{
    Breakdown, add_scaled, branch_rank, dot, norm, orthogonalise, scaled, tangible, useless,
};
use crate::{Branch, Real};
use nalgebra::SMatrix;

impl<T: Real, const N: usize, const R: usize> Tangent<T, N, R> {
    /// Takes the directions that the rows decide with singular values above
    /// `threshold`, at most `limit`.
    pub(crate) fn take_strong(&mut self, threshold: T, limit: usize) -> Result<(), Breakdown> {
        self.take(Level::Rows, None, threshold, limit)?;
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
        let together = T::from_f64(1.5);
        while self.strong > self.first() {
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

    /// As at a state nearby where `strong` and `aimed` decisions were taken.
    pub(crate) fn take_counted(&mut self, strong: usize, aimed: usize) -> Result<(), Breakdown> {
        self.take_strong(T::zero(), aimed)?;
        self.strong = strong.min(self.used);
        self.branch = self.strong;
        Ok(())
    }

    /// Takes the directions that branch rows decide among those that are not strong.
    #[inline(never)]
    pub(crate) fn take_branch(
        &mut self,
        metric: &Metric<T, N>,
        rows: &Rows<T, R>,
        branch: &Branch<T, N, R>,
        limit: usize,
    ) -> Result<(), Breakdown> {
        for row in (0..R).filter(|&row| rows.takes_part(row, self.which)) {
            let vector = metric.lift(&branch.slope, row);
            self.slopes.data.0[row] = scaled(rows.scale(row), &vector);
            self.slope_bias[row] = rows.scale(row) * branch.bias[row];
            self.rate = self.rate.max(norm(&self.slopes.data.0[row]));
        }
        self.separate_slopes();
        let threshold = branch_rank::<T>() * self.rate;
        self.take(Level::Slopes, None, threshold, limit)?;
        if self.aimed > self.strong {
            let (directions, end) = (self.directions, self.used);
            let weak = &directions.data.0[self.strong..end];
            self.used = self.strong;
            self.take(Level::Slopes, Some(weak), threshold, end)?;
        }
        self.branch = self.used;
        Ok(())
    }

    /// Subtracts from the branch rows what is subtracted from the rows to make them
    /// independent of the solid ones.
    fn separate_slopes(&mut self) {
        for k in self.first()..self.end {
            let row = self.others[k];
            let shares = self.solid.shares(&self.rows, &self.rows.data.0[row]);
            for (share, &solid) in shares.iter().zip(self.solid.list()) {
                let slope = self.slopes.data.0[solid];
                add_scaled(&mut self.slopes.data.0[row], -*share, &slope);
                self.slope_bias[row] -= *share * self.slope_bias[solid];
            }
        }
    }

    /// Takes what the vanishing rows still decide above `threshold`.
    pub(crate) fn take_rest(&mut self, threshold: T, limit: usize) -> Result<(), Breakdown> {
        self.take(Level::Rows, None, threshold, limit)
    }

    /// Turns the left vectors that are not used so that what they combine is
    /// orthogonal, and takes what is larger than `threshold`: wherever nothing is
    /// decided, or in the span of some directions if they are given.
    #[inline(never)]
    pub(super) fn take(
        &mut self,
        level: Level,
        within: Option<&[[T; N]]>,
        threshold: T,
        limit: usize,
    ) -> Result<(), Breakdown> {
        let candidates = self.used..self.end;
        if self.used >= limit || candidates.is_empty() {
            return Ok(());
        }
        let mut images: SMatrix<T, N, R> = SMatrix::zeros();
        for j in candidates.clone() {
            images.data.0[j] = self.image(level, j, within);
        }
        let images = &mut images.data.0[candidates.clone()];
        orthogonalise(images, &mut self.left.data.0[candidates])?;
        for image in images {
            let size = norm(image);
            let enough = size > threshold.max(T::zero()) && self.used < limit;
            if !enough {
                break;
            }
            self.directions.data.0[self.used] = scaled(T::one() / size, image);
            self.values[self.used] = size;
            self.used += 1;
        }
        Ok(())
    }

    /// The combination of rows by a left vector, as far as it is at right angles to
    /// all that is decided.
    fn image(&self, level: Level, j: usize, within: Option<&[[T; N]]>) -> [T; N] {
        let mut image = [T::zero(); N];
        let matrix = self.matrix(level);
        for &row in self.others() {
            add_scaled(&mut image, self.left[(row, j)], &matrix.data.0[row]);
        }
        if let Some(within) = within {
            let whole = image;
            image = [T::zero(); N];
            for direction in within {
                add_scaled(&mut image, dot(direction, &whole), direction);
            }
        }
        self.remove_decided(&mut image);
        image
    }
}
