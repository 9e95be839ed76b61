//! A method at a setting, whoever's it is.

use crate::problem::{End, Failed, Problem};
use crate::{index_one, joints, ours};
use bricard_runtime::{Method, StepControl};

/// A method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solver {
    /// Ours.
    Bricard(Method),
    /// diffsol's Tsit45 on the index-1 equations, with a Baumgarte gain (1/s).
    Diffsol(f64),
    /// rapier's impulse joints, with that many solver iterations.
    Rapier(usize),
}

impl Solver {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Bricard(Method::Rk4),
        Self::Bricard(Method::Dp5),
        Self::Bricard(Method::Dop853),
        Self::Diffsol(10.0),
        Self::Diffsol(50.0),
        Self::Rapier(4),
        Self::Rapier(50),
    ];

    /// What it is called.
    pub fn title(self) -> String {
        match self {
            Self::Bricard(method) => format!("bricard {method}"),
            Self::Diffsol(gain) => format!("diffsol Tsit45, gain {gain}"),
            Self::Rapier(iterations) => format!("rapier joints, {iterations} iterations"),
        }
    }

    /// Its settings: steps (s) or tolerances.
    pub fn settings(self) -> Vec<f64> {
        match self {
            Self::Bricard(Method::Rk4) => vec![0.02, 0.01, 0.005, 0.0025, 0.00125],
            Self::Bricard(_) | Self::Diffsol(_) => (4..=12).map(|k| 10.0_f64.powi(-k)).collect(),
            Self::Rapier(_) => vec![1e-2, 1e-3, 1e-4],
        }
    }

    /// What the scan runs it at.
    pub fn scanned(self) -> Vec<f64> {
        match self {
            Self::Bricard(Method::Rk4) => vec![0.01],
            Self::Bricard(_) | Self::Diffsol(_) => vec![1e-5, 1e-7, 1e-9, 1e-11],
            Self::Rapier(4) => vec![1e-3],
            Self::Rapier(_) => Vec::new(),
        }
    }

    /// A setting in words.
    pub fn setting(self, value: f64) -> String {
        match self {
            Self::Bricard(Method::Rk4) | Self::Rapier(_) => format!("h = {value} s"),
            _ => format!("tolerance {value:.0e}"),
        }
    }

    /// Runs a problem from a start angle at rest.
    ///
    /// # Errors
    ///
    /// A run that fails.
    pub fn run(self, problem: Problem, start: f64, setting: f64) -> Result<End, Failed> {
        match self {
            Self::Bricard(method) => {
                let step_control = match method {
                    Method::Rk4 => StepControl::Fixed { step: setting },
                    _ => StepControl::Adaptive {
                        relative: setting,
                        absolute: setting,
                    },
                };
                ours::run(problem, start, method, step_control)
            }
            Self::Diffsol(gain) => index_one::run(problem, start, gain, setting),
            Self::Rapier(iterations) => joints::run(problem, start, iterations, setting),
        }
    }
}
