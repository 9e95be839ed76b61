//! Keeping the energy of a conservative mechanism where it was.
//!
//! In:  a system, the energy at the start.
//! Out: the same system, whose projection brings velocities back onto the
//!      surface of that energy, too.
//!
//! The energy is `T₂ + (Π − T₀)`, and only `T₂ = ½ q̇ᵀ M q̇` depends on the
//! velocities. The nearest velocity of another energy, in the metric of `M`, is
//! the velocity itself, longer or shorter: it still satisfies constraints at
//! rest, and nothing but one factor has to be found.
//!
//! Where the mechanism nearly rests the velocity can't make up for an error of
//! the position; nothing is done then, and the next step makes up for it. The
//! error stays that of a few steps, however long the run is.
//!
//! Source: Hairer, Lubich & Wanner, Geometric Numerical Integration (2006),
//! section IV.4 (projection methods).

use crate::observer::balance;
use crate::{
    AccelerationJacobian, ConstrainedSystem, DynamicsError, Mechanism, Real, State, Step,
    Switching, System,
};
use nalgebra::SVector;

/// Largest change of the kinetic energy that is made up for, relative to it.
const LARGEST_CHANGE: f64 = 0.01;

/// A system whose projection keeps the energy, if asked to.
pub(super) struct Conserving<'a, M: ?Sized, T, const N: usize, const R: usize> {
    system: ConstrainedSystem<'a, M, T, N, R>,
    /// The energy to keep (J).
    energy: Option<T>,
}

impl<'a, M, T, const N: usize, const R: usize> Conserving<'a, M, T, N, R>
where
    T: Real,
    M: Mechanism<T, N, R> + ?Sized,
{
    /// A system that keeps nothing yet.
    pub(super) fn new(system: ConstrainedSystem<'a, M, T, N, R>) -> Self {
        Self {
            system,
            energy: None,
        }
    }

    /// Begins at a state, which is moved onto the constraints if it is not on them to
    /// round-off; with the accepted error of a step if steps follow one.
    pub(super) fn start(
        &mut self,
        state: &mut State<T, N>,
        tolerance: Option<T>,
    ) -> Result<(), DynamicsError<T>> {
        self.system.start(state, tolerance)
    }

    /// The system whose energy is kept.
    pub(super) fn system(&mut self) -> &mut ConstrainedSystem<'a, M, T, N, R> {
        &mut self.system
    }

    /// Keeps the energy of a state from now on, or a given one.
    #[inline(never)]
    pub(super) fn keep(
        &mut self,
        state: &State<T, N>,
        given: Option<T>,
    ) -> Result<(), DynamicsError<T>> {
        let own = balance(state.t, &self.system.mechanism().energy(state))?;
        self.energy = Some(given.unwrap_or(own));
        Ok(())
    }

    /// Makes the velocity longer or shorter until the energy is right.
    #[inline(never)]
    fn restore(&self, state: &mut State<T, N>, energy: T) -> Result<(), DynamicsError<T>> {
        let mechanism = self.system.mechanism();
        let rest = State {
            v: SVector::zeros(),
            ..*state
        };
        let at_rest = balance(state.t, &mechanism.energy(&rest))?;
        let kinetic = balance(state.t, &mechanism.energy(state))? - at_rest;
        let change = (energy - at_rest - kinetic) / kinetic;
        // Not so if the mechanism rests: the quotient is then infinite or NaN.
        if change.abs() <= T::from_f64(LARGEST_CHANGE) {
            state.v *= (T::one() + change).sqrt();
        }
        Ok(())
    }
}

impl<M, T, const N: usize, const R: usize> System<T, N> for Conserving<'_, M, T, N, R>
where
    T: Real,
    M: Mechanism<T, N, R> + ?Sized,
{
    fn acceleration(&mut self, state: &State<T, N>) -> Result<SVector<T, N>, DynamicsError<T>> {
        System::acceleration(&mut self.system, state)
    }

    fn project(&mut self, state: &mut State<T, N>) -> Result<(), DynamicsError<T>> {
        System::project(&mut self.system, state)?;
        match self.energy {
            Some(energy) => self.restore(state, energy),
            None => Ok(()),
        }
    }

    fn begin(&mut self, state: &State<T, N>) -> bool {
        self.system.begin(state)
    }

    fn escalate(&mut self) -> Result<bool, DynamicsError<T>> {
        self.system.escalate()
    }

    fn verify(&mut self, start: &State<T, N>, end: &State<T, N>) -> Result<(), DynamicsError<T>> {
        self.system.verify(start, end)
    }

    fn switch(&mut self, step: &mut Step<T, N>) -> Result<Switching<T>, DynamicsError<T>> {
        self.system.switch(step)
    }

    fn commit(&mut self, step: &Step<T, N>) -> Result<(), DynamicsError<T>> {
        self.system.commit(step)
    }

    fn acceleration_jacobian(&mut self, state: &State<T, N>) -> Option<AccelerationJacobian<T, N>> {
        self.system.acceleration_jacobian(state)
    }

    fn extents(&self) -> SVector<T, N> {
        self.system.extents()
    }
}
