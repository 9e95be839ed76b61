//! The state of a mechanism: time, coordinates, velocities. Nothing else.

use crate::Real;
use nalgebra::SVector;

/// Time `t` (s), generalized coordinates `q` (m or rad) and their velocities
/// `q̇` (m/s or rad/s) of a mechanism with `N` coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<T, const N: usize> {
    /// Time in seconds.
    pub t: T,
    /// Generalized coordinates.
    pub q: SVector<T, N>,
    /// Generalized velocities, the time derivatives of `q`.
    pub v: SVector<T, N>,
}

impl<T: Real, const N: usize> State<T, N> {
    /// A state from its three parts.
    pub fn new(t: T, q: SVector<T, N>, v: SVector<T, N>) -> Self {
        Self { t, q, v }
    }

    /// Whether every number of the state is finite.
    pub fn is_finite(&self) -> bool {
        self.t.is_finite() && all_finite(&self.q) && all_finite(&self.v)
    }
}

/// Whether every entry is finite; all are looked at, side by side.
#[inline]
pub(crate) fn all_finite<T: Real, const N: usize>(vector: &SVector<T, N>) -> bool {
    let [entries] = &vector.data.0;
    entries.iter().fold(true, |all, x| all & x.is_finite())
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
