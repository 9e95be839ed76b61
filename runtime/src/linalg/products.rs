//! Rows that are safely independent, by their products with one another.
//!
//! In:  the entries of a scaled Jacobian `Ĵ`.
//! Out: which rows are safely independent; for them, solutions of
//!      `(Ĵ Ĵᵀ + s) z = y` by Cholesky's factor.
//!
//! Products square what is small, so that an equation is left to singular values, with all
//! that it shares coordinates with, directly or by others, where that would cost more than
//! half of the digits. Everywhere else, which is almost everywhere, this takes a number of
//! operations that grows with the entries that are not zero, and singular values the cube of
//! the number of coordinates.

use super::{Breakdown, Workspace, dot};
use crate::Real;

/// Products of the rows of a Jacobian and their factor, over slices.
#[derive(Debug)]
pub(crate) struct RowProducts<'a, T> {
    /// Products of different rows above the diagonal, Cholesky's factor on and below it,
    /// column by column.
    entries: &'a mut [T],
    /// Squares of the rows.
    squares: &'a mut [T],
    /// For each row one of those that it is connected with by coordinates, the same for all
    /// of them.
    component: &'a mut [usize],
    /// For each component, whether its rows are left to singular values: not zero then.
    unsafe_components: &'a mut [usize],
    /// A column of the Jacobian, or a unit vector.
    column: &'a mut [T],
    /// Of each component, the squares of the entries of `L⁻¹`, and the largest of its rows.
    inverse: &'a mut [T],
    largest: &'a mut [T],
}

/// What the sum of the squares of the inverse singular values may be, relative to the largest
/// row: solutions by products have half of the digits then, and singular values are above
/// any that count as zero.
fn most_inverse<T: Real>() -> T {
    T::one() / T::EPSILON.sqrt()
}

impl<'a, T: Real> RowProducts<'a, T> {
    /// Those of no rows yet. They take a square matrix of all rows, four vectors and two
    /// lists.
    pub(crate) fn new(rows: usize, workspace: &Workspace<'a, T>) -> Self {
        Self {
            entries: workspace.numbers(rows * rows),
            squares: workspace.numbers(rows),
            component: workspace.indices(rows),
            unsafe_components: workspace.indices(rows),
            column: workspace.numbers(rows),
            inverse: workspace.numbers(rows),
            largest: workspace.numbers(rows),
        }
    }

    fn rows(&self) -> usize {
        self.squares.len()
    }

    /// Multiplies and judges the rows of a matrix of `n` columns, each of which is written by
    /// `column`.
    pub(crate) fn compute(
        &mut self,
        n: usize,
        column: &mut dyn FnMut(usize, &mut [T]),
    ) -> Result<(), Breakdown> {
        self.entries.fill(T::zero());
        self.squares.fill(T::zero());
        self.unsafe_components.fill(0);
        for (row, component) in self.component.iter_mut().enumerate() {
            *component = row;
        }
        self.column.fill(T::zero());
        for j in 0..n {
            column(j, self.column);
            self.add();
        }
        let sum = self.squares.iter().fold(T::zero(), |sum, x| sum + *x);
        if !sum.is_finite() {
            return Err(Breakdown);
        }
        self.factorise(T::zero());
        self.judge();
        Ok(())
    }

    /// Whether a row and all that it is connected with are safely independent.
    pub(crate) fn is_safe(&self, row: usize) -> bool {
        self.unsafe_components[self.component[row]] == 0
    }

    /// Whether the inverse singular values of the safe rows of each component are below that
    /// of a bound, in the mean of their squares.
    pub(crate) fn are_above(&self, least: T) -> bool {
        (0..self.rows()).all(|component| {
            let of_it = |row: &usize| self.component[*row] == component && self.is_safe(*row);
            let count = T::from_f64((0..self.rows()).filter(of_it).count() as f64);
            self.inverse[component] * self.largest[component] * least * least <= count
        })
    }

    /// An upper bound of the largest squared singular value of the safe rows.
    pub(crate) fn largest_square(&self) -> T {
        let count = self.rows();
        let safe = (0..count).filter(|row| self.is_safe(*row));
        safe.fold(T::zero(), |most: T, row| {
            let others = (0..count).filter(|other| *other != row);
            let sum = others.fold(self.squares[row], |sum, other| {
                let (first, second) = (row.min(other), row.max(other));
                sum + self.entries[second * count + first].abs()
            });
            most.max(sum)
        })
    }

