//! Time and error from the nominal start.

use crate::problem::{Failed, Problem};
use crate::run::Solver;
use rustix::time::{ClockId, clock_gettime};
use std::time::Duration;

/// Runs are repeated until they took this long together.
const TOGETHER: Duration = Duration::from_millis(100);
/// How often at most.
const REPEATED: usize = 15;
/// How often at least, unless one takes longer than all may together.
const AT_LEAST: usize = 5;

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

/// Processor time of this thread: what other programs take of the machine is not in it.
fn clock() -> Duration {
    let now = clock_gettime(ClockId::ThreadCPUTime);
    let [seconds, nanoseconds] =
        [now.tv_sec, now.tv_nsec].map(|part| u64::try_from(part).unwrap_or(0));
    Duration::from_secs(seconds) + Duration::from_nanos(nanoseconds)
}

/// What a run gives, and the median of its processor time (s).
///
/// # Errors
///
/// A run that fails.
pub fn timed<E>(run: impl Fn() -> Result<E, Failed>) -> Result<(E, f64), Failed> {
    let mut times = Vec::new();
    let mut together = Duration::ZERO;
    loop {
        let begun = clock();
        let end = run()?;
        let took = clock() - begun;
        together += took;
        times.push(took);
        let enough = times.len() >= AT_LEAST || took > TOGETHER;
        if times.len() == REPEATED || (together > TOGETHER && enough) {
            times.sort();
            return Ok((end, times[times.len() / 2].as_secs_f64()));
        }
    }
}
