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

use super::{Breakdown, dot};
use crate::Real;
use nalgebra::{SMatrix, SVector};

/// Products of the rows of a Jacobian and their factor.
#[derive(Clone, Debug)]
pub(crate) struct Products<T, const R: usize> {
    /// Products of different rows above the diagonal, Cholesky's factor on and below it.
    entries: SMatrix<T, R, R>,
    /// Squares of the rows.
    squares: SVector<T, R>,
    /// For each row one of those that it is connected with by coordinates, the same for all
    /// of them.
    component: [usize; R],
    /// Whether a row and all that it is connected with are safely independent.
    safe: [bool; R],
}

/// What the sum of the squares of the inverse singular values may be, relative to the largest
/// row: solutions by products have half of the digits then, and singular values are above
/// any that count as zero.
fn most_inverse<T: Real>() -> T {
    T::one() / T::EPSILON.sqrt()
}

impl<T: Real, const R: usize> Default for Products<T, R> {
    fn default() -> Self {
        Self {
            entries: SMatrix::zeros(),
            squares: SVector::zeros(),
            component: [0; R],
            safe: [false; R],
        }
    }
}

impl<T: Real, const R: usize> Products<T, R> {
    /// Multiplies and judges the rows of a matrix of `n` columns, each of which is written by
    /// `column`.
    pub(crate) fn compute(
        &mut self,
        n: usize,
        mut column: impl FnMut(usize, &mut [T; R]),
    ) -> Result<(), Breakdown> {
        self.entries.fill(T::zero());
        self.squares.fill(T::zero());
        self.component = core::array::from_fn(|row| row);
        self.safe = [true; R];
        let mut entries = [T::zero(); R];
        for j in 0..n {
            column(j, &mut entries);
            self.add(&entries);
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
        self.safe[row]
    }

    /// An upper bound of the largest squared singular value of the safe rows.
    pub(crate) fn largest_square(&self) -> T {
        let safe = (0..R).filter(|row| self.safe[*row]);
        safe.fold(T::zero(), |most: T, row| {
            let others = (0..R).filter(|other| *other != row);
            let sum = others.fold(self.squares[row], |sum, other| {
                sum + self.entries[(row.min(other), row.max(other))].abs()
            });
            most.max(sum)
        })
    }

    /// Replaces the factor by that of `Ĵ Ĵᵀ + s`. What has no positive pivot, with all that
    /// it is connected with, is not safe.
    pub(crate) fn factorise(&mut self, s: T) {
        for j in 0..R {
            let mut column = [T::zero(); R];
            column[j] = self.squares[j] + s;
            for (i, entry) in column.iter_mut().enumerate().skip(j + 1) {
                *entry = self.entries[(j, i)];
            }
            for earlier in &self.entries.data.0[..j] {
                let factor = earlier[j];
                if factor != T::zero() {
                    let below = earlier[j..].iter();
                    for (entry, above) in column[j..].iter_mut().zip(below) {
                        *entry -= factor * *above;
                    }
                }
            }
            let pivot = column[j];
            // False for NaN, too.
            let is_large = pivot * most_inverse() > self.squares[j].max(T::one());
            if !is_large {
                self.give_up(self.component[j]);
            }
            if self.safe[j] {
                let inverse = T::one() / pivot.sqrt();
                (j..R).for_each(|i| column[i] *= inverse);
            } else {
                column = [T::zero(); R];
                column[j] = T::one();
            }
            self.entries.data.0[j][j..].copy_from_slice(&column[j..]);
        }
    }

    /// The `z` of the safe rows with `(Ĵ Ĵᵀ + s) z = y`; zero in the others.
    pub(crate) fn solve(&self, y: &SVector<T, R>) -> [T; R] {
        let mut z = core::array::from_fn(|row| match self.safe[row] {
            true => y[row],
            false => T::zero(),
        });
        self.forward(&mut z, 0);
        let factor = &self.entries.data.0;
        for j in (0..R).rev() {
            let mut value = z[j];
            for i in j + 1..R {
                value -= factor[j][i] * z[i];
            }
            z[j] = value / factor[j][j];
        }
        z
    }

    /// `x := L⁻¹ x`, of which the entries before the first are zero.
    fn forward(&self, x: &mut [T; R], first: usize) {
        let factor = &self.entries.data.0;
        for j in first..R {
            if x[j] != T::zero() {
                x[j] /= factor[j][j];
                let value = x[j];
                let below = factor[j][j + 1..].iter();
                for (entry, below) in x[j + 1..].iter_mut().zip(below) {
                    *entry -= value * *below;
                }
            }
        }
    }

    /// Adds what the entries of a column contribute.
    fn add(&mut self, column: &[T; R]) {
        let mut first = None;
        for i in (0..R).filter(|i| column[*i] != T::zero()) {
            self.squares[i] += column[i] * column[i];
            let Some(first) = first else {
                first = Some(i);
                continue;
            };
            self.connect(first, i);
            // The rows before this one that the column meets.
            for k in first..i {
                self.entries[(k, i)] += column[k] * column[i];
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
        let mut inverse = [T::zero(); R];
        let mut largest = [T::one(); R];
        for row in (0..R).filter(|row| self.safe[*row]) {
            let mut unit = [T::zero(); R];
            unit[row] = T::one();
            self.forward(&mut unit, row);
            let component = self.component[row];
            inverse[component] += dot(&unit, &unit);
            largest[component] = largest[component].max(self.squares[row]);
        }
        for component in 0..R {
            let is_regular = inverse[component] * largest[component] <= most_inverse();
            if !is_regular {
                self.give_up(component);
            }
        }
    }

    fn give_up(&mut self, component: usize) {
        for row in 0..R {
            self.safe[row] &= self.component[row] != component;
        }
    }
}