    /// Replaces the factor by that of `Ĵ Ĵᵀ + s`. What has no positive pivot, with all that
    /// it is connected with, is not safe.
    pub(crate) fn factorise(&mut self, s: T) {
        let count = self.rows();
        for j in 0..count {
            let (earlier, rest) = self.entries.split_at_mut(j * count);
            // The factor begins as the products that are above the diagonal.
            rest[j] = self.squares[j] + s;
            for i in j + 1..count {
                rest[i] = rest[(i - j) * count + j];
            }
            let column = &mut rest[j..count];
            for earlier in earlier.chunks_exact(count) {
                let factor = earlier[j];
                if factor != T::zero() {
                    for (entry, above) in column.iter_mut().zip(&earlier[j..]) {
                        *entry -= factor * *above;
                    }
                }
            }
            let pivot = column[0];
            // A comparison with NaN is false, so that a pivot that is NaN is not safe.
            let is_large = pivot * most_inverse() > self.squares[j].max(T::one());
            let component = self.component[j];
            if !is_large {
                self.unsafe_components[component] = 1;
            }
            if self.unsafe_components[component] == 0 {
                let inverse = T::one() / pivot.sqrt();
                column.iter_mut().for_each(|entry| *entry *= inverse);
            } else {
                column.fill(T::zero());
                column[0] = T::one();
            }
        }
    }

    /// Turns `y` into the `z` of the safe rows with `(Ĵ Ĵᵀ + s) z = y`; zero in the others.
    pub(crate) fn solve(&self, z: &mut [T]) {
        let count = self.rows();
        for (row, entry) in z.iter_mut().enumerate() {
            if !self.is_safe(row) {
                *entry = T::zero();
            }
        }
        forward(self.entries, z, 0);
        for j in (0..count).rev() {
            let factor = &self.entries[j * count..(j + 1) * count];
            let mut value = z[j];
            for i in j + 1..count {
                value -= factor[i] * z[i];
            }
            z[j] = value / factor[j];
        }
    }

    /// Adds what the entries of the column contribute.
    fn add(&mut self) {
        let count = self.rows();
        let mut first = None;
        for i in 0..count {
            let entry = self.column[i];
            if entry == T::zero() {
                continue;
            }
            self.squares[i] += entry * entry;
            let Some(first) = first else {
                first = Some(i);
                continue;
            };
            self.connect(first, i);
            // The rows before this one that the column meets.
            for k in first..i {
                self.entries[i * count + k] += self.column[k] * entry;
            }
        }
    }

    /// Takes note that two rows have a coordinate in common.
    fn connect(&mut self, row: usize, other: usize) {
        let (to, from) = (self.component[row], self.component[other]);
        if from != to {
            for component in self.component.iter_mut().filter(|c| **c == from) {
                *component = to;
            }
        }
    }

    /// Leaves those components to singular values whose rows are near-dependent: the squares
    /// of the inverse singular values add up to those of the entries of `L⁻¹`.
    fn judge(&mut self) {
        self.inverse.fill(T::zero());
        self.largest.fill(T::one());
        for row in 0..self.rows() {
            if !self.is_safe(row) {
                continue;
            }
            self.column.fill(T::zero());
            self.column[row] = T::one();
            forward(self.entries, self.column, row);
            let component = self.component[row];
            self.inverse[component] += dot(self.column, self.column);
            self.largest[component] = self.largest[component].max(self.squares[row]);
        }
        for component in 0..self.rows() {
            let is_regular = self.inverse[component] * self.largest[component] <= most_inverse();
            if !is_regular {
                self.unsafe_components[component] = 1;
            }
        }
    }
}

/// `x := L⁻¹ x`, of which the entries before the first are zero.
fn forward<T: Real>(factor: &[T], x: &mut [T], first: usize) {
    let count = x.len();
    for j in first..count {
        if x[j] != T::zero() {
            let column = &factor[j * count..(j + 1) * count];
            x[j] /= column[j];
            let value = x[j];
            for (entry, below) in x[j + 1..].iter_mut().zip(&column[j + 1..]) {
                *entry -= value * *below;
            }
        }
    }
}
