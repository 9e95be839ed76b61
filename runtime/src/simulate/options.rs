//! What a user chooses about a run.
//!
//! In:  nothing.
//! Out: [`Options`], and the method they choose.

use super::SimulateError;
use crate::integrator::Inside;
use crate::{
    Dop853, Dp5, IntegrateError, Integrator, Radau5, Radau9, Real, Rk4, Settings, State, Step,
    System, Tolerance,
};
use core::fmt::{Display, Formatter};

/// Which method makes the steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// [`Rk4`], of order 4.
    Rk4,
    /// [`Dp5`], of order 5.
    Dp5,
    /// [`Dop853`], of order 8.
    Dop853,
    /// [`Radau5`], implicit, of order 5: for stiff mechanisms.
    Radau5,
    /// [`Radau9`], implicit, of order 9: for stiff mechanisms, to many digits.
    Radau9,
}

impl Display for Method {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Rk4 => "rk4",
            Self::Dp5 => "dp5",
            Self::Dop853 => "dop853",
            Self::Radau5 => "radau5",
            Self::Radau9 => "radau9",
        })
    }
}

/// How long the steps are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepControl<T> {
    /// All of one length; the last one ends where the run ends.
    Fixed {
        /// The length (s).
        step: T,
    },
    /// As long as the error per step allows.
    Adaptive {
        /// Accepted error relative to each coordinate and velocity.
        relative: T,
        /// Accepted error of each coordinate (m, rad) and velocity (m/s, rad/s).
        absolute: T,
    },
}

/// What is checked along the way, for the summary. Each check costs a little.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Audit {
    /// The largest constraint errors.
    pub constraints: bool,
    /// The energy balance.
    pub energy: bool,
    /// Passages through singular positions. Always looked for with the forms
    /// that can't pass them.
    pub passages: bool,
}

impl Audit {
    /// Everything.
    pub const ALL: Self = Self {
        constraints: true,
        energy: true,
        passages: true,
    };
    /// Nothing: the fastest run.
    pub const NONE: Self = Self {
        constraints: false,
        energy: false,
        passages: false,
    };
}

/// The beginning of a run of which another one is a later part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Origin<T> {
    /// When it began (s). Fixed steps keep to its times.
    pub t: T,
    /// Its energy at the start (J): what is audited against, and what is kept where
    /// the energy is kept.
    pub energy: T,
    /// What the power has supplied since (J).
    pub supplied: T,
}

/// What a user chooses about a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options<T> {
    /// Time at which the run ends (s).
    pub until: T,
    /// The method.
    pub method: Method,
    /// The length of its steps.
    pub step_control: StepControl<T>,
    /// The form of the equations and how the constraints are kept.
    pub settings: Settings<T>,
    /// Whether the energy is kept at what it was at the start, for long runs of
    /// conservative mechanisms: its error then stays that of a few steps instead
    /// of growing with time.
    pub keep_energy: bool,
    /// What is checked along the way.
    pub audit: Audit,
    /// Accepted steps after which the run is given up; `None`: never.
    pub most_steps: Option<u64>,
    /// The beginning of the run, if this one goes on where a part of it ended;
    /// `None`: it begins here.
    pub origin: Option<Origin<T>>,
}

impl<T: Real> Options<T> {
    /// RK4 with a fixed step, everything else by default.
    pub fn rk4(until: T, step: T) -> Self {
        Self::new(until, Method::Rk4, StepControl::Fixed { step })
    }

    /// DP5 with the same relative and absolute tolerance, everything else by
    /// default.
    pub fn dp5(until: T, tolerance: T) -> Self {
        Self::new(
            until,
            Method::Dp5,
            StepControl::Adaptive {
                relative: tolerance,
                absolute: tolerance,
            },
        )
    }

    /// DOP853 with the same relative and absolute tolerance, everything else by
    /// default.
    pub fn dop853(until: T, tolerance: T) -> Self {
        let step_control = StepControl::Adaptive {
            relative: tolerance,
            absolute: tolerance,
        };
        Self::new(until, Method::Dop853, step_control)
    }

    /// A method and its step control, everything else by default: the reduced form with
    /// projection, all audits.
    pub fn new(until: T, method: Method, step_control: StepControl<T>) -> Self {
        let settings = Settings::default();
        Self {
            until,
            method,
            step_control,
            settings,
            keep_energy: false,
            audit: Audit::ALL,
            most_steps: None,
            origin: None,
        }
    }
}

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
