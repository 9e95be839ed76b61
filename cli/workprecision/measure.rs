//! Runs against the clock.
//!
//! In:  a mechanism, methods and forms, where the motion ends exactly.
//! Out: a [`Series`] for each pair: error and time at several settings.

use crate::arguments::{FormName, MethodName};
use crate::number::largest;
use bricard_driver::{AnyMechanism, Exact, TimedRun};
use bricard_runtime::{Audit, Options, StepControl};
use std::time::Duration;

/// Steps of RK4 (s), from the longest on, or from a run that is shorter, each half of the one
/// before.
const LONGEST_STEP: f64 = 0.08;
/// How many of them.
const HALVINGS: i32 = 10;
/// Tolerances of adaptive methods: powers of ten from the first to the last exponent.
const EXPONENTS: std::ops::RangeInclusive<i32> = 3..=13;
/// Runs are repeated until they took this long together.
const TOGETHER: Duration = Duration::from_millis(60);
/// How often at most.
const REPEATED: usize = 15;
/// A series ends where a run took this long.
const LONG: Duration = Duration::from_secs(2);
/// Accepted steps after which a run is given up.
const MOST_STEPS: u64 = 2_000_000;

/// A method with a form of the equations, at several settings.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The method.
    pub method: MethodName,
    /// The form.
    pub form: FormName,
    /// Its runs, from the coarsest setting to the finest.
    pub points: Vec<Point>,
    /// Why there are no more, if a run failed.
    pub failed: Option<String>,
}

/// A setting of a method.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Step or tolerance, in words.
    pub setting: String,
    /// Largest error of a coordinate at the end (m or rad).
    pub error: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Accelerations.
    pub evaluations: u64,
    /// Median time of a run.
    pub wall: Duration,
}

/// Runs one method with one form at all settings.
pub fn series(
    mechanism: &dyn AnyMechanism,
    (method, form): (MethodName, FormName),
    until: f64,
    exact: &Exact,
) -> Series {
    let mut series = Series {
        method,
        form,
        points: Vec::new(),
        failed: None,
    };
    for (setting, step_control) in settings(method, until) {
        let mut options = Options::new(until, method.into(), step_control);
        options.settings.form = form.into();
        options.audit = Audit::NONE;
        options.most_steps = Some(MOST_STEPS);
        match repeated(mechanism, &options) {
            Ok(run) => {
                series.points.push(point(setting, &run, exact));
                if run.wall > LONG {
                    break;
                }
            }
            Err(reason) => {
                series.failed = Some(format!("{setting}: {reason}"));
                // A coarse setting may fail where finer ones do not.
                if !series.points.is_empty() {
                    break;
                }
            }
        }
    }
    series
}

/// The settings of a method, and what to call them; steps are no longer than the run.
fn settings(method: MethodName, until: f64) -> Vec<(String, StepControl<f64>)> {
    if method == MethodName::Rk4 {
        let longest = LONGEST_STEP.min(until);
        let step = |halving: i32| longest * 0.5_f64.powi(halving);
        let of = |step| (format!("h = {step}"), StepControl::Fixed { step });
        return (0..HALVINGS).map(step).map(of).collect();
    }
    let adaptive = |exponent: i32| {
        let tolerance = 10.0_f64.powi(-exponent);
        let step_control = StepControl::Adaptive {
            relative: tolerance,
            absolute: tolerance,
        };
        (format!("tolerance {tolerance:.0e}"), step_control)
    };
    EXPONENTS.map(adaptive).collect()
}

/// A run with the median time of several.
fn repeated(mechanism: &dyn AnyMechanism, options: &Options<f64>) -> Result<TimedRun, String> {
    let mut runs = vec![mechanism.timed_run(None, options)?];
    let mut together = runs[0].wall;
    while together < TOGETHER && runs.len() < REPEATED {
        let run = mechanism.timed_run(None, options)?;
        together += run.wall;
        runs.push(run);
    }
    runs.sort_by_key(|run| run.wall);
    Ok(runs.swap_remove(runs.len() / 2))
}

fn point(setting: String, run: &TimedRun, exact: &Exact) -> Point {
    let differences = run.end.iter().zip(&exact.end).map(|(a, b)| a - b);
    Point {
        setting,
        error: largest(differences),
        steps: run.steps,
        evaluations: run.evaluations,
        wall: run.wall,
    }
}
