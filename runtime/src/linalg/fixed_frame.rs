//! Frames of fixed size, which the compiler knows.
//!
//! In:  a frame of up to eight rows.
//! Out: its rows, their elimination, solutions, without a check of any index that is in sight.
//!
//! What is done here is what [`super::frame`] and [`super::near_dependent`] do with frames of
//! any size, but for zeros, which are not looked for.

use super::block::{Block, largest_of};
use super::frame::{Frame, Matrix, NotRegular};
use super::is_zero;
use super::substitution::Right;
use crate::Real;

impl<T: Real> Frame<'_, T> {
    /// Sets the first rows to those of a matrix, and the others to columns.
    pub(super) fn set_rows_in<const N: usize>(
        &mut self,
        matrix: Matrix<'_, T>,
        columns: &[T],
        scales: &[T],
    ) {
        let targets = self.upper.as_chunks_mut::<N>().0;
        let scales = &scales[..N];
        let (first, last) = targets.split_at_mut(matrix.rows.len());
        for (target, &row) in first.iter_mut().zip(matrix.rows) {
            let factor = matrix.factors[row];
            let mut place = row;
            for j in 0..N {
                target[j] = factor * matrix.entries[place] * scales[j];
                place += matrix.factors.len();
            }
        }
        for (target, column) in last.iter_mut().zip(columns.as_chunks::<N>().0) {
            for j in 0..N {
                target[j] = column[j] * scales[j];
            }
        }
    }

    /// Eliminates all rows; a constraint row of which less than `least` is left by those
    /// before it comes last.
    pub(super) fn factorise_in<const N: usize>(&mut self, least: T) -> Result<(), NotRegular> {
        let mut fixed = FixedFrame::<T, N>::of(self);
        let result = fixed.factorise(least);
        let result = result.and_then(|()| fixed.take_near_dependent(&mut self.block));
        fixed.give_back(self);
        result
    }

    /// Eliminates the rows in the order at hand.
    pub(super) fn factorise_ordered_in<const N: usize>(&mut self) -> Result<(), NotRegular> {
        let mut fixed = FixedFrame::<T, N>::of(self);
        let result = fixed.factorise_ordered();
        let result = result.and_then(|()| fixed.take_near_dependent(&mut self.block));
        fixed.give_back(self);
        result
    }

    /// The sign of the determinant: that of its pivots, turned by every two of them that are
    /// not in the order of the rows or of the columns.
    pub(super) fn is_negative_in<const N: usize>(&self) -> bool {
        let (rows, columns) = (&self.order.rows[..N], &self.order.columns[..N]);
        let upper = self.upper.as_chunks::<N>().0;
        let mut negative = false;
        for i in 0..N {
            negative ^= upper[rows[i]][columns[i]] < T::zero();
            for j in 0..i {
                negative ^= (rows[j] > rows[i]) ^ (columns[j] > columns[i]);
            }
        }
        negative
    }

    /// The solution for the rows of the first steps.
    pub(super) fn solve_in<const N: usize>(
        &self,
        steps: usize,
        demanded: Right<'_, T>,
        scales: &[T],
        x: &mut [T],
    ) {
        let mut right = [T::zero(); N];
        demanded.fill(&mut right);
        let solution = match steps == N {
            true => self.solve_steps(N, &right),
            false => self.solve_steps(steps.min(N), &right),
        };
        let (x, scales) = (&mut x[..N], &scales[..N]);
        for j in 0..N {
            x[j] = solution[j] * scales[j];
        }
    }

    /// The solution for the rows of the first steps, before columns are scaled. Where `steps` is
    /// written as `N`, the compiler knows their number.
    #[inline(always)]
    fn solve_steps<const N: usize>(&self, steps: usize, right: &[T; N]) -> [T; N] {
        let (rows, columns) = (&self.order.rows[..N], &self.order.columns[..N]);
        let (lower, upper) = (self.lower.as_chunks::<N>().0, self.upper.as_chunks::<N>().0);
        let mut forward = [T::zero(); N];
        for step in 0..steps {
            let row = rows[step];
            let mut value = right[row];
            for other in 0..step {
                value -= lower[row][other] * forward[other];
            }
            forward[step] = value;
        }
        let mut solution = [T::zero(); N];
        for step in (0..steps).rev() {
            let (row, column) = (&upper[rows[step]], columns[step]);
            let mut known = T::zero();
            for (entry, x) in row.iter().zip(&solution) {
                known += *entry * *x;
            }
            solution[column] = (forward[step] - known) / row[column];
        }
        solution
    }
}

/// A frame of fixed size that is eliminated.
struct FixedFrame<T, const N: usize> {
    upper: [[T; N]; N],
    lower: [[T; N]; N],
    /// Rows in the order of elimination, and the column of each one's pivot.
    rows: [usize; N],
    columns: [usize; N],
    /// How many rows come before the near-dependent ones, how many are constraint rows.
    independent: usize,
    constraints: usize,
    /// The smallest pivot of a constraint row.
    smallest: T,
}

impl<T: Real, const N: usize> FixedFrame<T, N> {
    #[inline(always)]
    fn of(frame: &Frame<'_, T>) -> Self {
        let mut fixed = Self {
            upper: [[T::zero(); N]; N],
            lower: [[T::zero(); N]; N],
            rows: [0; N],
            columns: [0; N],
            independent: frame.order.independent,
            constraints: frame.order.constraints,
            smallest: T::one(),
        };
        fixed.upper.as_flattened_mut().copy_from_slice(frame.upper);
        fixed.rows.copy_from_slice(frame.order.rows);
        fixed.columns.copy_from_slice(frame.order.columns);
        fixed
    }

