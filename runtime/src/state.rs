//! The state of a mechanism: time, coordinates, velocities. Nothing else.

use crate::Real;
use nalgebra::SVector;

/// Time `t` (s), generalized coordinates `q` (m or rad) and their velocities
/// `q̇` (m/s or rad/s) of a mechanism with `N` coordinates.
#[derive(Clone, Copy, Debug)]
pub struct State<T, const N: usize> {
    /// Time in seconds.
    pub t: T,
    /// Generalized coordinates.
    pub q: SVector<T, N>,
    /// Generalized velocities, the time derivatives of `q`.
    pub v: SVector<T, N>,
}

/// Whether all numbers are the same: each step compares states, and arrays are compared in a
/// fraction of the time that vectors of any shape take.
impl<T: PartialEq, const N: usize> PartialEq for State<T, N> {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        self.t == other.t && self.q.data.0 == other.q.data.0 && self.v.data.0 == other.v.data.0
    }
}

impl<T: Real, const N: usize> State<T, N> {
    /// A state from its three parts.
    pub fn new(t: T, q: SVector<T, N>, v: SVector<T, N>) -> Self {
        Self { t, q, v }
    }

    /// The state at a part of the way to another, by the cubic polynomial through both
    /// positions and velocities.
    pub(crate) fn towards(&self, end: &Self, part: T) -> Self {
        let mut q = SVector::<T, N>::zeros();
        let t = self.at().towards(end.at(), part, q.as_mut_slice());
        Self {
            t,
            q,
            v: self.v * (T::one() - part) + end.v * part,
        }
    }

    /// Whether every number of the state is finite.
    pub fn is_finite(&self) -> bool {
        let sum = nothing(self.t * T::zero(), &self.q);
        nothing(sum, &self.v) == T::zero()
    }
}

/// Whether every entry is finite: zero times anything else is not a number.
#[inline]
pub(crate) fn all_finite<T: Real, const N: usize>(vector: &SVector<T, N>) -> bool {
    nothing(T::zero(), vector) == T::zero()
}

/// Adds zero to a sum, or what is not a number if an entry is not finite.
#[inline(always)]
fn nothing<T: Real, const N: usize>(sum: T, vector: &SVector<T, N>) -> T {
    let [entries] = &vector.data.0;
    let add = |sum, x: &T| x.mul_add(T::zero(), sum);
    entries.iter().fold(sum, add)
}

impl<T: Real, const N: usize> Default for State<T, N> {
    fn default() -> Self {
        Self {
            t: T::zero(),
            q: SVector::zeros(),
            v: SVector::zeros(),
        }
    }
}
