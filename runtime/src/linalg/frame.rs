//! Elimination of constraint rows and tangent rows, near-dependent rows last.
//!
//! In:  a square system: `k` constraint rows and the `N − k` rows that measure how far a
//!      vector goes along a tangent space.
//! Out: its factors; the block that near-dependent rows leave when all others are
//!      eliminated; the sign of the determinant; solutions.
//!
//! Where a combination of constraint rows loses its gradient, so does the block, and
//! nothing else: its entries are smooth along the constraint set and its determinant
//! changes sign where sheets of the set cross.
//!
//! Rows are visited in the given order and entries that are zero are skipped, so that
//! what is local in a chain of loops stays local.

use super::block::{Block, largest_of};
use super::{add_scaled, dot};
use crate::Real;
use nalgebra::SMatrix;

/// The factors of a square system.
#[derive(Clone, Debug)]
pub(crate) struct Frame<T, const N: usize, const R: usize> {
    /// What is left of each row when the rows before it are eliminated.
    upper: SMatrix<T, N, N>,
    /// How much of each row before it a row loses, in the order of elimination.
    lower: SMatrix<T, N, N>,
    /// Rows in the order of elimination, and the column of each one's pivot.
    rows: [usize; N],
    columns: [usize; N],
    /// How many rows come before the near-dependent ones.
    independent: usize,
    /// How many rows are constraint rows.
    constraints: usize,
    block: Block<T, R>,
    smallest: T,
}

/// A pivot vanished, or something is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NotRegular;

impl<T: Real, const N: usize, const R: usize> Frame<T, N, R> {
    pub(crate) fn new() -> Self {
        Self {
            upper: SMatrix::zeros(),
            lower: SMatrix::zeros(),
            rows: [0; N],
            columns: [0; N],
            independent: 0,
            constraints: 0,
            block: Block::zeros(0),
            smallest: T::zero(),
        }
    }

    /// The rows to be eliminated: constraint rows first. Their columns should be scaled
    /// to one size, the rows too.
    pub(crate) fn rows_mut(&mut self) -> &mut [[T; N]; N] {
        &mut self.upper.data.0
    }

    /// Eliminates all rows, of which the first `constraints` are constraint rows; one of
    /// these of which less than `least` is left by those before it comes last.
    pub(crate) fn factorise(&mut self, constraints: usize, least: T) -> Result<(), NotRegular> {
        let mut late = [(0, 0); R];
        let mut done = 0;
        let mut waiting = 0;
        for row in 0..N {
            self.reduce(row, 0, done);
            let (column, size) = self.largest(row);
            if row < constraints && size < least {
                late[waiting] = (row, done);
                waiting += 1;
                continue;
            }
            self.take(done, row, column)?;
            done += 1;
        }
        self.independent = done;
        self.constraints = constraints;
        self.take_late(&late[..waiting])
    }

    /// Eliminates the rows in the order of another frame, so that the blocks of both can
    /// be compared.
    pub(crate) fn factorise_like(&mut self, other: &Self) -> Result<(), NotRegular> {
        (self.rows, self.columns) = (other.rows, other.columns);
        self.constraints = other.constraints;
        self.independent = other.independent;
        for step in 0..self.independent {
            let (row, column) = (self.rows[step], self.columns[step]);
            self.reduce(row, 0, step);
            self.take(step, row, column)?;
        }
        let mut late = [(0, 0); R];
        let mut waiting = 0;
        for row in 0..N {
            if other.rows[other.independent..].contains(&row) {
                late[waiting] = (row, 0);
                waiting += 1;
            }
        }
        self.take_late(&late[..waiting])
    }

    /// Subtracts from a row what makes its entries in some pivot columns vanish.
    fn reduce(&mut self, row: usize, from: usize, to: usize) {
        for step in from..to {
            let (pivot_row, column) = (self.rows[step], self.columns[step]);
            let entry = self.upper.data.0[row][column];
            if entry == T::zero() {
                self.lower.data.0[row][step] = T::zero();
                continue;
            }
            let pivot = self.upper.data.0[pivot_row];
            let share = entry / pivot[column];
            self.lower.data.0[row][step] = share;
            add_scaled(&mut self.upper.data.0[row], -share, &pivot);
            self.upper.data.0[row][column] = T::zero();
        }
    }

    /// The largest entry of a row that is reduced, and its size; columns of pivots hold
    /// zeros.
    fn largest(&self, row: usize) -> (usize, T) {
        largest_of(&self.upper.data.0[row])
    }

    fn take(&mut self, step: usize, row: usize, column: usize) -> Result<(), NotRegular> {
        let pivot = self.upper.data.0[row][column];
        if pivot == T::zero() || !pivot.is_finite() {
            return Err(NotRegular);
        }
        (self.rows[step], self.columns[step]) = (row, column);
        Ok(())
    }

