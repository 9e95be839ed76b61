//! The chosen method at work, whichever it is.
//!
//! In:  a [`Method`], a [`StepControl`].
//! Out: steps.

use super::SimulateError;
use super::options::StepControl;
use crate::integrator::{Controlled, Explicit, Inside, Radau, dop853, dp5, radau5, radau9};
use crate::{IntegrateError, Integrator, Method, Real, Rk4, State, Step, System, Tolerance};

/// The chosen method, whichever it is.
#[derive(Clone, Debug)]
pub(super) enum Driver<T, const N: usize> {
    Rk4(Rk4<T, N>),
    Explicit(Controlled<Explicit<T, N>, T, N>),
    Radau(Controlled<Radau<T, N>, T, N>),
}

/// The tolerance of steps that follow one.
///
/// # Errors
///
/// A step that isn't positive, a tolerance that isn't or that is below round-off, or a
/// tolerance for a method without error estimate.
pub(super) fn tolerance<T: Real, const N: usize>(
    method: Method,
    step_control: StepControl<T>,
) -> Result<Option<Tolerance<T, N>>, SimulateError<T>> {
    match step_control {
        StepControl::Fixed { step } if step.is_finite() && step > T::zero() => Ok(None),
        StepControl::Fixed { step } => Err(SimulateError::StepNotPositive { step }),
        StepControl::Adaptive { relative, absolute } => {
            let tolerance = Tolerance::uniform(relative, absolute)?;
            match method {
                Method::Rk4 => Err(SimulateError::NoErrorEstimate { method }),
                _ => Ok(Some(tolerance)),
            }
        }
    }
}

impl<T: Real, const N: usize> Driver<T, N> {
    /// The method with the accuracy that [`tolerance`] tells.
    #[inline(always)]
    pub(super) fn new(method: Method, tolerance: Option<Tolerance<T, N>>, inside: Inside) -> Self {
        let mut driver = match method {
            Method::Rk4 => Self::Rk4(Rk4::new()),
            Method::Dp5 => Self::Explicit(dp5(tolerance)),
            Method::Dop853 => Self::Explicit(dop853(tolerance)),
            Method::Radau5 => Self::Radau(radau5(tolerance)),
            Method::Radau9 => Self::Radau(radau9(tolerance)),
        };
        driver.keep(inside);
        driver
    }

    /// Chooses what is kept of the inside of steps.
    fn keep(&mut self, inside: Inside) {
        match self {
            Self::Rk4(method) => method.keep(inside),
            Self::Explicit(method) => method.keep(inside),
            Self::Radau(method) => method.keep(inside),
        }
    }

    /// Forgets the last step, because the system has changed since.
    pub(super) fn forget(&mut self) {
        match self {
            Self::Rk4(method) => method.forget(),
            Self::Explicit(method) => method.forget(),
            Self::Radau(method) => method.forget(),
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
        match self {
            Self::Rk4(method) => method.step(system, state, bound),
            Self::Explicit(method) => method.step(system, state, bound),
            Self::Radau(method) => method.step(system, state, bound),
        }
    }
}
