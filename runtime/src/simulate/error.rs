//! Why a run could not begin or go on.
//!
//! Out: [`SimulateError`], and [`Failure`] with what was reached before it.

use super::Summary;
use crate::number::Number;
use crate::{DynamicsError, IntegrateError, Method, Real};
use core::fmt::{Display, Formatter, Result};

/// Why a run could not begin or go on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SimulateError<T> {
    /// A step could not be made.
    Integrate(IntegrateError<T>),
    /// What an observer asked could not be answered.
    Observe(DynamicsError<T>),
    /// The fixed step is zero, negative, infinite or NaN.
    StepNotPositive {
        /// The offending value (s).
        step: T,
    },
    /// The fixed step is lost in the round-off of time.
    StepLost {
        /// The offending value (s).
        step: T,
        /// The smallest that could be told from zero (s).
        smallest: T,
    },
    /// The method has no error estimate, so it can't follow a tolerance.
    NoErrorEstimate {
        /// The method.
        method: Method,
    },
    /// The run would end before it begins, or never.
    BadEnd {
        /// Time of the initial state (s).
        start: T,
        /// Time at which the run should end (s).
        until: T,
    },
    /// The initial state is infinite or NaN.
    StartNotFinite {
        /// Time of the initial state (s).
        t: T,
    },
    /// The energy can't be kept, because the mechanism doesn't conserve it.
    NotConservative,
    /// More steps were made than the run was allowed.
    TooManySteps {
        /// Time that was reached (s).
        t: T,
        /// The number of steps.
        steps: u64,
    },
    /// A step needs more evaluations of the equations than it was granted.
    TooMuchWork {
        /// Time that was reached (s).
        t: T,
        /// The evaluations that it was granted.
        most: u32,
    },
    /// The mechanism has more events than the runtime has room for.
    TooManyEvents {
        /// How many it has.
        events: usize,
        /// How many there is room for.
        room: usize,
    },
}

impl<T> From<IntegrateError<T>> for SimulateError<T> {
    fn from(error: IntegrateError<T>) -> Self {
        Self::Integrate(error)
    }
}

impl<T: Real> Display for SimulateError<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Integrate(error) => error.fmt(f),
            Self::Observe(error) => error.fmt(f),
            Self::StepNotPositive { step } => write!(
                f,
                "the step must be a positive number of seconds, not {step}",
                step = Number(step)
            ),
            Self::StepLost { step, smallest } => write!(
                f,
                "a step of {step} s is lost in the round-off of time; the smallest that could be \
                 told from zero here is {smallest} s",
                step = Number(step),
                smallest = Number(smallest)
            ),
            Self::NoErrorEstimate { method } => write!(
                f,
                "the method {method} has no error estimate and can't follow a tolerance; give it \
                 a fixed step, or take dp5, dop853, radau5 or radau9"
            ),
            Self::BadEnd { start, until } => write!(
                f,
                "the run begins at t = {start} s and can't end at t = {until} s: the end must be \
                 a number and not come earlier",
                start = Number(start),
                until = Number(until)
            ),
            Self::StartNotFinite { t } => {
                let t = Number(t);
                write!(
                    f,
                    "the initial state at t = {t} s is infinite or NaN; check what it was made from"
                )
            }
            Self::NotConservative => f.write_str(
                "the energy can't be kept: the mechanism has dissipation, applied forces, inputs \
                 or explicit time; run it without keeping the energy",
            ),
            Self::TooManySteps { t, steps } => write!(
                f,
                "after {steps} steps the run had only come to t = {t} s; allow more steps or a \
                 larger tolerance",
                t = Number(t)
            ),
            Self::TooMuchWork { t, most } => write!(
                f,
                "{most} evaluations of the equations are too few for the step at t = {t} s; \
                 grant more, or take a shorter step",
                t = Number(t)
            ),
            Self::TooManyEvents { events, room } => write!(
                f,
                "the mechanism has {events} events, and there is room for {room}; leave some out"
            ),
        }
    }
}

impl<T: Real> core::error::Error for SimulateError<T> {}

/// A run that failed: why, and what it reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Failure<T, const N: usize> {
    /// Why.
    pub error: SimulateError<T>,
    /// What was reached before: its `end` is the last good state.
    pub summary: Summary<T, N>,
}

impl<T: Real, const N: usize> Display for Failure<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        self.error.fmt(f)
    }
}

impl<T: Real, const N: usize> core::error::Error for Failure<T, N> {}
