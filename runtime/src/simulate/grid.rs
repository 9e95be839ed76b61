//! Where the steps of a run must end.
//!
//! In:  start, end, step control.
//! Out: the times `t₀ + i·h`, and the end.

use super::SimulateError;
use super::options::StepControl;
use crate::Real;
use crate::integrator::SMALLEST_STEP;

/// A last step shorter than this part of the others is made one with the step
/// before it.
const SLIVER: f64 = 1e-6;

/// The times at which steps must end. Each is computed from its number: nothing
/// accumulates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid<T> {
    start: T,
    until: T,
    step: T,
    intervals: u64,
}

impl<T: Real> Grid<T> {
    pub(super) fn new(
        start: T,
        until: T,
        step_control: StepControl<T>,
    ) -> Result<Self, SimulateError<T>> {
        let span = until - start;
        // Infinite or not a number if either end is.
        if !(span >= T::zero() && span.is_finite()) {
            return Err(SimulateError::BadEnd { start, until });
        }
        let StepControl::Fixed { step } = step_control else {
            // However short it is: what is left of a run by round-off is one step.
            return Ok(Self {
                start,
                until,
                step: span,
                intervals: u64::from(span > T::zero()),
            });
        };
        let (begin, end) = (start.abs(), until.abs());
        let farthest = if begin > end { begin } else { end };
        let smallest = T::EPSILON * T::from_f64(SMALLEST_STEP) * farthest;
        if span > T::zero() && step < smallest {
            return Err(SimulateError::StepLost { step, smallest });
        }
        let intervals = if span <= step {
            u64::from(span > T::zero())
        } else {
            let steps = (span / step).to_f64() - SLIVER;
            // Rounds up; a number of steps too large for the type is one that no
            // run will reach.
            let whole = steps as u64;
            (whole + u64::from(steps > whole as f64)).max(1)
        };
        Ok(Self {
            start,
            until,
            step,
            intervals,
        })
    }

    /// The number of the first interval that ends after a time.
    pub(super) fn first_after(&self, t: T) -> u64 {
        if self.intervals == 0 || t <= self.start {
            return 1;
        }
        // The quotient may be off by round-off, to either side.
        let mut number = (((t - self.start) / self.step).to_f64() as u64).max(1);
        while number > 1 && self.time(number - 1) > t {
            number -= 1;
        }
        while number < self.intervals && self.time(number) <= t {
            number += 1;
        }
        number
    }

    /// How many intervals there are.
    pub(super) fn intervals(&self) -> u64 {
        self.intervals
    }

    /// The end of the interval with a number, from 1.
    pub(super) fn time(&self, number: u64) -> T {
        if number >= self.intervals {
            self.until
        } else {
            self.start + self.step * T::from_f64(number as f64)
        }
    }
}
