//! Which expressions a program is to compute, and where each goes.

use super::program::Slot;
use crate::expr::ExprId;

/// Expressions and their places in arrays.
pub type Wanted = Vec<(Slot, ExprId)>;

/// The entries of a vector.
pub fn vector(array: &'static str, entries: &[ExprId]) -> Wanted {
    let entries = entries.iter().enumerate();
    entries
        .map(|(row, &e)| (Slot::of_vector(array, row), e))
        .collect()
}

/// The entries of a matrix, column by column, as nalgebra stores it.
pub fn matrix(array: &'static str, rows: &[Vec<ExprId>]) -> Wanted {
    let columns = rows.first().map_or(0, Vec::len);
    let entry = |column| {
        let rows = rows.iter().enumerate();
        rows.map(move |(row, entries)| (Slot { array, row, column }, entries[column]))
    };
    (0..columns).flat_map(entry).collect()
}

/// The entries of a matrix that differ from zero.
pub fn sparse(array: &'static str, entries: &[(usize, usize, ExprId)]) -> Wanted {
    let slot = |&(row, column, e): &(usize, usize, ExprId)| (Slot { array, row, column }, e);
    entries.iter().map(slot).collect()
}
