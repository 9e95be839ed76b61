//! Rows that are plainly independent of each other.
//!
//! In:  rows `Â` of the constraints in the metric and scaled to size one.
//! Out: some of them, each at a wide angle to those before it, and what these decide:
//!      the part of a vector along them, the shortest vector that satisfies them.
//!
//! Singular values are needed only for what is left of the others. So the robust path
//! of a long chain costs what its weak loops cost, not what all of them would.

use crate::Real;
use crate::linalg::{Gram, add_scaled, dot, solid};
use nalgebra::SMatrix;

/// Some rows, and the factor of their Gram matrix.
pub(super) struct Solid<T, const R: usize> {
    list: [usize; R],
    gram: Gram<T, R>,
}

impl<T: Real, const R: usize> Default for Solid<T, R> {
    fn default() -> Self {
        Self {
            list: [0; R],
            gram: Gram::default(),
        }
    }
}

impl<T: Real, const R: usize> Solid<T, R> {
    /// Takes at most `limit` of some rows, as they come.
    pub(super) fn choose<const N: usize>(
        &mut self,
        rows: &SMatrix<T, N, R>,
        candidates: impl Iterator<Item = usize>,
        limit: usize,
    ) {
        let spans = core::array::from_fn(|row| span(&rows.data.0[row]));
        self.gram.clear();
        for row in candidates {
            if self.gram.count() < limit.min(R) {
                self.try_row(rows, &spans, row, solid());
            }
        }
    }

    /// Takes the rows that were taken at a state nearby; `false` if not all of them are
    /// independent.
    pub(super) fn take_again<const N: usize>(
        &mut self,
        rows: &SMatrix<T, N, R>,
        list: &[usize],
    ) -> bool {
        let spans = core::array::from_fn(|row| span(&rows.data.0[row]));
        self.gram.clear();
        for &row in list {
            self.try_row(rows, &spans, row, T::zero());
        }
        self.gram.count() == list.len()
    }

    /// Takes a row if the sine of its angle to those before it is above `least`.
    fn try_row<const N: usize>(
        &mut self,
        rows: &SMatrix<T, N, R>,
        spans: &[[usize; 2]; R],
        row: usize,
        least: T,
    ) {
        let x = &rows.data.0;
        let mut products = [T::zero(); R];
        for (product, &other) in products.iter_mut().zip(self.list()) {
            let ([from, to], [begin, end]) = (spans[row], spans[other]);
            if from < end && begin < to {
                *product = dot(&x[row], &x[other]);
            }
        }
        let square = dot(&x[row], &x[row]);
        let count = self.gram.count();
        if self.gram.extend(products, square, least * least) {
            self.list[count] = row;
        }
    }

    /// Which rows, in the order in which they were taken.
    pub(super) fn list(&self) -> &[usize] {
        &self.list[..self.gram.count()]
    }

    /// The sine of the angle of a row to those before it, in the same order.
    pub(super) fn sine(&self, k: usize) -> T {
        self.gram.pivot(k).sqrt()
    }

    /// The shares of these rows in a vector, in the order of the list.
    pub(super) fn shares<const N: usize>(&self, rows: &SMatrix<T, N, R>, x: &[T; N]) -> [T; R] {
        let left = self
            .list()
            .iter()
            .map(|&row| (&rows.data.0[row], T::zero()));
        self.gram.steps(left, x).map(|step| -step)
    }

    /// Adds to `w` the shortest change after which these rows have the values `right`.
    pub(super) fn satisfy<const N: usize>(
        &self,
        rows: &SMatrix<T, N, R>,
        w: &mut [T; N],
        right: &[T; R],
    ) {
        let wanted = self
            .list()
            .iter()
            .map(|&row| (&rows.data.0[row], right[row]));
        let steps = self.gram.steps(wanted, w);
        for (step, &row) in steps.iter().zip(self.list()) {
            add_scaled(w, *step, &rows.data.0[row]);
        }
    }
}

/// From its first to after its last entry that is not zero: what is local in a
/// mechanism has products with its neighbours only.
fn span<T: Real, const N: usize>(x: &[T; N]) -> [usize; 2] {
    let is_entry = |entry: &T| *entry != T::zero();
    let from = x.iter().position(is_entry).unwrap_or(N);
    let to = x.iter().rposition(is_entry).map_or(from, |last| last + 1);
    [from, to]
}