    #[inline(always)]
    fn give_back(&self, frame: &mut Frame<'_, T>) {
        frame.upper.copy_from_slice(self.upper.as_flattened());
        frame.lower.copy_from_slice(self.lower.as_flattened());
        frame.order.rows.copy_from_slice(&self.rows);
        frame.order.columns.copy_from_slice(&self.columns);
        frame.order.independent = self.independent;
        frame.smallest = self.smallest;
    }

    #[inline(always)]
    fn factorise(&mut self, least: T) -> Result<(), NotRegular> {
        let mut reduced = [0; N];
        let (mut done, mut late) = (0, N);
        for (row, reduced) in reduced.iter_mut().enumerate() {
            for step in 0..done {
                self.reduce(row, step);
            }
            let (column, size) = largest_of(&self.upper[row]);
            if row < self.constraints && size < least {
                // From the end, the last one first.
                late -= 1;
                self.rows[late] = row;
                *reduced = done;
                continue;
            }
            self.take(done, row, column)?;
            done += 1;
        }
        self.independent = done;
        self.rows[done..].reverse();
        for place in done..N {
            let row = self.rows[place];
            for step in reduced[row]..done {
                self.reduce(row, step);
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn factorise_ordered(&mut self) -> Result<(), NotRegular> {
        let done = self.independent;
        self.rows[done..].sort_unstable();
        for place in 0..N {
            let row = self.rows[place];
            for step in 0..place.min(done) {
                self.reduce(row, step);
            }
            if place < done {
                self.take(place, row, self.columns[place])?;
            }
        }
        Ok(())
    }

    /// Subtracts from a row what makes its entry in the pivot column of a step vanish.
    #[inline(always)]
    fn reduce(&mut self, row: usize, step: usize) {
        let (above, column) = (self.rows[step], self.columns[step]);
        let entry = self.upper[row][column];
        if entry != T::zero() {
            let pivot = self.upper[above];
            let share = entry / pivot[column];
            for (entry, above) in self.upper[row].iter_mut().zip(&pivot) {
                *entry = (-share).mul_add(*above, *entry);
            }
            self.upper[row][column] = T::zero();
            self.lower[row][step] = share;
        }
    }

    /// Makes an entry the pivot of a step.
    #[inline(always)]
    fn take(&mut self, step: usize, row: usize, column: usize) -> Result<(), NotRegular> {
        let pivot = self.upper[row][column];
        if pivot == T::zero() || !pivot.is_finite() {
            return Err(NotRegular);
        }
        if row < self.constraints {
            self.smallest = self.smallest.min(pivot.abs());
        }
        (self.rows[step], self.columns[step]) = (row, column);
        Ok(())
    }

    /// Keeps the block of the near-dependent rows, which are reduced by all others, and
    /// eliminates it.
    #[inline(always)]
    fn take_near_dependent(&mut self, block: &mut Block<'_, T>) -> Result<(), NotRegular> {
        block.resize(N - self.independent);
        match self.independent == N {
            true => Ok(()),
            false => self.eliminate_near_dependent(block),
        }
    }

    /// Eliminates the near-dependent rows, the largest entry first.
    #[inline(never)]
    fn eliminate_near_dependent(&mut self, block: &mut Block<'_, T>) -> Result<(), NotRegular> {
        let first = self.independent;
        self.open_columns();
        let mut peaks = [(0, T::zero()); N];
        let columns = &self.columns[first..];
        for (late, place) in (first..N).enumerate() {
            let row = &self.upper[self.rows[place]];
            peaks[place] = largest_of(row);
            for (entry, column) in block.row_mut(late).iter_mut().zip(columns) {
                *entry = row[*column];
            }
        }
        for step in first..N {
            let mut best = step;
            for place in step + 1..N {
                if peaks[place].1 > peaks[best].1 {
                    best = place;
                }
            }
            peaks.swap(step, best);
            self.rows.swap(step, best);
            let (column, size) = peaks[step];
            if size == T::zero() {
                self.smallest = size;
                return self.end_at(step);
            }
            for place in step + 1..N {
                if self.columns[place] == column {
                    self.columns.swap(step, place);
                }
            }
            self.take(step, self.rows[step], column)?;
            let rows = self.rows;
            for (peak, &row) in peaks[step + 1..].iter_mut().zip(&rows[step + 1..]) {
                self.reduce(row, step);
                *peak = largest_of(&self.upper[row]);
            }
        }
        Ok(())
    }

    /// Lists the columns without a pivot after the others, in any order for a block that can't
    /// be eliminated to the end.
    #[inline(always)]
    fn open_columns(&mut self) {
        let (taken, places) = self.columns.split_at_mut(self.independent);
        let mut is_taken = [false; N];
        for column in taken {
            is_taken[*column] = true;
        }
        let open = (0..N).filter(|column| !is_taken[*column]);
        for (place, column) in places.iter_mut().zip(open) {
            *place = column;
        }
    }

    /// Ends where the rows that are left are zero: what is not finite has no size either.
    fn end_at(&self, step: usize) -> Result<(), NotRegular> {
        match self.rows[step..]
            .iter()
            .all(|row| is_zero(&self.upper[*row]))
        {
            true => Ok(()),
            false => Err(NotRegular),
        }
    }
}
