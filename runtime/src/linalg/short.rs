//! What short frames do most, for sizes that the compiler knows.
//!
//! In:  a frame of up to eight rows.
//! Out: rows reduced, systems solved, without a check of any index that is in sight.

use super::frame::Frame;
use crate::Real;
use core::ops::Range;

impl<T: Real> Frame<'_, T> {
    /// Subtracts from a row what makes its entries in some pivot columns vanish.
    pub(super) fn reduce_in<const N: usize>(&mut self, row: usize, steps: Range<usize>) {
        let (rows, _) = self.upper.as_chunks_mut::<N>();
        let lower = &mut self.lower.as_chunks_mut::<N>().0[row];
        let mut target = rows[row];
        for step in steps {
            let (above, column) = (self.order.rows[step], self.order.columns[step]);
            let pivot = &rows[above];
            let share = target[column] / pivot[column];
            lower[step] = share;
            if share != T::zero() {
                for (entry, above) in target.iter_mut().zip(pivot) {
                    *entry = (-share).mul_add(*above, *entry);
                }
                target[column] = T::zero();
            }
        }
        rows[row] = target;
    }

    /// The first half of a solution, for some steps.
    pub(super) fn go_forward_in<const N: usize>(&mut self, right: &[T], steps: usize) {
        let (lower, _) = self.lower.as_chunks::<N>();
        let mut forward = [T::zero(); N];
        for (step, row) in self.order.rows[..steps].iter().enumerate() {
            let mut value = right[*row];
            for (share, y) in lower[*row].iter().zip(&forward).take(step) {
                value -= *share * *y;
            }
            forward[step] = value;
        }
        self.forward.copy_from_slice(&forward);
    }

    /// The second half.
    pub(super) fn go_backward_in<const N: usize>(&mut self, steps: usize, x: &mut [T]) {
        let (upper, _) = self.upper.as_chunks::<N>();
        let mut backward = [T::zero(); N];
        for step in (0..steps).rev() {
            let (row, column) = (self.order.rows[step], self.order.columns[step]);
            let mut known = T::zero();
            for (entry, x) in upper[row].iter().zip(&backward) {
                known += *entry * *x;
            }
            backward[column] = (self.forward[step] - known) / upper[row][column];
        }
        for (x, place) in x.iter_mut().zip(self.places) {
            *x = backward[*place];
        }
    }
}
