//! How far a long run has come, for somebody who waits at a terminal.
//!
//! In:  the times that are reached.
//! Out: one line on standard error, written over and over and removed at the end;
//!      nothing if standard error is no terminal, or the run is short.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::{Duration, Instant};

/// Runs shorter than this show nothing.
const PATIENCE: Duration = Duration::from_secs(1);
/// How often the line is written in a second.
const RATE: u8 = 5;
/// Steps between looks at the clock.
const STEPS_BETWEEN_LOOKS: u64 = 32;
/// Parts that a run is divided into.
const PARTS: f64 = 1e4;
/// How the line looks.
const LINE: &str = "[{bar:24}] {percent:>3} %  {msg}, about {eta} left";

/// The line.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    begun: Instant,
    start: f64,
    until: f64,
    steps: u64,
    /// The number of steps at which to look at the clock again.
    look: u64,
}

impl Progress {
    /// Of a run from one time to another (s).
    pub fn new(start: f64, until: f64, wanted: bool) -> Self {
        let target = match wanted {
            true => ProgressDrawTarget::stderr_with_hz(RATE),
            false => ProgressDrawTarget::hidden(),
        };
        let bar = ProgressBar::with_draw_target(Some(PARTS as u64), target);
        // What the library refuses leaves the line as it is usually.
        if let Ok(style) = ProgressStyle::with_template(LINE) {
            bar.set_style(style.progress_chars("=> "));
        }
        Self {
            bar,
            begun: Instant::now(),
            start,
            until,
            steps: 0,
            look: STEPS_BETWEEN_LOOKS,
        }
    }

    /// Takes note of steps to a time (s).
    pub fn at(&mut self, t: f64, steps: u64) {
        self.steps += steps;
        if self.bar.is_hidden() || self.steps < self.look {
            return;
        }
        self.look = self.steps + STEPS_BETWEEN_LOOKS;
        let elapsed = self.begun.elapsed();
        if elapsed >= PATIENCE {
            self.bar.set_message(self.message(t, elapsed));
            self.bar.set_position(self.part(t));
        }
    }

    /// How much of the run is done.
    fn part(&self, t: f64) -> u64 {
        (PARTS * (t - self.start) / (self.until - self.start)) as u64
    }

    fn message(&self, t: f64, elapsed: Duration) -> String {
        let rate = self.steps as f64 / elapsed.as_secs_f64();
        format!("t = {t:.3} of {} s, {rate:.0} steps/s", self.until)
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::{LINE, Progress};
    use indicatif::ProgressStyle;
    use std::time::Duration;

    #[test]
    fn the_line_tells_time_rate_and_part() {
        assert!(ProgressStyle::with_template(LINE).is_ok());
        let mut progress = Progress::new(5.0, 10.0, false);
        progress.at(6.0, 640);
        assert_eq!(progress.part(6.0), 2000);
        let message = progress.message(6.0, Duration::from_secs(2));
        assert_eq!(message, "t = 6.000 of 10 s, 320 steps/s");
    }
}
