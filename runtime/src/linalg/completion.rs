//! Fewer rows than columns, completed to a basis.
//!
//! In:  a frame whose first rows are set, the others zero.
//! Out: its factors with unit rows in the place of the others; by them a right inverse of the
//!      rows, which bounds their smallest singular value, and what they leave free.
//!
//! It takes a number of operations that grows with the entries that are not zero, where
//! singular values take the cube of the number of columns.

use super::dot;
use super::frame::{Frame, NotRegular};
use super::substitution::Right;
use crate::Real;

impl<T: Real> Frame<'_, T> {
    /// Sets a row of a frame that was begun anew.
    pub(crate) fn set_row(&mut self, row: usize, entries: &[T]) {
        for (column, entry) in entries.iter().enumerate() {
            if *entry != T::zero() {
                self.set_entry(row, column, *entry);
            }
        }
    }

    /// Eliminates the first rows, of which those come last of which less than `least` is left,
    /// and makes the others unit rows, in the columns that have no pivot.
    pub(crate) fn complete(&mut self, count: usize, least: T) -> Result<(), NotRegular> {
        // Rows of zeros come after all others.
        self.factorise(self.n, least)?;
        for step in count..self.n {
            let (row, column) = (self.order.rows[step], self.order.columns[step]);
            if row < count {
                return Err(NotRegular);
            }
            self.upper[row * self.n + column] = T::one();
            (self.spans[2 * row], self.spans[2 * row + 1]) = (column, column + 1);
        }
        Ok(())
    }

    /// A lower bound of the singular values of the first rows of a frame that was completed:
    /// `1/‖X‖` in Frobenius' norm for a right inverse `X`, since none is smaller than the
    /// pseudoinverse. `scales` are ones.
    pub(crate) fn least_singular_value(&mut self, count: usize, scales: &[T], x: &mut [T]) -> T {
        let mut sum = T::zero();
        for row in 0..count {
            self.solve(Right::Unit(row), scales, x);
            sum += dot(x, x);
        }
        T::one() / sum.sqrt()
    }
}
