//! The chosen method at work, whichever it is.
//!
//! In:  a [`Method`], a [`StepControl`].
//! Out: steps.

use super::SimulateError;
use super::options::StepControl;
use crate::integrator::Inside;
use crate::{
    Dop853, Dp5, IntegrateError, Integrator, Method, Radau5, Radau9, Real, Rk4, State, Step,
    System, Tolerance,
};

/// The chosen method, whichever it is.
#[derive(Clone, Debug)]
pub(super) struct Driver<T, const N: usize> {
    method: AnyMethod<T, N>,
    /// Accepted error of a step, relative, if the steps follow one.
    tolerance: Option<T>,
}

#[derive(Clone, Debug)]
enum AnyMethod<T, const N: usize> {
    Rk4(Rk4<T, N>),
    Dp5(Dp5<T, N>),
    Dop853(Dop853<T, N>),
    Radau5(Radau5<T, N>),
    Radau9(Radau9<T, N>),
}

impl<T: Real, const N: usize> Driver<T, N> {
    pub(super) fn new(
        method: Method,
        step_control: StepControl<T>,
    ) -> Result<Self, SimulateError<T>> {
        let tolerance = match step_control {
            StepControl::Fixed { step } if step.is_finite() && step > T::zero() => None,
            StepControl::Fixed { step } => return Err(SimulateError::StepNotPositive { step }),
            StepControl::Adaptive { relative, absolute } => {
                Some(Tolerance::uniform(relative, absolute)?)
            }
        };
        let method = match (method, tolerance) {
            (Method::Rk4, None) => AnyMethod::Rk4(Rk4::new()),
            (Method::Rk4, Some(_)) => return Err(SimulateError::NoErrorEstimate { method }),
            (Method::Dp5, None) => AnyMethod::Dp5(Dp5::fixed()),
            (Method::Dp5, Some(tolerance)) => AnyMethod::Dp5(Dp5::adaptive(tolerance)),
            (Method::Dop853, None) => AnyMethod::Dop853(Dop853::fixed()),
            (Method::Dop853, Some(tolerance)) => AnyMethod::Dop853(Dop853::adaptive(tolerance)),
            (Method::Radau5, None) => AnyMethod::Radau5(Radau5::fixed()),
            (Method::Radau5, Some(tolerance)) => AnyMethod::Radau5(Radau5::adaptive(tolerance)),
            (Method::Radau9, None) => AnyMethod::Radau9(Radau9::fixed()),
            (Method::Radau9, Some(tolerance)) => AnyMethod::Radau9(Radau9::adaptive(tolerance)),
        };
        let tolerance = match step_control {
            StepControl::Fixed { .. } => None,
            StepControl::Adaptive { relative, .. } => Some(relative),
        };
        Ok(Self { method, tolerance })
    }

    /// Accepted error of a step, relative, if the steps follow one.
    pub(super) fn tolerance(&self) -> Option<T> {
        self.tolerance
    }

    /// Chooses what is kept of the inside of steps.
    pub(super) fn keep(&mut self, inside: Inside) {
        match &mut self.method {
            AnyMethod::Rk4(method) => method.keep(inside),
            AnyMethod::Dp5(method) => method.keep(inside),
            AnyMethod::Dop853(method) => method.keep(inside),
            AnyMethod::Radau5(method) => method.keep(inside),
            AnyMethod::Radau9(method) => method.keep(inside),
        }
    }

    /// Forgets the last step, because the system has changed since.
    pub(super) fn forget(&mut self) {
        match &mut self.method {
            AnyMethod::Rk4(method) => method.forget(),
            AnyMethod::Dp5(method) => method.forget(),
            AnyMethod::Dop853(method) => method.forget(),
            AnyMethod::Radau5(method) => method.forget(),
            AnyMethod::Radau9(method) => method.forget(),
        }
    }
}

impl<T: Real, const N: usize> Integrator<T, N> for Driver<T, N> {
    fn step<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
        bound: T,
    ) -> Result<&Step<T, N>, IntegrateError<T>> {
        match &mut self.method {
            AnyMethod::Rk4(method) => method.step(system, state, bound),
            AnyMethod::Dp5(method) => method.step(system, state, bound),
            AnyMethod::Dop853(method) => method.step(system, state, bound),
            AnyMethod::Radau5(method) => method.step(system, state, bound),
            AnyMethod::Radau9(method) => method.step(system, state, bound),
        }
    }
}
