//! The slopes of the stages of a step.
//!
//! In:  velocities and accelerations.
//! Out: their combinations.

use super::tableau::Term;
use crate::Real;
use nalgebra::SVector;

/// Slopes of `(q, q̇)` in `S` slots.
#[derive(Clone, Debug)]
pub(super) struct Slopes<T, const N: usize, const S: usize> {
    /// Velocities, the slopes of `q`.
    pub(super) v: [SVector<T, N>; S],
    /// Accelerations, the slopes of `q̇`.
    pub(super) a: [SVector<T, N>; S],
}

impl<T: Real, const N: usize, const S: usize> Slopes<T, N, S> {
    pub(super) fn new() -> Self {
        let zero = [SVector::zeros(); S];
        Self { v: zero, a: zero }
    }

    /// Copies a slot into another.
    pub(super) fn copy(&mut self, from: usize, to: usize) {
        self.v[to] = self.v[from];
        self.a[to] = self.a[from];
    }

    /// A combination of the slopes.
    pub(super) fn combine(&self, row: &[Term]) -> (SVector<T, N>, SVector<T, N>) {
        let (mut q, mut v) = (SVector::<T, N>::zeros(), SVector::<T, N>::zeros());
        for &(slot, high, low) in row {
            let weight = T::constant(high, low);
            q.axpy(weight, &self.v[slot], T::one());
            v.axpy(weight, &self.a[slot], T::one());
        }
        (q, v)
    }
}
