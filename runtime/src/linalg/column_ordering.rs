//! The order in which the columns of a sparse matrix are kept.
//!
//! In:  a matrix, the order in which its rows are eliminated.
//! Out: places in which rows have their entries close to one another.

use super::block::LONG;
use crate::Real;

/// Places for the columns of a sparse matrix, given column by column, some rows of which are
/// eliminated in their order: by the first of these that has an entry there. `first` is room
/// for as many. Those of a short matrix stay where they are.
#[inline(never)]
pub(crate) fn order_by_first_row<T: Real>(
    matrix: &[T],
    rows: &[usize],
    places: &mut [usize],
    first: &mut [usize],
) {
    let n = places.len();
    if n < LONG {
        for (column, place) in places.iter_mut().enumerate() {
            *place = column;
        }
        return;
    }
    for (column, first) in first.iter_mut().enumerate() {
        let entries = &matrix[column * (matrix.len() / n)..];
        let occupied = |row: &usize| entries[*row] != T::zero();
        *first = rows.iter().position(occupied).unwrap_or(rows.len()) * n + column;
    }
    first.sort_unstable();
    for (place, key) in first.iter().enumerate() {
        places[key % n] = place;
    }
}
