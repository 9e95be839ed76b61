//! Runge–Kutta methods of fixed step.
//!
//! In:  the time of the end of the step.
//! Out: the step that goes there.

use super::explicit::{Explicit, Inside};
use super::step::Step;
use super::tableau::RK4;
use super::{IntegrateError, Integrator};
use crate::{Real, State, System};

/// Slots of RK4: four stages and the slope at the end.
const SLOTS: usize = 5;

/// The classical Runge–Kutta method of order 4: one step to the bound, four
/// accelerations.
///
/// Between the ends, the quintic Hermite polynomial for `q` and its derivative
/// for `q̇`.
#[derive(Clone, Debug)]
pub struct Rk4<T, const N: usize>(Explicit<T, N, SLOTS>);

impl<T: Real, const N: usize> Default for Rk4<T, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real, const N: usize> Rk4<T, N> {
    /// The method, ready for its first step.
    pub fn new() -> Self {
        Self(Explicit::new(&RK4))
    }

    /// Forgets the last step, because the system has changed since.
    pub fn forget(&mut self) {
        self.0.forget();
    }

    pub(crate) fn keep(&mut self, inside: Inside) {
        self.0.inside = inside;
    }
}

impl<T: Real, const N: usize> Integrator<T, N> for Rk4<T, N> {
    fn step<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
        bound: T,
    ) -> Result<&Step<T, N>, IntegrateError<T>> {
        super::control::check_bound(state.t, bound)?;
        self.0.begin(system, state)?;
        self.0.attempt(system, bound)?;
        self.0.accept(system)?;
        Ok(&self.0.step)
    }
}
