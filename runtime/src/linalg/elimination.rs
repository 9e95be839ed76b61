//! Gauss–Jordan elimination with complete pivoting.
//!
//! In:  `A`, `R × N`, column by column, and a right-hand side, `R`.
//! Out: a choice of dependent coordinates, and those as functions of the others:
//!      `x_d = c − T x_i`.
//!
//! Not here: whether the choice is good enough. The caller measured that before.

use super::{Workspace, pair};
use crate::Real;

/// The eliminated system. Row `k` belongs to the dependent coordinate
/// `dependent[k]`.
#[derive(Debug)]
pub(crate) struct Elimination<'a, T> {
    /// `T` in the columns of independent coordinates, unit columns elsewhere.
    table: &'a mut [T],
    /// `c`.
    pub(crate) offset: &'a mut [T],
    /// The dependent coordinate of each row, as many as rows were independent.
    pub(crate) dependent: &'a mut [usize],
}

impl<'a, T: Real> Elimination<'a, T> {
    /// Eliminates in place until no entry is left that differs from zero. Columns are
    /// compared after multiplication with `weight`, so that the choice does not
    /// depend on the units of the coordinates.
    pub(crate) fn new(
        table: &'a mut [T],
        offset: &'a mut [T],
        weight: &[T],
        workspace: &Workspace<'a, T>,
    ) -> Self {
        let dependent = workspace.indices(offset.len().min(weight.len()));
        let mut this = Self {
            table,
            offset,
            dependent: &mut [],
        };
        let mut rank = 0;
        while rank < dependent.len() {
            let Some((row, column)) = this.largest(rank, weight) else {
                break;
            };
            for column in this.table.chunks_exact_mut(this.offset.len()) {
                column.swap(rank, row);
            }
            this.offset.swap(rank, row);
            dependent[rank] = column;
            this.eliminate(rank, column);
            rank += 1;
        }
        this.dependent = &mut dependent[..rank];
        this
    }

    /// What a dependent coordinate takes of another one.
    pub(crate) fn entry(&self, row: usize, column: usize) -> T {
        self.table[column * self.offset.len() + row]
    }

    /// Where the largest weighted entry of the rows from `first` on is.
    fn largest(&self, first: usize, weight: &[T]) -> Option<(usize, usize)> {
        let mut most = T::zero();
        let mut place = None;
        for (column, weight) in weight.iter().enumerate() {
            for row in first..self.offset.len() {
                let size = self.entry(row, column).abs() * *weight;
                if size > most {
                    most = size;
                    place = Some((row, column));
                }
            }
        }
        place
    }

    /// Makes `column` the unit vector of `row`.
    fn eliminate(&mut self, row: usize, column: usize) {
        let r = self.offset.len();
        let inverse = T::one() / self.entry(row, column);
        for j in 0..self.table.len() / r {
            if j != column {
                self.eliminate_from(j, row, column, inverse);
            }
        }
        self.offset[row] *= inverse;
        for i in (0..r).filter(|&i| i != row) {
            let change = self.entry(i, column) * self.offset[row];
            self.offset[i] -= change;
        }
        let column = &mut self.table[column * r..][..r];
        column.fill(T::zero());
        column[row] = T::one();
    }

    /// What that makes of another column.
    fn eliminate_from(&mut self, j: usize, row: usize, column: usize, inverse: T) {
        let r = self.offset.len();
        let [target, factors] = pair(self.table, r, j, column);
        target[row] *= inverse;
        let pivot = target[row];
        for (i, (entry, factor)) in target.iter_mut().zip(factors).enumerate() {
            if i != row {
                *entry -= *factor * pivot;
            }
        }
    }
}
