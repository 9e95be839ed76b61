//! What a user chooses about a run.
//!
//! Out: [`Options`].

use crate::{Method, Real, Settings};

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

impl<T: Copy> StepControl<T> {
    /// Accepted error of a step, relative, if the steps follow one.
    pub(super) fn tolerance(&self) -> Option<T> {
        match self {
            Self::Fixed { .. } => None,
            Self::Adaptive { relative, .. } => Some(*relative),
        }
    }
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
