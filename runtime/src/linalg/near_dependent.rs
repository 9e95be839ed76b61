//! Elimination of the near-dependent rows, which come last.
//!
//! In:  rows that are reduced by all others.
//! Out: their block, and its factors, the largest entry first.

use super::block::{largest_of, peak_of};
use super::frame::{Frame, NotRegular};
use super::is_zero;
use crate::Real;

impl<T: Real> Frame<'_, T> {
    /// Keeps the block of the near-dependent rows, which are reduced by all others, and
    /// eliminates it, the largest entry first; as far as it goes where the block is
    /// singular, which leaves a frame that solves nothing.
    pub(super) fn take_near_dependent(&mut self) -> Result<(), NotRegular> {
        let first = self.order.independent;
        self.smallest = T::one();
        for step in 0..first {
            let (row, column) = (self.order.rows[step], self.order.columns[step]);
            if row < self.order.constraints {
                self.smallest = self.smallest.min(self.entry(row, column).abs());
            }
        }
        self.block.clear(self.n - first);
        if first == self.n {
            return Ok(());
        }
        // In any order, for a block that cannot be eliminated to the end.
        self.marks.fill(0);
        for &column in &self.order.columns[..first] {
            self.marks[column] = 1;
        }
        let open = (0..self.n).filter(|column| self.marks[*column] == 0);
        for (place, column) in self.order.columns[first..].iter_mut().zip(open) {
            *place = column;
        }
        for (place, &column) in self.order.columns[first..].iter().enumerate() {
            self.marks[column] = place;
        }
        for (k, &row) in self.order.rows[first..].iter().enumerate() {
            let reach = self.reach(row);
            let entries = &self.upper[row * self.n..][reach.clone()];
            for (entry, column) in entries.iter().zip(reach) {
                // Columns of pivots hold zeros.
                if *entry != T::zero() {
                    self.block.row_mut(k)[self.marks[column]] = *entry;
                }
            }
        }
        match first + 1 == self.n {
            true => self.take_only(),
            false => self.eliminate_near_dependent(),
        }
    }

    /// The only near-dependent row.
    fn take_only(&mut self) -> Result<(), NotRegular> {
        let last = self.n - 1;
        let (row, column) = (self.order.rows[last], self.order.columns[last]);
        let size = self.entry(row, column).abs();
        self.smallest = self.smallest.min(size);
        match size == T::zero() {
            true => Ok(()),
            false => self.take(last, row, column),
        }
    }

    /// Eliminates the near-dependent rows, the largest entry first.
    fn eliminate_near_dependent(&mut self) -> Result<(), NotRegular> {
        let first = self.order.independent;
        for place in first..self.n {
            let row = self.order.rows[place];
            let reach = self.reach(row);
            (self.spans[2 * row], self.spans[2 * row + 1]) = (reach.start, reach.end);
            self.peaks[place - first] = self.peak(row);
            self.lower[row * self.n + first..(row + 1) * self.n].fill(T::zero());
        }
        (first..self.n).try_for_each(|step| self.eliminate_largest(step))
    }

    /// The size of the largest entry of a row.
    fn peak(&self, row: usize) -> T {
        peak_of(&self.upper[row * self.n..][self.span(row)])
    }

    /// Makes the row with the largest entry of those near-dependent ones that are left the
    /// next one, and that entry its pivot; nothing if all are zero.
    fn eliminate_largest(&mut self, step: usize) -> Result<(), NotRegular> {
        let first = self.order.independent;
        let left = step - first..self.n - first;
        let (ahead, largest) = largest_of(&self.peaks[left.clone()]);
        self.smallest = self.smallest.min(largest);
        if largest == T::zero() {
            // What is not finite has no size either.
            let mut rest = self.order.rows[step..].iter();
            return match rest.all(|row| is_zero(&self.upper[row * self.n..][..self.n])) {
                true => Ok(()),
                false => Err(NotRegular),
            };
        }
        self.order.rows.swap(step, step + ahead);
        self.peaks.swap(left.start, left.start + ahead);
        let row = self.order.rows[step];
        let (column, _) = self.largest(row);
        let columns = &mut self.order.columns[step..];
        if let Some(place) = columns.iter().position(|other| *other == column) {
            columns.swap(0, place);
        }
        self.take(step, row, column)?;
        for place in step + 1..self.n {
            let row = self.order.rows[place];
            if self.entry(row, column) != T::zero() {
                self.eliminate(row, step);
                self.peaks[place - first] = self.peak(row);
            }
        }
        Ok(())
    }
}
