//! The derivatives of the state at the stages of a step: kᵢ in the literature.
//!
//! In:  velocities and accelerations.
//! Out: their combinations.

use super::tableau::Term;
use crate::Real;
use crate::linalg::add_scaled;
use nalgebra::SVector;

/// Derivatives of `(q, q̇)` in `S` slots.
#[derive(Clone, Debug)]
pub(super) struct Stages<T, const N: usize, const S: usize> {
    /// Velocities, the derivatives of `q`.
    pub(super) v: [SVector<T, N>; S],
    /// Accelerations, the derivatives of `q̇`.
    pub(super) a: [SVector<T, N>; S],
}

impl<T: Real, const N: usize, const S: usize> Stages<T, N, S> {
    pub(super) fn new() -> Self {
        let zero = [SVector::zeros(); S];
        Self { v: zero, a: zero }
    }

    /// Copies a slot into another.
    pub(super) fn copy(&mut self, from: usize, to: usize) {
        self.v[to] = self.v[from];
        self.a[to] = self.a[from];
    }

    /// A combination of the derivatives.
    #[inline(always)]
    pub(super) fn combine(&self, row: &[Term]) -> (SVector<T, N>, SVector<T, N>) {
        let Some((&(slot, high, low), rest)) = row.split_first() else {
            return (SVector::zeros(), SVector::zeros());
        };
        let weight = T::constant(high, low);
        let (mut q, mut v) = (self.v[slot] * weight, self.a[slot] * weight);
        for &(slot, high, low) in rest {
            let weight = T::constant(high, low);
            add_scaled(&mut q.data.0[0], weight, &self.v[slot].data.0[0]);
            add_scaled(&mut v.data.0[0], weight, &self.a[slot].data.0[0]);
        }
        (q, v)
    }
}
