//! How the acceleration changes with the state.
//!
//! In:  a system of any size ([`Flow`]), a state and its acceleration.
//! Out: `∂q̈/∂q` and `∂q̈/∂q̇`, from the system where it knows them, else by differences.
//!
//! The iteration that uses them needs no more than a few digits: they decide how
//! fast it converges, not what it converges to.

use crate::equations::At;
use crate::linalg::{Workspace, largest};
use crate::{DynamicsError, Real};

/// How far coordinates and velocities are varied, relative to their size, as a
/// power of round-off: farther than the square root, because near singular
/// positions accelerations carry more than round-off.
const VARIATION: f64 = 0.4;
/// How far coordinates that are much larger than the distances over which accelerations change
/// are varied at least, likewise: their round-off must not count.
const LEAST_VARIATION: f64 = 0.7;

/// A system of any size.
pub(crate) trait Flow<T> {
    /// Writes the acceleration at a state.
    fn accelerate(&mut self, at: At<'_, T>, out: &mut [T]) -> Result<(), DynamicsError<T>>;
    /// Writes `∂q̈/∂q` and `∂q̈/∂q̇` at a state, column by column, if they are known; whether
    /// they are.
    fn derivatives(&mut self, at: At<'_, T>, by_q: &mut [T], by_v: &mut [T]) -> bool;
    /// Writes over what distances the acceleration changes with the coordinates.
    fn extents(&self, extents: &mut [T]);
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
    let (near, extents) = workspace.any(2 * n).split_at_mut(n);
    flow.extents(extents);
    let [variation, least] = [VARIATION, LEAST_VARIATION].map(|x| T::EPSILON.powf(T::from_f64(x)));
    let (least_q, least_v) = (least_size(at.q), least_size(at.v));
    for j in 0..n {
        near.copy_from_slice(at.q);
        let size = near[j].abs().max(least_q);
        near[j] += (size.min(extents[j]) * variation).max(size * least);
        let out = &mut by_q[j * n..][..n];
        flow.accelerate(At { q: near, ..at }, out)?;
        divide(out, a, near[j] - at.q[j]);
        near.copy_from_slice(at.v);
        near[j] += near[j].abs().max(least_v) * variation;
        let out = &mut by_v[j * n..][..n];
        flow.accelerate(At { v: near, ..at }, out)?;
        divide(out, a, near[j] - at.v[j]);
    }
    Ok(())
}

/// The least that entries are taken to be: the largest entry, as one that is zero has no size of
/// its own; but at most one unit, as the others may be of another kind and larger by far.
fn least_size<T: Real>(x: &[T]) -> T {
    let most = largest(x);
    if most > T::zero() {
        most.min(T::one())
    } else {
        T::one()
    }
}

/// The difference quotient.
fn divide<T: Real>(near: &mut [T], here: &[T], difference: T) {
    for (near, here) in near.iter_mut().zip(here) {
        *near = (*near - *here) / difference;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two oscillators whose derivatives are not known: `q̈ = sin q − q̇³`.
    struct Oscillators;

    impl Flow<f64> for Oscillators {
        fn accelerate(
            &mut self,
            at: At<'_, f64>,
            out: &mut [f64],
        ) -> Result<(), DynamicsError<f64>> {
            for (out, (q, v)) in out.iter_mut().zip(at.q.iter().zip(at.v)) {
                *out = q.sin() - v.powi(3);
            }
            Ok(())
        }

        fn derivatives(&mut self, _: At<'_, f64>, _: &mut [f64], _: &mut [f64]) -> bool {
            false
        }

        fn extents(&self, extents: &mut [f64]) {
            extents.fill(1.0);
        }
    }

    /// What a motor has done in an hour is a number of another size than an angle, and the angle is
    /// not varied by a part of it.
    #[test]
    fn coordinates_are_varied_relative_to_their_own_size() {
        for other in [0.0, 1.0, 1e3, 1e6, 1e9] {
            let (q, v) = ([0.4, other], [0.2, 0.3]);
            let at = At {
                t: 0.0,
                q: &q,
                v: &v,
            };
            let mut numbers = [0.0; 4];
            let workspace = Workspace::new(&mut numbers, &mut [], &mut []);
            let (mut a, mut by_q, mut by_v) = ([0.0; 2], [0.0; 4], [0.0; 4]);
            Oscillators
                .accelerate(at, &mut a)
                .expect("a sine is finite");
            differentiate(&mut Oscillators, at, &a, (&mut by_q, &mut by_v), &workspace)
                .expect("a sine is finite");
            assert!(
                (by_q[0] - 0.4_f64.cos()).abs() < 1e-5,
                "{other:e}: {by_q:?}"
            );
            let round_off = other * f64::EPSILON.powf(0.7);
            assert!(
                (by_q[3] - other.cos()).abs() < 1e-5 + round_off,
                "{other:e}: {by_q:?}"
            );
            assert!((by_v[3] + 0.27).abs() < 1e-5, "{other:e}: {by_v:?}");
        }
    }
}
