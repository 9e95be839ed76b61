//! How the acceleration changes with the state.
//!
//! In:  a system of any size ([`Flow`]), a state and its acceleration.
//! Out: `∂q̈/∂q` and `∂q̈/∂q̇`, from the system where it knows them, else by differences.
//!
//! The iteration that uses them needs no more than a few digits: they decide how
//! fast it converges, not what it converges to.

use crate::equations::At;
use crate::linalg::Workspace;
use crate::{DynamicsError, Real};

/// How far coordinates and velocities are varied, relative to their size, as a
/// power of round-off: farther than the square root, because near singular
/// positions accelerations carry more than round-off.
const VARIATION: f64 = 0.4;

/// A system of any size.
pub(crate) trait Flow<T> {
    /// Writes the acceleration at a state.
    fn accelerate(&mut self, at: At<'_, T>, out: &mut [T]) -> Result<(), DynamicsError<T>>;
    /// Writes `∂q̈/∂q` and `∂q̈/∂q̇` at a state, column by column, if they are known; whether
    /// they are.
    fn derivatives(&mut self, at: At<'_, T>, by_q: &mut [T], by_v: &mut [T]) -> bool;
}

/// Writes the derivatives at a state with acceleration `a`, column by column.
pub(super) fn differentiate<T: Real>(
    flow: &mut dyn Flow<T>,
    at: At<'_, T>,
    a: &[T],
    (by_q, by_v): (&mut [T], &mut [T]),
    workspace: &Workspace<'_, T>,
) -> Result<(), DynamicsError<T>> {
    let is_known = flow.derivatives(at, by_q, by_v);
    if is_known && by_q.iter().chain(&*by_v).all(|x| x.is_finite()) {
        return Ok(());
    }
    // One-sided differences.
    let n = a.len();
    let near = workspace.any(n);
    let variation = T::EPSILON.powf(T::from_f64(VARIATION));
    let (change_q, change_v) = (size(at.q) * variation, size(at.v) * variation);
    for j in 0..n {
        near.copy_from_slice(at.q);
        near[j] += change_q;
        let out = &mut by_q[j * n..][..n];
        flow.accelerate(At { q: near, ..at }, out)?;
        divide(out, a, near[j] - at.q[j]);
        near.copy_from_slice(at.v);
        near[j] += change_v;
        let out = &mut by_v[j * n..][..n];
        flow.accelerate(At { v: near, ..at }, out)?;
        divide(out, a, near[j] - at.v[j]);
    }
    Ok(())
}

/// The largest entry. A coordinate that is zero has no size of its own; it is given that of
/// the others.
fn size<T: Real>(x: &[T]) -> T {
    let most = x.iter().fold(T::zero(), |most: T, x| most.max(x.abs()));
    if most > T::zero() { most } else { T::one() }
}

/// The difference quotient.
fn divide<T: Real>(near: &mut [T], here: &[T], difference: T) {
    for (near, here) in near.iter_mut().zip(here) {
        *near = (*near - *here) / difference;
    }
}
