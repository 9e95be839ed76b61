//! How far a long run has come, for somebody who waits at a terminal.
//!
//! In:  the times that are reached.
//! Out: one line on standard error, written over and over and removed at the end;
//!      nothing if standard error is no terminal, or the run is short.

use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Runs shorter than this show nothing.
const PATIENCE: Duration = Duration::from_secs(1);
/// How often the line is written.
const PERIOD: Duration = Duration::from_millis(200);
/// Steps between looks at the clock.
const STEPS_BETWEEN_LOOKS: u64 = 32;
/// Goes back to the beginning of the line and clears it.
const CLEAR: &str = "\r\x1b[K";

/// The line.
#[derive(Debug)]
pub struct Progress {
    begun: Instant,
    shown: Option<Instant>,
    start: f64,
    until: f64,
    steps: u64,
    /// The number of steps at which to look at the clock again.
    look: u64,
    silent: bool,
}

impl Progress {
    /// Of a run from one time to another (s).
    pub fn new(start: f64, until: f64, wanted: bool) -> Self {
        Self {
            begun: Instant::now(),
            shown: None,
            start,
            until,
            steps: 0,
            look: STEPS_BETWEEN_LOOKS,
            silent: !(wanted && io::stderr().is_terminal()),
        }
    }

    /// Takes note of steps to a time (s).
    pub fn at(&mut self, t: f64, steps: u64) {
        self.steps += steps;
        if self.silent || self.steps < self.look {
            return;
        }
        self.look = self.steps + STEPS_BETWEEN_LOOKS;
        let due = self
            .shown
            .map_or(self.begun + PATIENCE, |shown| shown + PERIOD);
        if Instant::now() >= due {
            let line = self.line(t, self.begun.elapsed());
            let mut err = io::stderr().lock();
            let _unread = write!(err, "{CLEAR}{line}").and_then(|()| err.flush());
            self.shown = Some(Instant::now());
        }
    }

    fn line(&self, t: f64, elapsed: Duration) -> String {
        let part = (t - self.start) / (self.until - self.start);
        let left = elapsed.as_secs_f64() * (1.0 - part) / part;
        let (steps, until) = (self.steps, self.until);
        let percent = 100.0 * part;
        format!("t = {t:.6} of {until} s, {percent:.0} %, {steps} steps, about {left:.0} s left")
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.shown.is_some() {
            let _unread = write!(io::stderr().lock(), "{CLEAR}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Progress;
    use std::time::Duration;

    #[test]
    fn the_time_left_is_that_of_the_rest_at_the_same_speed() {
        let progress = Progress::new(0.0, 10.0, false);
        let line = progress.line(2.5, Duration::from_secs(5));
        assert_eq!(line, "t = 2.500000 of 10 s, 25 %, 0 steps, about 15 s left");
    }
}
