//! Processor time of runs.

use beside::Repeated;
use std::time::Duration;

/// How often runs are repeated.
const REPEATED: Repeated = Repeated {
    together: Duration::from_millis(300),
    at_least: 1,
    at_most: 9,
};

/// What a function gives, and the median of its processor time (s).
///
/// # Errors
///
/// Those of the function.
pub fn timed<V, E>(run: impl FnMut() -> Result<V, E>) -> Result<(V, f64), E> {
    REPEATED.timed(run)
}
