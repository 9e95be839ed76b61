//! The seam between integrators and mechanics.
//!
//! In:  a state.
//! Out: its acceleration, or the state brought back onto the constraints.
//!
//! Not here: how either is computed ([`crate::dynamics`], [`crate::projection`])
//! and how a step is made of accelerations (the integrators).

use crate::{DynamicsError, Real, State};
use nalgebra::SVector;

/// What an integrator sees: a first-order flow on (q, v) with a projection.
pub trait System<T: Real, const N: usize> {
    /// The acceleration `q̈` (m/s² or rad/s²) at a state, which need not satisfy
    /// the constraints: the stages of a step are off them by a little.
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] with the time of the state.
    fn acceleration(&mut self, state: &State<T, N>) -> Result<SVector<T, N>, DynamicsError<T>>;

    /// Brings an accepted state back onto the constraints (positions, then
    /// velocities).
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] with the time of the state, which is then left as the
    /// last iteration made it.
    fn project(&mut self, state: &mut State<T, N>) -> Result<(), DynamicsError<T>>;
}
