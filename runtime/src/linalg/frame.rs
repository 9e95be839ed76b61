//! Elimination of constraint rows and tangent rows, near-dependent rows last.
//!
//! In:  a square system: `k` constraint rows and the `n − k` rows that measure how far a
//!      vector goes along a tangent space.
//! Out: its factors; the block that near-dependent rows leave when all others are
//!      eliminated; the sign of the determinant; solutions.
//!
//! Where a combination of constraint rows loses its gradient, so does the block, and
//! nothing else: its entries are smooth along the constraint set and its determinant
//! changes sign where sheets of the set cross.
//!
//! Rows are visited in the given order, of each row only the columns between its first and
//! last entry are touched, and of the rows before it only those that it shares a column with,
//! so that what is local in a chain of loops stays local. Columns are kept in an order in
//! which rows have their entries close to one another
//! ([`order_by_first_row`](super::order_by_first_row)).

use super::block::{Block, LONG, largest_of};
use super::small::with_size;
use super::workspace::Workspace;
use super::{add_scaled, pair};
use crate::Real;
use core::ops::Range;

/// The factors of a square system.
#[derive(Debug)]
pub(crate) struct Frame<'a, T> {
    pub(super) n: usize,
    /// Where each column is kept.
    pub(super) places: &'a [usize],
    /// What is left of each row when the rows before it are eliminated, row by row.
    pub(super) upper: &'a mut [T],
    /// How much of each row before it a row loses, in the order of elimination.
    pub(super) lower: &'a mut [T],
    /// The columns between which a row has entries.
    pub(super) spans: &'a mut [usize],
    /// The first elimination that changed a row.
    pub(super) changed: &'a mut [usize],
    /// In which step a column is eliminated, counted from one; zero for none yet.
    step_of: &'a mut [usize],
    pub(super) order: Order<'a>,
    pub(super) block: Block<'a, T>,
    pub(super) smallest: T,
    /// Right-hand sides, and solutions on the way.
    pub(super) right: &'a mut [T],
    pub(super) forward: &'a mut [T],
    pub(super) backward: &'a mut [T],
    /// Marks of rows or columns.
    pub(super) marks: &'a mut [usize],
    /// The largest entries of near-dependent rows while they are eliminated.
    pub(super) peaks: &'a mut [T],
}

/// The order of an elimination.
#[derive(Debug)]
pub(super) struct Order<'a> {
    /// Rows in the order of elimination, and the column of each one's pivot.
    pub(super) rows: &'a mut [usize],
    pub(super) columns: &'a mut [usize],
    /// How many rows come before the near-dependent ones.
    pub(super) independent: usize,
    /// How many rows are constraint rows.
    pub(super) constraints: usize,
}

/// An elimination that others are compared with.
#[derive(Debug)]
pub(crate) struct Eliminated<'a, T> {
    order: Order<'a>,
    block: Block<'a, T>,
    smallest: T,
}

impl<T: Real> Eliminated<'_, T> {
    /// The block of near-dependent rows.
    pub(crate) fn block(&self) -> &Block<'_, T> {
        &self.block
    }

    /// The smallest pivot of a constraint row.
    pub(crate) fn smallest(&self) -> T {
        self.smallest
    }
}

/// Some rows of a matrix, which is given column by column, and what each of all rows is
/// multiplied by.
#[derive(Clone, Copy)]
pub(crate) struct Matrix<'a, T> {
    pub(crate) entries: &'a [T],
    pub(crate) rows: &'a [usize],
    pub(crate) factors: &'a [T],
}

/// A pivot vanished, or something is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NotRegular;

