//! Why an integrator could not make a step.
//!
//! Out: [`IntegrateError`].

use crate::number::Number;
use crate::{DynamicsError, Real};
use core::fmt::{Display, Formatter, Result};

/// Why an integrator could not make a step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum IntegrateError<T> {
    /// The mechanics failed at a state that could not be avoided.
    Dynamics(DynamicsError<T>),
    /// The step that the tolerance demands is lost in the round-off of time.
    StepUnderflow {
        /// Time at which the integration stuck (s).
        t: T,
        /// The step that was refused (s).
        h: T,
    },
    /// The error estimate stayed infinite or NaN, however short the step.
    NotFinite {
        /// Time at which the integration stuck (s).
        t: T,
    },
    /// The equations of an implicit step could not be solved, however short the
    /// step.
    NewtonDiverged {
        /// Time at which the integration stuck (s).
        t: T,
        /// The last step that was tried (s).
        h: T,
    },
    /// A tolerance is zero, negative, infinite or NaN.
    ToleranceNotPositive {
        /// The offending value.
        value: T,
    },
    /// The relative tolerance is below what the scalar can represent.
    ToleranceTooSmall {
        /// The tolerance that was asked for.
        relative: T,
        /// The smallest that makes sense.
        smallest: T,
    },
    /// The time to step to is not after the time of the state, or not finite.
    BadBound {
        /// Time of the state (s).
        t: T,
        /// The time to step to (s).
        bound: T,
    },
}

impl<T> From<DynamicsError<T>> for IntegrateError<T> {
    fn from(error: DynamicsError<T>) -> Self {
        Self::Dynamics(error)
    }
}

impl<T: Real> Display for IntegrateError<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Dynamics(error) => error.fmt(f),
            Self::StepUnderflow { t, h } => write!(
                f,
                "at t = {t} s the tolerance demands a step of {h} s, which is lost in the \
                 round-off of time; allow a larger tolerance, end the run earlier, or look for a \
                 force or a velocity that grows without bound",
                t = Number(t),
                h = Number(h)
            ),
            Self::NotFinite { t } => write!(
                f,
                "at t = {t} s the error estimate is infinite or NaN however short the step; look \
                 for a force or an input that grows without bound",
                t = Number(t)
            ),
            Self::NewtonDiverged { t, h } => write!(
                f,
                "at t = {t} s the equations of an implicit step of {h} s could not be solved; take \
                 a shorter step, or an explicit method",
                t = Number(t),
                h = Number(h)
            ),
            Self::ToleranceNotPositive { value } => {
                write!(
                    f,
                    "a tolerance must be a positive number, not {value}",
                    value = Number(value)
                )
            }
            Self::ToleranceTooSmall { relative, smallest } => write!(
                f,
                "a relative tolerance of {relative} is below the round-off of the numbers; the \
                 smallest that makes sense is {smallest}",
                relative = Number(relative),
                smallest = Number(smallest)
            ),
            Self::BadBound { t, bound } => {
                write!(
                    f,
                    "cannot step from t = {t} s to t = {bound} s: the end must come later",
                    t = Number(t),
                    bound = Number(bound)
                )
            }
        }
    }
}

impl<T: Real> core::error::Error for IntegrateError<T> {}
