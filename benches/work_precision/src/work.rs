//! Time and error from the nominal start.

use crate::problem::{Failed, Problem};
use crate::run::Solver;
use beside::Repeated;
use std::time::Duration;

/// How often runs are repeated.
const REPEATED: Repeated = Repeated {
    together: Duration::from_millis(100),
    at_least: 5,
    at_most: 15,
};

/// A run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Step (s) or tolerance.
    pub setting: f64,
    /// Error of q₁ at the end (rad).
    pub error: f64,
    /// Median processor time (s).
    pub seconds: f64,
    /// Whether it is on another branch at the end.
    pub off_branch: bool,
}

/// Runs a method at all its settings; what fails has its reason instead.
pub fn points(problem: Problem, method: Solver, exact: f64) -> Vec<(f64, Result<Point, String>)> {
    let point = |setting: f64| {
        let (q, seconds) = timed(|| method.run(problem, problem.nominal(), setting))?;
        Ok(Point {
            setting,
            error: (q[0] - exact).abs(),
            seconds,
            off_branch: problem.off_branch(&q) > 0.2,
        })
    };
    let named = |setting| {
        (
            setting,
            point(setting).map_err(|error: Failed| error.to_string()),
        )
    };
    method.settings().into_iter().map(named).collect()
}

/// What a run gives, and the median of its processor time (s).
///
/// # Errors
///
/// A run that fails.
pub fn timed<E>(run: impl Fn() -> Result<E, Failed>) -> Result<(E, f64), Failed> {
    REPEATED.timed(run)
}
