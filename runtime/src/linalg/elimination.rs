//! Gauss–Jordan elimination with complete pivoting.
//!
//! In:  `A`, column by column, and a right-hand side.
//! Out: a choice of dependent coordinates, and those as functions of the others:
//!      `x_d = c − T x_i`.
//!
//! Not here: whether the choice is good enough. The caller measured that before.

use super::Workspace;
use crate::Real;

/// The eliminated system. Row `k` belongs to the dependent coordinate
/// `dependent[k]`.
pub(crate) struct Elimination<'a, T> {
    /// `T` in the columns of independent coordinates, unit columns elsewhere.
    pub(crate) table: &'a mut [T],
    /// `c`.
    pub(crate) offset: &'a mut [T],
    /// The dependent coordinate of each row that was independent.
    pub(crate) dependent: &'a [usize],
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
        let most = offset.len().min(weight.len());
        let dependent = workspace.indices(most);
        let mut rank = 0;
        while rank < most {
            let Some((row, column)) = largest(table, offset.len(), rank, weight) else {
                break;
            };
            for entries in table.chunks_exact_mut(offset.len()) {
                entries.swap(rank, row);
            }
            offset.swap(rank, row);
            dependent[rank] = column;
            eliminate(table, offset, rank, column);
            rank += 1;
        }
        Self {
            table,
            offset,
            dependent: &dependent[..rank],
        }
    }
}

/// Where the largest weighted entry of the rows from `first` on is.
fn largest<T: Real>(
    table: &[T],
    rows: usize,
    first: usize,
    weight: &[T],
) -> Option<(usize, usize)> {
    let mut most = T::zero();
    let mut place = None;
    for (column, (entries, weight)) in table.chunks_exact(rows).zip(weight).enumerate() {
        for (row, entry) in entries.iter().enumerate().skip(first) {
            let size = entry.abs() * *weight;
            if size > most {
                most = size;
                place = Some((row, column));
            }
        }
    }
    place
}

/// Makes `column` the unit vector of `row`.
fn eliminate<T: Real>(table: &mut [T], offset: &mut [T], row: usize, column: usize) {
    let rows = offset.len();
    let inverse = T::one() / table[column * rows + row];
    for entries in table.chunks_exact_mut(rows) {
        entries[row] *= inverse;
    }
    offset[row] *= inverse;
    for i in (0..rows).filter(|&i| i != row) {
        let factor = table[column * rows + i];
        for entries in table.chunks_exact_mut(rows) {
            let change = factor * entries[row];
            entries[i] -= change;
        }
        let change = factor * offset[row];
        offset[i] -= change;
        table[column * rows + i] = T::zero();
    }
}
