//! Gauss–Jordan elimination with complete pivoting.
//!
//! In:  `A`, `R × N`, and a right-hand side, `R`.
//! Out: a choice of dependent coordinates, and those as functions of the others:
//!      `x_d = c − T x_i`.
//!
//! Not here: whether the choice is good enough. The caller measured that before.

use crate::Real;
use nalgebra::{SMatrix, SVector};

/// The eliminated system. Row `k` belongs to the dependent coordinate
/// `dependent[k]`.
#[derive(Clone, Debug)]
pub(crate) struct Elimination<T, const N: usize, const R: usize> {
    /// `T` in the columns of independent coordinates, unit columns elsewhere.
    pub(crate) table: SMatrix<T, R, N>,
    /// `c`.
    pub(crate) offset: SVector<T, R>,
    /// The dependent coordinate of each row.
    pub(crate) dependent: [usize; R],
    /// How many rows were independent.
    pub(crate) rank: usize,
}

impl<T: Real, const N: usize, const R: usize> Elimination<T, N, R> {
    /// Eliminates until no entry is left that differs from zero. Columns are
    /// compared after multiplication with `weight`, so that the choice does not
    /// depend on the units of the coordinates.
    pub(crate) fn new(
        matrix: &SMatrix<T, R, N>,
        right: &SVector<T, R>,
        weight: &SVector<T, N>,
    ) -> Self {
        let mut this = Self {
            table: *matrix,
            offset: *right,
            dependent: [0; R],
            rank: 0,
        };
        while this.rank < R.min(N) {
            let Some((row, column)) = this.largest(weight) else {
                break;
            };
            this.table.swap_rows(this.rank, row);
            this.offset.swap_rows(this.rank, row);
            this.dependent[this.rank] = column;
            this.eliminate(this.rank, column);
            this.rank += 1;
        }
        this
    }

    /// Where the largest weighted entry of the remaining rows is.
    fn largest(&self, weight: &SVector<T, N>) -> Option<(usize, usize)> {
        let mut most = T::zero();
        let mut place = None;
        for column in 0..N {
            for row in self.rank..R {
                let size = self.table[(row, column)].abs() * weight[column];
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
        let inverse = T::one() / self.table[(row, column)];
        for j in 0..N {
            self.table[(row, j)] *= inverse;
        }
        self.offset[row] *= inverse;
        for i in (0..R).filter(|&i| i != row) {
            let factor = self.table[(i, column)];
            for j in 0..N {
                let change = factor * self.table[(row, j)];
                self.table[(i, j)] -= change;
            }
            let change = factor * self.offset[row];
            self.offset[i] -= change;
            self.table[(i, column)] = T::zero();
        }
    }
}
