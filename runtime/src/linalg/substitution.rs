//! Solutions of a system that is eliminated.
//!
//! In:  a [`Frame`], right-hand sides of its rows.
//! Out: solutions by forward and backward substitution, of all rows or of those that are not
//!      near-dependent.

use super::dot;
use super::frame::{Frame, Matrix};
use super::small::with_size;
use crate::Real;

/// Right-hand sides of the rows of a frame.
#[derive(Clone, Copy)]
pub(crate) enum Right<'a, T> {
    /// A multiple of some rows of a matrix of one column, of which they come first, and zeros.
    Column(T, Matrix<'a, T>),
    /// One for one row, zero for the others.
    Unit(usize),
    /// These.
    Given(&'a [T]),
}

impl<T: Real> Right<'_, T> {
    #[inline(always)]
    pub(super) fn fill(self, right: &mut [T]) {
        match self {
            Right::Column(factor, column) => {
                right.fill(T::zero());
                for (target, &row) in right.iter_mut().zip(column.rows) {
                    *target = factor * column.factors[row] * column.entries[row];
                }
            }
            Right::Unit(row) => {
                right.fill(T::zero());
                right[row] = T::one();
            }
            Right::Given(given) => right.copy_from_slice(given),
        }
    }
}

impl<T: Real> Frame<'_, T> {
    /// The largest right-hand side of the near-dependent rows when all others are
    /// eliminated.
    pub(crate) fn largest_reduced(&mut self, right: Right<'_, T>) -> T {
        let reduced = self.reduced(right);
        reduced.fold(T::zero(), |most, rest| most.max(rest.abs()))
    }

    /// The right-hand sides of the near-dependent rows when all others are eliminated.
    pub(crate) fn reduced(&mut self, right: Right<'_, T>) -> impl Iterator<Item = T> {
        let independent = self.order.independent;
        self.go_forward(right, independent);
        let frame = &*self;
        frame.order.rows[independent..].iter().map(move |&row| {
            let shares = &frame.lower[row * frame.n..][..independent];
            let mut rest = frame.right[row];
            for (share, y) in shares.iter().zip(&*frame.forward) {
                rest -= *share * *y;
            }
            rest
        })
    }

    /// The solution for the right-hand sides of all rows, each entry times a scale.
    pub(crate) fn solve(&mut self, right: Right<'_, T>, scales: &[T], x: &mut [T]) {
        self.solve_first(self.n, right, scales, x);
    }

    /// The solution that satisfies the rows before the near-dependent ones, and leaves
    /// these alone.
    pub(crate) fn solve_independent(&mut self, right: Right<'_, T>, scales: &[T], x: &mut [T]) {
        self.solve_first(self.order.independent, right, scales, x);
    }

    /// The solution for the rows of the first steps.
    fn solve_first(&mut self, steps: usize, right: Right<'_, T>, scales: &[T], x: &mut [T]) {
        with_size!(
            self.n,
            |N| self.solve_in::<N>(steps, right, scales, x),
            self.solve_any(steps, right, scales, x)
        );
    }

    fn solve_any(&mut self, steps: usize, right: Right<'_, T>, scales: &[T], x: &mut [T]) {
        self.go_forward(right, steps);
        self.go_backward(steps);
        for ((x, place), scale) in x.iter_mut().zip(self.places).zip(scales) {
            *x = self.backward[*place] * *scale;
        }
    }

    fn go_forward(&mut self, right: Right<'_, T>, steps: usize) {
        right.fill(self.right);
        let begins = |row: &usize| self.right[*row] != T::zero();
        let begin = self.order.rows[..steps].iter().position(begins);
        let begin = begin.unwrap_or(steps);
        self.forward[..begin].fill(T::zero());
        for step in begin..steps {
            let row = self.order.rows[step];
            let first = self.changed[row].clamp(begin, step);
            let shares = &self.lower[row * self.n..][first..step];
            let mut value = self.right[row];
            for (share, y) in shares.iter().zip(&self.forward[first..step]) {
                value -= *share * *y;
            }
            self.forward[step] = value;
        }
    }

    fn go_backward(&mut self, steps: usize) {
        self.backward.fill(T::zero());
        // Outside of these places the solution is zero so far.
        let (mut low, mut high) = (self.n, 0);
        for step in (0..steps).rev() {
            let (row, column) = (self.order.rows[step], self.order.columns[step]);
            let upper = &self.upper[row * self.n..][..self.n];
            let reach = self.reach(row);
            let (start, end) = (reach.start.max(low), reach.end.min(high));
            let mut rest = self.forward[step];
            if start < end {
                rest -= dot(&upper[start..end], &self.backward[start..end]);
            }
            if rest != T::zero() {
                self.backward[column] = rest / upper[column];
                (low, high) = (low.min(column), high.max(column + 1));
            }
        }
    }
}
