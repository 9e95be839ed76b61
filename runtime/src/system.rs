//! The seam between integrators and mechanics.
//!
//! In:  a state.
//! Out: its acceleration and how that changes, or the state brought back onto the
//!      constraints.
//!
//! Not here: how either is computed ([`crate::dynamics`], [`crate::projection`])
//! and how a step is made of accelerations (the integrators).

use crate::{DynamicsError, Real, State, Step};
use nalgebra::{SMatrix, SVector};

/// Partial derivatives of the acceleration.
#[derive(Clone, Debug)]
pub struct AccelerationJacobian<T, const N: usize> {
    /// `∂q̈/∂q`, `N × N`.
    pub q: SMatrix<T, N, N>,
    /// `∂q̈/∂q̇`, `N × N`.
    pub v: SMatrix<T, N, N>,
}

/// Where equations change with respect to a step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Switching<T> {
    /// Not within the step.
    Nowhere,
    /// At its end: the step stands, and what is known of the derivative there is forgotten.
    AtEnd,
    /// At this time within it (s), where a step from the same start has to end.
    Within(T),
    /// At its start, where they have changed now: the step has to be made once more.
    AtStart,
}

/// Does something with a system, and again if it fails, as long as the system can look more
/// closely.
///
/// # Errors
///
/// The error of what is done, or that no closer look helps.
#[inline]
pub(crate) fn escalating<T, Y, V, E, const N: usize>(
    system: &mut Y,
    mut once: impl FnMut(&mut Y) -> Result<V, E>,
) -> Result<V, E>
where
    T: Real,
    Y: System<T, N> + ?Sized,
    E: From<DynamicsError<T>>,
{
    loop {
        match once(system) {
            Err(error) if !system.escalate()? => return Err(error),
            Err(_) => {}
            done => return done,
        }
    }
}

/// What an integrator sees: a first-order flow on (q, v) with a projection.
pub trait System<T: Real, const N: usize> {
    /// Is told where a step begins, before each attempt at it. A system that follows a
    /// motion goes on from there if its last accepted step ended there. Says whether its
    /// equations change along the way, so that [`switch`](Self::switch) has to be asked
    /// about the inside of each step.
    fn begin(&mut self, _state: &State<T, N>) -> bool {
        false
    }

    /// The acceleration `q̈` (m/s² or rad/s²) at a state, which need not satisfy
    /// the constraints: the stages of a step are off them by a little.
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] with the time of the state.
    fn acceleration(&mut self, state: &State<T, N>) -> Result<SVector<T, N>, DynamicsError<T>>;

    /// Brings the end of an attempt at a step back onto the constraints (positions, then
    /// velocities).
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] with the time of the state, which is then left as the
    /// last iteration made it.
    fn project(&mut self, state: &mut State<T, N>) -> Result<(), DynamicsError<T>>;

    /// Whether what just failed is worth another attempt from the start of the step, because
    /// the system then looks more closely than before, of which there is an end.
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] if no closer look helps.
    fn escalate(&mut self) -> Result<bool, DynamicsError<T>> {
        Ok(false)
    }

    /// Verifies an attempt at a step that is about to be accepted.
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] that says what is wrong with it.
    fn verify(&mut self, _start: &State<T, N>, _end: &State<T, N>) -> Result<(), DynamicsError<T>> {
        Ok(())
    }

    /// Where the equations change within a step that is about to be accepted, which was
    /// made with those from its start. May give the end of the step another velocity, within
    /// its error, if they change there.
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] if that can't be told, or nothing can follow.
    fn switch(&mut self, _step: &mut Step<T, N>) -> Result<Switching<T>, DynamicsError<T>> {
        Ok(Switching::Nowhere)
    }

    /// Is told of an accepted step.
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] if the motion can't be followed from its end.
    fn commit(&mut self, _step: &Step<T, N>) -> Result<(), DynamicsError<T>> {
        Ok(())
    }

    /// How the acceleration changes with the state, to the few digits that the
    /// iteration of an implicit method needs; `None` where that is not known, so that
    /// differences must do.
    fn acceleration_jacobian(
        &mut self,
        _state: &State<T, N>,
    ) -> Option<AccelerationJacobian<T, N>> {
        None
    }

    /// Over what distances at most the acceleration is as good as linear in the coordinates, or
    /// not much longer ones (m, rad): an angle that has turned a thousand times is not a thousand
    /// times larger for that. Infinite where nothing is known.
    fn extents(&self) -> SVector<T, N> {
        SVector::repeat(T::from_f64(f64::INFINITY))
    }
}
