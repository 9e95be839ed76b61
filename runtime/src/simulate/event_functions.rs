//! Event functions at a state, and what round-off makes of them.
//!
//! In:  event functions, a state.
//! Out: how far coordinates and velocities may differ for the state to be the same; how much that
//!      changes the functions.

use crate::linalg::largest;
use crate::{Real, State};

/// Events a mechanism may have.
pub(super) const ROOM: usize = 64;

/// Writes the event functions of a mechanism at a state.
pub(super) type Functions<'a, T, const N: usize> = &'a dyn Fn(&State<T, N>, &mut [T]);

/// States are the same to this power of round-off, relative to their largest coordinate and velocity
/// (2e-12 for `f64`): beside singular configurations a quarter of the digits is not told.
const SAME_STATE: f64 = 0.75;

/// How far coordinates and velocities may differ for a state to be the same.
pub(super) fn same_state<T: Real, const N: usize>(state: &State<T, N>) -> [T; 2] {
    let unit = T::EPSILON.powf(T::from_f64(SAME_STATE));
    [&state.q, &state.v].map(|x| largest(x.as_slice()) * unit)
}

/// How much the functions change, by these values, where round-off moves coordinates and velocities
/// by so much, one after the other: a state at which an event happened is no nearer to it.
pub(super) fn round_off<T: Real, const N: usize>(
    functions: Functions<'_, T, N>,
    state: &State<T, N>,
    values: &[T; ROOM],
    [aside, faster]: [T; 2],
) -> [T; ROOM] {
    let mut changes = [T::zero(); ROOM];
    let mut observe = |moved: &State<T, N>| {
        let mut there = [T::zero(); ROOM];
        functions(moved, &mut there);
        for (change, (there, here)) in changes.iter_mut().zip(there.iter().zip(values)) {
            *change += (*there - *here).abs();
        }
    };
    let mut moved = *state;
    for i in 0..N {
        moved.q[i] += aside;
        observe(&moved);
        moved.q[i] = state.q[i];
        moved.v[i] += faster;
        observe(&moved);
        moved.v[i] = state.v[i];
    }
    changes
}
