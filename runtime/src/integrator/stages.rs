//! The derivatives of the state at the stages of a step: kᵢ in the literature.
//!
//! In:  velocities and accelerations.
//! Out: their combinations.

use super::tableau::Term;
use crate::Real;
use nalgebra::SVector;

/// Derivatives of `(q, q̇)` in `S` slots.
#[derive(Clone, Debug)]
pub(super) struct Stages<T, const N: usize, const S: usize> {
    /// Velocities and accelerations of each slot, which are combined in one go.
    slots: [[[T; N]; 2]; S],
}

impl<T: Real, const N: usize, const S: usize> Stages<T, N, S> {
    pub(super) fn new() -> Self {
        Self {
            slots: [[[T::zero(); N]; 2]; S],
        }
    }

    /// Fills a slot.
    #[inline(always)]
    pub(super) fn set(&mut self, slot: usize, v: &SVector<T, N>, a: &SVector<T, N>) {
        self.slots[slot] = [v.data.0[0], a.data.0[0]];
    }

    /// The acceleration in a slot.
    pub(super) fn acceleration(&self, slot: usize) -> SVector<T, N> {
        SVector::from(self.slots[slot][1])
    }

    /// Copies a slot into another.
    pub(super) fn copy(&mut self, from: usize, to: usize) {
        self.slots[to] = self.slots[from];
    }

    /// A combination of the derivatives.
    #[inline(always)]
    pub(super) fn combine(&self, row: &[Term]) -> (SVector<T, N>, SVector<T, N>) {
        let mut sum = [[T::zero(); N]; 2];
        for &(slot, high, low) in row {
            let weight = T::constant(high, low);
            let entries = sum.as_flattened_mut().iter_mut();
            for (sum, entry) in entries.zip(self.slots[slot].as_flattened()) {
                *sum = weight.mul_add(*entry, *sum);
            }
        }
        let [q, v] = sum;
        (SVector::from(q), SVector::from(v))
    }
}
