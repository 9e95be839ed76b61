//! How the acceleration changes with the state.
//!
//! In:  a system, a state and its acceleration.
//! Out: `∂q̈/∂q` and `∂q̈/∂q̇`, by differences.
//!
//! The iteration that uses them needs no more than a few digits: they decide how
//! fast it converges, not what it converges to.

use crate::{DynamicsError, Real, State, System};
use nalgebra::{SMatrix, SVector};

/// How far coordinates and velocities are varied, relative to their size, as a
/// power of round-off: farther than the square root, because near singular
/// positions accelerations carry more than round-off.
const VARIATION: f64 = 0.4;

/// Partial derivatives of the acceleration.
#[derive(Clone, Debug)]
pub(super) struct Slope<T, const N: usize> {
    /// `∂q̈/∂q`, `N × N`.
    pub(super) q: SMatrix<T, N, N>,
    /// `∂q̈/∂q̇`, `N × N`.
    pub(super) v: SMatrix<T, N, N>,
}

impl<T: Real, const N: usize> Slope<T, N> {
    /// Accelerations that [`of`](Self::of) needs.
    pub(super) const EVALUATIONS: u32 = 2 * N as u32;

    /// One-sided differences at a state with acceleration `a`.
    pub(super) fn of<Y: System<T, N> + ?Sized>(
        system: &mut Y,
        state: &State<T, N>,
        a: &SVector<T, N>,
    ) -> Result<Self, DynamicsError<T>> {
        let mut slope = Self {
            q: SMatrix::zeros(),
            v: SMatrix::zeros(),
        };
        // A coordinate that is zero has no size of its own; it is given that of the
        // others.
        let size = |x: &SVector<T, N>| {
            let most = x.iter().fold(T::zero(), |most: T, x| most.max(x.abs()));
            if most > T::zero() { most } else { T::one() }
        };
        let variation = T::EPSILON.powf(T::from_f64(VARIATION));
        let (by_q, by_v) = (size(&state.q) * variation, size(&state.v) * variation);
        for j in 0..N {
            let mut near = *state;
            near.q[j] += by_q;
            let difference = near.q[j] - state.q[j];
            slope.q.data.0[j] = ((system.acceleration(&near)? - a) / difference).data.0[0];
            let mut near = *state;
            near.v[j] += by_v;
            let difference = near.v[j] - state.v[j];
            slope.v.data.0[j] = ((system.acceleration(&near)? - a) / difference).data.0[0];
        }
        Ok(slope)
    }
}