    /// Keeps the block of the near-dependent rows, each reduced by so many rows before,
    /// and eliminates it, the largest entry first; as far as it goes where the block is
    /// singular, which leaves a frame that solves nothing.
    fn take_late(&mut self, late: &[(usize, usize)]) -> Result<(), NotRegular> {
        let first = self.independent;
        let mut columns = [0; R];
        let open = (0..N).filter(|column| !self.columns[..first].contains(column));
        for (place, column) in columns.iter_mut().zip(open) {
            *place = column;
        }
        self.block.size = late.len();
        for row in &mut self.block.entries[..late.len()] {
            *row = [T::zero(); R];
        }
        for (k, &(row, from)) in late.iter().enumerate() {
            self.reduce(row, from, first);
            for (entry, &column) in self.block.entries[k].iter_mut().zip(&columns[..late.len()]) {
                *entry = self.upper.data.0[row][column];
            }
        }
        // In any order, for a block that cannot be eliminated to the end.
        for (k, (row, _)) in late.iter().enumerate() {
            (self.rows[first + k], self.columns[first + k]) = (*row, columns[k]);
        }
        self.smallest = T::one();
        for (&row, &column) in self.rows[..first].iter().zip(&self.columns) {
            if row < self.constraints {
                self.smallest = self.smallest.min(self.upper.data.0[row][column].abs());
            }
        }
        self.eliminate_late()
    }

    /// Eliminates the near-dependent rows, the largest entry first.
    #[inline(never)]
    fn eliminate_late(&mut self) -> Result<(), NotRegular> {
        let mut peaks = [(0, T::zero()); N];
        for &row in &self.rows[self.independent..] {
            peaks[row] = self.largest(row);
        }
        for step in self.independent..N {
            let size = self.bring_largest(step, &peaks);
            self.smallest = self.smallest.min(size);
            if size == T::zero() {
                return Ok(());
            }
            let column = self.columns[step];
            self.take(step, self.rows[step], column)?;
            for place in step + 1..N {
                let row = self.rows[place];
                let changes = self.upper.data.0[row][column] != T::zero();
                self.reduce(row, step, step + 1);
                if changes {
                    peaks[row] = self.largest(row);
                }
            }
        }
        Ok(())
    }

    /// Makes the row with the largest entry of those that are left the next one, and that
    /// entry its pivot; its size.
    fn bring_largest(&mut self, step: usize, peaks: &[(usize, T); N]) -> T {
        let peak = |place: usize| peaks[self.rows[place]];
        let larger = |best: usize, place: usize| match peak(place).1 > peak(best).1 {
            true => place,
            false => best,
        };
        let place = (step + 1..N).fold(step, larger);
        let (column, size) = peak(place);
        self.rows.swap(step, place);
        if let Some(place) = (step..N).find(|place| self.columns[*place] == column) {
            self.columns.swap(step, place);
        }
        size
    }

    /// The row that comes last.
    pub(crate) fn weakest_row(&self) -> usize {
        self.rows.last().copied().unwrap_or_default()
    }

    /// The block of near-dependent rows.
    pub(crate) fn block(&self) -> &Block<T, R> {
        &self.block
    }

    /// The smallest pivot of a constraint row: about the sine by which the weakest
    /// combination of them is independent.
    pub(crate) fn smallest(&self) -> T {
        self.smallest
    }

    /// The determinant; with its sign where it is not so small that it counts as zero.
    pub(crate) fn determinant(&self) -> T {
        let pivots = self.rows.iter().zip(&self.columns);
        let size = pivots.fold(T::one(), |product, (&row, &column)| {
            product * self.upper.data.0[row][column].abs()
        });
        if self.is_negative() { -size } else { size }
    }

    /// The sign of the determinant.
    pub(crate) fn is_negative(&self) -> bool {
        let mut negative = false;
        let mut columns: [usize; N] = [0; N];
        for (&row, &column) in self.rows.iter().zip(&self.columns) {
            negative ^= self.upper.data.0[row][column] < T::zero();
            columns[row] = column;
        }
        for i in 0..N {
            while columns[i] != i {
                let other = columns[i];
                columns.swap(i, other);
                negative = !negative;
            }
        }
        negative
    }

    /// The right-hand sides of the near-dependent rows when all others are eliminated.
    pub(crate) fn reduced(&self, right: &[T; N]) -> [T; R] {
        let y = self.forward(right, self.independent);
        let mut rest = [T::zero(); R];
        let late = self.rows[self.independent..].iter();
        for (rest, &row) in rest.iter_mut().zip(late) {
            *rest = right[row];
            for (share, y) in self.lower.data.0[row][..self.independent].iter().zip(&y) {
                *rest -= *share * *y;
            }
        }
        rest
    }

    /// The solution for the right-hand sides of all rows.
    pub(crate) fn solve(&self, right: &[T; N]) -> [T; N] {
        let y = self.forward(right, N);
        self.backward(&y)
    }

    /// The solution that satisfies the rows before the near-dependent ones, and leaves
    /// these alone.
    pub(crate) fn solve_independent(&self, right: &[T; N]) -> [T; N] {
        let y = self.forward(right, self.independent);
        let mut x = [T::zero(); N];
        for step in (0..self.independent).rev() {
            let (row, column) = (self.rows[step], self.columns[step]);
            let upper = &self.upper.data.0[row];
            x[column] = (y[step] - dot(upper, &x)) / upper[column];
        }
        x
    }

    fn forward(&self, right: &[T; N], steps: usize) -> [T; N] {
        let mut y = [T::zero(); N];
        for step in 0..steps {
            let row = self.rows[step];
            let shares = &self.lower.data.0[row][..step];
            let mut value = right[row];
            for (share, y) in shares.iter().zip(&y) {
                value -= *share * *y;
            }
            y[step] = value;
        }
        y
    }

    fn backward(&self, y: &[T; N]) -> [T; N] {
        let mut x = [T::zero(); N];
        for step in (0..N).rev() {
            let (row, column) = (self.rows[step], self.columns[step]);
            let upper = &self.upper.data.0[row];
            x[column] = (y[step] - dot(upper, &x)) / upper[column];
        }
        x
    }
}
