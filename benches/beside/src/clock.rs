//! Processor time.

use rustix::time::{ClockId, clock_gettime};
use std::time::Duration;

/// How often a run is repeated to time it.
#[derive(Clone, Copy, Debug)]
pub struct Repeated {
    /// Until the runs took this long together,
    pub together: Duration,
    /// but at least so often, unless one takes longer than all may together,
    pub at_least: usize,
    /// and so often at most.
    pub at_most: usize,
}

impl Repeated {
    /// What a run gives, and the median of its processor time (s).
    ///
    /// # Errors
    ///
    /// Those of the run.
    pub fn timed<V, E>(&self, mut run: impl FnMut() -> Result<V, E>) -> Result<(V, f64), E> {
        let mut times = Vec::new();
        let mut together = Duration::ZERO;
        loop {
            let begun = now();
            let value = run()?;
            let took = now() - begun;
            together += took;
            times.push(took);
            let enough = times.len() >= self.at_least || took > self.together;
            if times.len() == self.at_most || (together > self.together && enough) {
                times.sort();
                return Ok((value, times[times.len() / 2].as_secs_f64()));
            }
        }
    }
}

/// Processor time of this thread: what other programs take of the machine is not in it.
fn now() -> Duration {
    let now = clock_gettime(ClockId::ThreadCPUTime);
    let [seconds, nanoseconds] =
        [now.tv_sec, now.tv_nsec].map(|part| u64::try_from(part).unwrap_or(0));
    Duration::from_secs(seconds) + Duration::from_nanos(nanoseconds)
}
