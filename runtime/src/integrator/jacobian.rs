//! How the acceleration changes with the state.
//!
//! In:  a system, a state and its acceleration.
//! Out: `∂q̈/∂q` and `∂q̈/∂q̇`, from the system where it knows them, else by differences.
//!
//! The iteration that uses them needs no more than a few digits: they decide how
//! fast it converges, not what it converges to.

use crate::{AccelerationJacobian, DynamicsError, Real, State, System};
use nalgebra::{SMatrix, SVector};

/// How far coordinates and velocities are varied, relative to their size, as a
/// power of round-off: farther than the square root, because near singular
/// positions accelerations carry more than round-off.
const VARIATION: f64 = 0.4;

/// The derivatives at a state with acceleration `a`, and how many accelerations were
/// computed for them.
pub(super) fn acceleration_jacobian<T: Real, const N: usize, Y: System<T, N> + ?Sized>(
    system: &mut Y,
    state: &State<T, N>,
    a: &SVector<T, N>,
) -> Result<(AccelerationJacobian<T, N>, u32), DynamicsError<T>> {
    match system.acceleration_jacobian(state) {
        Some(jacobian) if is_finite(&jacobian) => Ok((jacobian, 0)),
        _ => Ok((differences(system, state, a)?, 2 * N as u32)),
    }
}

fn is_finite<T: Real, const N: usize>(jacobian: &AccelerationJacobian<T, N>) -> bool {
    jacobian.q.iter().chain(&jacobian.v).all(|x| x.is_finite())
}

/// One-sided differences.
#[inline(never)]
fn differences<T: Real, const N: usize, Y: System<T, N> + ?Sized>(
    system: &mut Y,
    state: &State<T, N>,
    a: &SVector<T, N>,
) -> Result<AccelerationJacobian<T, N>, DynamicsError<T>> {
    let mut jacobian = AccelerationJacobian {
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
        jacobian.q.data.0[j] = ((system.acceleration(&near)? - a) / difference).data.0[0];
        let mut near = *state;
        near.v[j] += by_v;
        let difference = near.v[j] - state.v[j];
        jacobian.v.data.0[j] = ((system.acceleration(&near)? - a) / difference).data.0[0];
    }
    Ok(jacobian)
}
