//! States at equal intervals of time.
//!
//! In:  steps.
//! Out: calls of a function, at exact multiples of the interval.

use super::{Observer, OtherBranch, Probe};
use crate::number::Number;
use crate::{DynamicsError, Real, State, Step};
use core::fmt::{Display, Formatter};
use core::ops::ControlFlow;

/// Rows closer to the end of a step than this multiple of the round-off of time
/// are the end of the step.
const SAME_TIME: f64 = 4.0;

/// An interval between rows that is not a positive number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BadInterval<T>(
    /// The offending value (s).
    pub T,
);

impl<T: Real> Display for BadInterval<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        write!(
            f,
            "the interval between rows must be a positive number of seconds, not {}",
            Number(&self.0)
        )
    }
}

impl<T: Real> core::error::Error for BadInterval<T> {}

/// Decimals of an interval that are looked for.
const DECIMALS: u32 = 15;
/// Whole numbers below this one are exact.
const EXACT: f64 = 9e15;

/// An interval as a fraction, so that a multiple of it is rounded once: three times 0.3 is
/// 0.9, as a person writes it.
#[derive(Clone, Copy, Debug)]
struct Interval<T> {
    numerator: T,
    denominator: T,
}

impl<T: Real> Interval<T> {
    /// The fraction of ten with the fewest decimals that an interval is the nearest number
    /// to; the interval itself if there is none.
    fn new(every: T) -> Self {
        let size = every.to_f64();
        let mut power = 1.0;
        for _ in 0..=DECIMALS {
            let whole = size * power + 0.5;
            if whole >= EXACT {
                break;
            }
            let numerator = T::from_f64(whole as u64 as f64);
            let denominator = T::from_f64(power);
            if numerator / denominator == every {
                return Self {
                    numerator,
                    denominator,
                };
            }
            power *= 10.0;
        }
        Self {
            numerator: every,
            denominator: T::one(),
        }
    }

    fn times(self, count: u64) -> T {
        self.numerator * T::from_f64(count as f64) / self.denominator
    }
}

/// The times `t₀ + i·dt`, and how far a run has come: the rows of a step one at a time, for
/// observers that ask something at each of them.
#[derive(Clone, Debug)]
pub struct Grid<T> {
    every: Interval<T>,
    origin: T,
    next: u64,
    /// Whether the next run is a later part of one that has begun.
    goes_on: bool,
}

impl<T: Real> Grid<T> {
    /// Times every `every` seconds.
    ///
    /// # Errors
    ///
    /// [`BadInterval`] if the interval is not a positive number.
    pub fn new(every: T) -> Result<Self, BadInterval<T>> {
        if every.is_finite() && every > T::zero() {
            Ok(Self {
                every: Interval::new(every),
                origin: T::zero(),
                next: 0,
                goes_on: false,
            })
        } else {
            Err(BadInterval(every))
        }
    }

    /// A run begins at `t`: whether that is a row, the first one. In a later part of a run
    /// it is none, because the part before has taken what rows there are up to it.
    pub fn begin(&mut self, t: T) -> bool {
        if core::mem::take(&mut self.goes_on) {
            return false;
        }
        self.origin = t;
        self.next = 1;
        true
    }

    /// The first rows are taken, and the next run has the others.
    pub fn go_on(&mut self, origin: T, rows: u64) {
        self.origin = origin;
        self.next = rows;
        self.goes_on = true;
    }

    /// The next row, if it is within a step.
    ///
    /// # Errors
    ///
    /// What the probe reports.
    pub fn row<const N: usize>(
        &mut self,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<Option<State<T, N>>, DynamicsError<T>> {
        let end = *step.end();
        let same = T::EPSILON * T::from_f64(SAME_TIME) * end.t.abs().max(self.origin.abs());
        let t = self.origin + self.every.times(self.next);
        if t > end.t + same {
            return Ok(None);
        }
        let mut row = State { t, ..end };
        if (t - end.t).abs() > same {
            row = step.at(t);
            probe.project(&mut row, OtherBranch::Refused)?;
        }
        self.next += 1;
        Ok(Some(row))
    }
}

/// Calls a function with the states at `t₀`, `t₀ + dt`, `t₀ + 2 dt`, …
///
/// Row `i` is at `t₀ + i·dt`, rounded once where `dt` is a decimal: nothing accumulates. States
/// within a step come from its interpolant and are brought back onto the constraints. The
/// function may break the run off.
#[derive(Clone, Debug)]
pub struct Sampler<T, F> {
    grid: Grid<T>,
    sink: F,
}

impl<T: Real, F> Sampler<T, F> {
    /// Calls `sink` every `every` seconds.
    ///
    /// # Errors
    ///
    /// [`BadInterval`] if the interval is not a positive number.
    pub fn new(every: T, sink: F) -> Result<Self, BadInterval<T>> {
        Ok(Self {
            grid: Grid::new(every)?,
            sink,
        })
    }

    /// Makes the next run the continuation of one that began at `origin` (s) and has given
    /// so many rows, the one at `origin` among them.
    ///
    /// The state that the next run begins with is then no row of its own: the next row is
    /// the next of `origin + i·dt`, wherever the part before ended. The run after that
    /// begins anew, unless it is told to go on, too.
    pub fn go_on(&mut self, origin: T, rows: u64) {
        self.grid.go_on(origin, rows);
    }
}

impl<T, F, const N: usize> Observer<T, N> for Sampler<T, F>
where
    T: Real,
    F: FnMut(&State<T, N>) -> ControlFlow<()>,
{
    fn begin(
        &mut self,
        state: &State<T, N>,
        _probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        Ok(match self.grid.begin(state.t) {
            true => (self.sink)(state),
            false => ControlFlow::Continue(()),
        })
    }

    fn step(
        &mut self,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        while let Some(row) = self.grid.row(step, probe)? {
            if (self.sink)(&row).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        Ok(ControlFlow::Continue(()))
    }
}

#[cfg(test)]
mod tests {
    use super::Interval;

    #[test]
    fn multiples_of_a_decimal_interval_are_the_nearest_numbers_to_decimals() {
        for every in ["0.3", "0.1", "0.05", "1e-3", "2.5", "7", "1e-9"] {
            let interval = Interval::new(every.parse::<f64>().unwrap_or(f64::NAN));
            for count in 0..2000_u64 {
                let (digits, exponent) = every.split_once("e-").unwrap_or((every, "0"));
                let decimals = digits.split_once('.').map_or(0, |(_, d)| d.len());
                let whole: u64 = digits.replace('.', "").parse().unwrap_or(0);
                let shift = decimals + exponent.parse::<usize>().unwrap_or(0);
                let text = format!("{}e-{shift}", whole * count);
                let wanted: f64 = text.parse().unwrap_or(f64::NAN);
                assert_eq!(interval.times(count), wanted, "{count} times {every}");
            }
        }
    }

    #[test]
    fn another_interval_is_multiplied_as_it_is() {
        let third = 1.0_f64 / 3.0;
        assert_eq!(Interval::new(third).times(3), 3.0 * third);
        assert_eq!(Interval::new(1e300).times(2), 2e300);
        assert_eq!(Interval::new(1e-300).times(2), 2e-300);
    }
}