impl<'a, T: Real> Frame<'a, T> {
    /// A frame of a system of as many rows as columns, of which as many as `constraints` may
    /// be near-dependent, and whose columns are kept in these places.
    pub(crate) fn new(
        places: &'a [usize],
        constraints: usize,
        workspace: &Workspace<'a, T>,
    ) -> Self {
        let n = places.len();
        let lists = workspace.indices(5 * n);
        let (spans, lists) = lists.split_at_mut(2 * n);
        let (changed, lists) = lists.split_at_mut(n);
        let (step_of, marks) = lists.split_at_mut(n);
        let (right, solutions) = workspace.any(3 * n).split_at_mut(n);
        let (forward, backward) = solutions.split_at_mut(n);
        Self {
            n,
            places,
            // Of long frames only some entries are set later.
            upper: match n < LONG {
                true => workspace.any(n * n),
                false => workspace.numbers(n * n),
            },
            lower: workspace.any(n * n),
            spans,
            changed,
            step_of,
            order: Order::new(n, workspace),
            block: Block::with_capacity(constraints, workspace),
            smallest: T::zero(),
            right,
            forward,
            backward,
            marks,
            peaks: workspace.any(constraints),
        }
    }

    /// What has been eliminated, to compare others with.
    pub(crate) fn eliminated<'b>(&self, workspace: &Workspace<'b, T>) -> Eliminated<'b, T> {
        let mut order = Order::new(self.n, workspace);
        order.set(&self.order);
        Eliminated {
            order,
            block: self.block.copy(workspace),
            smallest: self.smallest,
        }
    }

    /// Sets the first rows of a short frame to those of a matrix, and the others to columns,
    /// with scales of all entries.
    pub(crate) fn set_rows(&mut self, matrix: Matrix<'_, T>, columns: &[T], scales: &[T]) {
        with_size!(
            self.n,
            |N| self.set_rows_in::<N>(matrix, columns, scales),
            self.set_rows_of_any(matrix, columns, scales)
        );
    }

    fn set_rows_of_any(&mut self, matrix: Matrix<'_, T>, columns: &[T], scales: &[T]) {
        let mut targets = self.upper.chunks_exact_mut(self.n);
        for (&row, target) in matrix.rows.iter().zip(&mut targets) {
            let factor = matrix.factors[row];
            let entries = matrix.entries[row..].iter().step_by(matrix.factors.len());
            for (target, (entry, scale)) in target.iter_mut().zip(entries.zip(scales)) {
                *target = factor * *entry * *scale;
            }
        }
        for (target, column) in targets.zip(columns.chunks_exact(self.n)) {
            for (target, (entry, scale)) in target.iter_mut().zip(column.iter().zip(scales)) {
                *target = *entry * *scale;
            }
        }
    }

    /// Whether it pays to look for zeros.
    pub(crate) fn is_long(&self) -> bool {
        self.n >= LONG
    }

    /// Begins anew, with rows of zeros.
    pub(crate) fn clear(&mut self) {
        if !self.is_long() {
            return self.upper.fill(T::zero());
        }
        for row in 0..self.n {
            let (span, first) = (self.span(row), self.changed[row]);
            let entries = row * self.n..(row + 1) * self.n;
            self.upper[entries.clone()][span].fill(T::zero());
            self.lower[entries][first..].fill(T::zero());
        }
        self.spans.fill(0);
        self.changed.fill(self.n);
        self.step_of.fill(0);
    }

    /// Gives a row to be eliminated an entry: constraint rows first. Their columns should be
    /// scaled to one size, the rows too.
    #[inline]
    pub(crate) fn set_entry(&mut self, row: usize, column: usize, entry: T) {
        let place = self.places[column];
        self.upper[row * self.n + place] = entry;
        let span = &mut self.spans[2 * row..2 * row + 2];
        if span[1] == 0 {
            span[0] = place;
        }
        span[0] = span[0].min(place);
        span[1] = span[1].max(place + 1);
    }

    pub(super) fn entry(&self, row: usize, column: usize) -> T {
        self.upper[row * self.n + column]
    }

    /// The columns in which a row may have entries.
    pub(super) fn reach(&self, row: usize) -> Range<usize> {
        match self.is_long() {
            true => self.span(row),
            false => 0..self.n,
        }
    }

    pub(super) fn span(&self, row: usize) -> Range<usize> {
        self.spans[2 * row]..self.spans[2 * row + 1]
    }

    /// Eliminates all rows, of which the first `constraints` are constraint rows; one of
    /// these of which less than `least` is left by those before it comes last.
    pub(crate) fn factorise(&mut self, constraints: usize, least: T) -> Result<(), NotRegular> {
        self.order.constraints = constraints;
        with_size!(
            self.n,
            |N| self.factorise_in::<N>(least),
            self.factorise_any(least)
        )
    }

    fn factorise_any(&mut self, least: T) -> Result<(), NotRegular> {
        let constraints = self.order.constraints;
        let mut done = 0;
        let mut late = self.n;
        for row in 0..self.n {
            self.reduce(row, 0..done);
            let (column, size) = self.largest(row);
            if row < constraints && size < least {
                // From the end, the last one first.
                late -= 1;
                self.order.rows[late] = row;
                self.marks[row] = done;
                continue;
            }
            self.take(done, row, column)?;
            done += 1;
        }
        self.order.independent = done;
        self.order.rows[done..].reverse();
        for place in done..self.n {
            let row = self.order.rows[place];
            self.reduce(row, self.marks[row]..done);
        }
        self.take_near_dependent()
    }

    /// Eliminates the rows in the order of another elimination, so that the blocks of both
    /// can be compared.
    pub(crate) fn factorise_like(&mut self, other: &Eliminated<'_, T>) -> Result<(), NotRegular> {
        self.order.set(&other.order);
        with_size!(
            self.n,
            |N| self.factorise_ordered_in::<N>(),
            self.factorise_ordered()
        )
    }

    fn factorise_ordered(&mut self) -> Result<(), NotRegular> {
        let done = self.order.independent;
        for step in 0..done {
            let (row, column) = (self.order.rows[step], self.order.columns[step]);
            self.reduce(row, 0..step);
            self.take(step, row, column)?;
        }
        self.order.rows[done..].sort_unstable();
        for place in done..self.n {
            let row = self.order.rows[place];
            self.reduce(row, 0..done);
        }
        self.take_near_dependent()
    }

    /// Subtracts from a row what makes its entries in some pivot columns vanish.
    fn reduce(&mut self, row: usize, steps: Range<usize>) {
        if !self.is_long() {
            return self.reduce_short(row, steps);
        }
        let mut next = steps.start;
        while let Some(step) = self.next_shared(row, next..steps.end) {
            self.eliminate(row, step);
            next = step + 1;
        }
    }

    /// Subtracts from a row of a short frame what makes its entries in some pivot columns vanish.
    fn reduce_short(&mut self, row: usize, steps: Range<usize>) {
        let n = self.n;
        let order = self.order.rows[steps.clone()].iter();
        let columns = &self.order.columns[steps.clone()];
        let lower = &mut self.lower[row * n..(row + 1) * n][steps];
        for ((above, column), lower) in order.zip(columns).zip(lower) {
            let [target, pivot] = pair(self.upper, n, row, *above);
            *lower = target[*column] / pivot[*column];
            if *lower != T::zero() {
                add_scaled(target, -*lower, pivot);
                target[*column] = T::zero();
            }
        }
    }

    /// The first of some steps in whose column a row has an entry.
    fn next_shared(&self, row: usize, steps: Range<usize>) -> Option<usize> {
        let span = self.span(row);
        let entries = &self.upper[row * self.n..(row + 1) * self.n];
        if steps.len() <= span.len() {
            let columns = &self.order.columns[steps.clone()];
            let shared = columns.iter().position(|j| entries[*j] != T::zero())?;
            return Some(steps.start + shared);
        }
        let mut first = steps.end;
        for (entry, step) in entries[span.clone()].iter().zip(&self.step_of[span]) {
            if *entry != T::zero() && *step > steps.start && *step <= first {
                first = *step - 1;
            }
        }
        (first < steps.end).then_some(first)
    }

    /// Subtracts from a row what makes its entry in the pivot column of a step vanish.
    pub(super) fn eliminate(&mut self, row: usize, step: usize) {
        let (above, column) = (self.order.rows[step], self.order.columns[step]);
        let span = self.span(above);
        let [target, pivot] = pair(self.upper, self.n, row, above);
        let share = target[column] / pivot[column];
        add_scaled(&mut target[span.clone()], -share, &pivot[span.clone()]);
        target[column] = T::zero();
        self.lower[row * self.n + step] = share;
        self.changed[row] = self.changed[row].min(step);
        let [mut start, mut end] = [self.spans[2 * row], self.spans[2 * row + 1]];
        (start, end) = (start.min(span.start), end.max(span.end));
        while start < end && target[start] == T::zero() {
            start += 1;
        }
        while start < end && target[end - 1] == T::zero() {
            end -= 1;
        }
        (self.spans[2 * row], self.spans[2 * row + 1]) = (start, end);
    }

    /// The largest entry of a row that is reduced, and its size; columns of pivots hold
    /// zeros.
    pub(super) fn largest(&self, row: usize) -> (usize, T) {
        let reach = self.reach(row);
        if reach.is_empty() {
            return (0, T::zero());
        }
        let start = reach.start;
        let (column, size) = largest_of(&self.upper[row * self.n..][reach]);
        (start + column, size)
    }

    pub(super) fn take(
        &mut self,
        step: usize,
        row: usize,
        column: usize,
    ) -> Result<(), NotRegular> {
        let pivot = self.upper.get(row * self.n + column).copied();
        let pivot = pivot.unwrap_or_default();
        if pivot == T::zero() || !pivot.is_finite() {
            return Err(NotRegular);
        }
        (self.order.rows[step], self.order.columns[step]) = (row, column);
        self.step_of[column] = step + 1;
        Ok(())
    }

    /// The row that comes last.
    pub(crate) fn weakest_row(&self) -> usize {
        self.order.rows.last().copied().unwrap_or_default()
    }

    /// The block of near-dependent rows.
    pub(crate) fn block(&self) -> &Block<'a, T> {
        &self.block
    }

    /// The smallest pivot of a constraint row: about the sine by which the weakest
    /// combination of them is independent.
    pub(crate) fn smallest(&self) -> T {
        self.smallest
    }

    /// The smallest pivot of a constraint row that is not in the block.
    pub(crate) fn smallest_independent(&self) -> T {
        let Order { rows, columns, .. } = &self.order;
        let pivots = rows.iter().zip(&**columns).take(self.order.independent);
        let constraints = pivots.filter(|(row, _)| **row < self.order.constraints);
        constraints.fold(T::one(), |least: T, (row, column)| {
            least.min(self.entry(*row, *column).abs())
        })
    }

    /// The determinant, zero also where it is so small that it counts as zero.
    pub(crate) fn determinant(&mut self) -> T {
        let mut size = T::one();
        for (row, column) in self.order.rows.iter().zip(&*self.order.columns) {
            size *= self.upper[row * self.n + column].abs();
        }
        if self.is_negative() { -size } else { size }
    }

    /// The logarithm of the size of the determinant, however small that is; not finite where
    /// a pivot is zero.
    pub(crate) fn log_volume(&self) -> T {
        let (mut sum, mut size) = (T::zero(), T::one());
        for (row, column) in self.order.rows.iter().zip(&*self.order.columns) {
            // Pivots are no larger than one, and seldom so small.
            if size < T::EPSILON {
                sum += size.ln();
                size = T::one();
            }
            size *= self.upper[row * self.n + column].abs();
        }
        sum + size.ln()
    }

    /// The sign of the determinant.
    pub(crate) fn is_negative(&mut self) -> bool {
        with_size!(
            self.n,
            |N| self.is_negative_in::<N>(),
            self.is_negative_of_any()
        )
    }

    fn is_negative_of_any(&mut self) -> bool {
        let mut negative = false;
        for (row, column) in self.order.rows.iter().zip(&*self.order.columns) {
            negative ^= self.upper[row * self.n + column] < T::zero();
            self.marks[*row] = *column;
        }
        for i in 0..self.n {
            while self.marks[i] != i {
                let other = self.marks[i];
                self.marks.swap(i, other);
                negative = !negative;
            }
        }
        negative
    }
}

impl<'a> Order<'a> {
    fn new<T: Real>(n: usize, workspace: &Workspace<'a, T>) -> Self {
        let (rows, columns) = workspace.indices(2 * n).split_at_mut(n);
        Self {
            rows,
            columns,
            independent: 0,
            constraints: 0,
        }
    }

    fn set(&mut self, other: &Order<'_>) {
        self.rows.copy_from_slice(other.rows);
        self.columns.copy_from_slice(other.columns);
        (self.independent, self.constraints) = (other.independent, other.constraints);
    }
}
