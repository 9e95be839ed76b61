//! How a call ended.
//!
//! In:  errors of the runtime.
//! Out: [`Status`].

use bricard_runtime::{DynamicsError, IntegrateError, SimulateError};
use core::ffi::CStr;

/// How a call ended: zero or more where it did what it was asked to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// A run ended early, because a callback or another thread wanted it to.
    Stopped = 1,
    /// A run ended early, because the rows are full.
    Full = 2,
    /// A pointer that has to lead somewhere is null.
    Null = -1,
    /// An array has another length than the mechanism wants.
    Length = -2,
    /// There is nothing at an index.
    Index = -3,
    /// There is nothing of a name.
    Name = -4,
    /// A number that was given is infinite or NaN.
    NotFinite = -5,
    /// A value makes no sense.
    Argument = -6,
    /// There is no state yet.
    Order = -7,
    /// Another call is at work on the same handle.
    Busy = -8,
    /// No consistent initial state was found.
    Assembly = -9,
    /// The motion could not be computed.
    Run = -10,
    /// A callback failed.
    Callback = -11,
    /// A defect of the library itself.
    Panic = -12,
}

impl Status {
    /// What it means, in words, where nothing more is said; empty for those that always come
    /// with a reason.
    pub fn words(self) -> &'static CStr {
        match self {
            Self::Null => c"a pointer that has to lead somewhere is null",
            Self::Order => c"there is no state yet: call bricard_assemble or bricard_set_state",
            Self::Busy => c"another call is at work on the same mechanism",
            Self::Panic => c"internal error, please report; the mechanism can only be freed",
            _ => c"",
        }
    }

    /// What kind of failure an error of a run is.
    pub(crate) fn of(error: &SimulateError<f64>) -> Self {
        match error {
            SimulateError::StartNotFinite { .. } => Self::NotFinite,
            SimulateError::StepNotPositive { .. }
            | SimulateError::StepLost { .. }
            | SimulateError::NoErrorEstimate { .. }
            | SimulateError::BadEnd { .. }
            | SimulateError::NotConservative => Self::Argument,
            // Whatever else a run can meet.
            _ => Self::Run,
        }
    }
}

/// When the motion could not go on (s), if the error says so.
pub(crate) fn time(error: &SimulateError<f64>) -> Option<f64> {
    let dynamics: Option<&DynamicsError<f64>> = match error {
        SimulateError::Integrate(IntegrateError::Dynamics(error))
        | SimulateError::Observe(error) => Some(error),
        _ => None,
    };
    dynamics.map(DynamicsError::time)
}
