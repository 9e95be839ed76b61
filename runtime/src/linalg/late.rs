//! Elimination of the near-dependent rows, which come last.
//!
//! In:  rows that are reduced by all others.
//! Out: their block, and its factors, the largest entry first.

use super::block::{largest_of, peak_of};
use super::frame::{Frame, NotRegular};
use super::{add_scaled, is_zero, pair};
use crate::Real;

impl<T: Real> Frame<'_, T> {
    /// Keeps the block of the near-dependent rows, which are reduced by all others, and
    /// eliminates it, the largest entry first; as far as it goes where the block is
    /// singular, which leaves a frame that solves nothing.
    pub(super) fn take_late(&mut self) -> Result<(), NotRegular> {
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
        for k in 0..self.n - first {
            let row = self.order.rows[first + k];
            let columns = self.order.columns[first..].iter();
            for (entry, column) in self.block.row_mut(k).iter_mut().zip(columns) {
                *entry = self.upper[row * self.n + *column];
            }
        }
        match first + 1 == self.n {
            true => self.take_only(),
            false => self.eliminate_late(),
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

    /// Eliminates the near-dependent rows, the largest entry first, in a copy of their block.
    fn eliminate_late(&mut self) -> Result<(), NotRegular> {
        let (first, size) = (self.order.independent, self.n - self.order.independent);
        self.late[..size * size].copy_from_slice(self.block.all());
        self.marks[..size].copy_from_slice(&self.order.columns[first..]);
        let rows = self.late.chunks_exact(size);
        for (peak, row) in self.peaks.iter_mut().zip(rows).take(size) {
            *peak = peak_of(row);
        }
        let result = (0..size).try_for_each(|step| self.eliminate_largest(step, size));
        for (place, entries) in self.late[..size * size].chunks_exact(size).enumerate() {
            let row = self.order.rows[first + place];
            for (entry, column) in entries.iter().zip(&self.marks[..size]) {
                self.upper[row * self.n + *column] = *entry;
            }
            (self.spans[2 * row], self.spans[2 * row + 1]) = (0, self.n);
        }
        result
    }

    /// Makes the row with the largest entry of those near-dependent ones that are left the
    /// next one, and that entry its pivot; nothing if all are zero.
    fn eliminate_largest(&mut self, step: usize, size: usize) -> Result<(), NotRegular> {
        let first = self.order.independent;
        let (ahead, largest) = largest_of(&self.peaks[step..size]);
        self.smallest = self.smallest.min(largest);
        if largest == T::zero() {
            // What is not finite has no size either.
            let rest = &self.late[step * size..size * size];
            return if is_zero(rest) {
                Ok(())
            } else {
                Err(NotRegular)
            };
        }
        let place = step + ahead;
        if place != step {
            let [row, other] = pair(self.late, size, step, place);
            row.swap_with_slice(other);
            self.order.rows.swap(first + step, first + place);
            self.peaks.swap(step, place);
        }
        let (done, rest) = self.late[..size * size].split_at_mut((step + 1) * size);
        let pivot = &done[step * size..];
        let (local, _) = largest_of(pivot);
        let column = self.marks[local];
        let columns = &mut self.order.columns[first + step..];
        if let Some(place) = columns.iter().position(|other| *other == column) {
            columns.swap(0, place);
        }
        if !(pivot[local] != T::zero() && pivot[local].is_finite()) {
            return Err(NotRegular);
        }
        for (k, entries) in rest.chunks_exact_mut(size).enumerate() {
            let row = self.order.rows[first + step + 1 + k];
            let share = entries[local] / pivot[local];
            self.lower[row * self.n + first + step] = share;
            if share == T::zero() {
                continue;
            }
            add_scaled(entries, -share, pivot);
            entries[local] = T::zero();
            self.peaks[step + 1 + k] = peak_of(entries);
            self.changed[row] = self.changed[row].min(first + step);
        }
        Ok(())
    }
}
