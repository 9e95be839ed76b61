//! How long a step may be.
//!
//! In:  error estimates, tolerances.
//! Out: the error norm, the next step, the first step.
//!
//! Source: Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I
//! (1993), section II.4; PI control: Gustafsson, ACM TOMS 17 (1991) 533–554; its gains
//! in this form: Söderlind, ACM TOMS 29 (2003) 1–26.

use super::IntegrateError;
use crate::{Real, State};
use nalgebra::SVector;

/// Relative tolerances below this multiple of the round-off of 1 are refused.
const SMALLEST_TOLERANCE: f64 = 10.0;
/// Steps below this multiple of the round-off of time are refused.
pub(crate) const SMALLEST_STEP: f64 = 4.0;
/// A step beside a singular configuration is given up below this power of round-off, in units of
/// the longest step (4e-11 for `f64`).
const CREEPING: f64 = 2.0 / 3.0;
/// Power of round-off that steps are short at, likewise, and how many of them in a row are no way
/// past what stands there.
const SHORT: f64 = 0.5;
const MOST_SHORT: usize = 1000;
/// The next step aims at this fraction of the step that would just pass.
const SAFETY: f64 = 0.9;
/// Errors below this are not remembered: they would promise too much.
const REMEMBERED_ERROR: f64 = 1e-4;
/// A step whose error can't be told is followed by one this much shorter.
const RETREAT: f64 = 0.25;
/// A step that would leave less than this fraction of itself is stretched to
/// the bound.
const STRETCH: f64 = 0.01;

/// Accepted error per step: `absolute + relative · |value|`, per component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance<T, const N: usize> {
    relative: T,
    q: SVector<T, N>,
    v: SVector<T, N>,
}

/// A [`Tolerance`] over slices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale<'a, T> {
    relative: T,
    q: &'a [T],
    v: &'a [T],
}

impl<T: Real, const N: usize> Tolerance<T, N> {
    /// The same absolute tolerance for every coordinate (m, rad) and every
    /// velocity (m/s, rad/s).
    ///
    /// # Errors
    ///
    /// - [`IntegrateError::ToleranceNotPositive`]
    /// - [`IntegrateError::ToleranceTooSmall`] if `relative` is below round-off.
    pub fn uniform(relative: T, absolute: T) -> Result<Self, IntegrateError<T>> {
        Self::per_component(
            relative,
            SVector::repeat(absolute),
            SVector::repeat(absolute),
        )
    }

    /// An absolute tolerance for each coordinate and each velocity.
    ///
    /// # Errors
    ///
    /// As [`uniform`](Self::uniform).
    #[inline(never)]
    pub fn per_component(
        relative: T,
        q: SVector<T, N>,
        v: SVector<T, N>,
    ) -> Result<Self, IntegrateError<T>> {
        let good = |x: &T| x.is_finite() && *x > T::zero();
        let all = core::iter::once(&relative).chain(q.iter()).chain(v.iter());
        for value in all {
            if !good(value) {
                return Err(IntegrateError::ToleranceNotPositive { value: *value });
            }
        }
        let smallest = T::EPSILON * T::from_f64(SMALLEST_TOLERANCE);
        if relative < smallest {
            return Err(IntegrateError::ToleranceTooSmall { relative, smallest });
        }
        Ok(Self { relative, q, v })
    }

    /// The relative part.
    pub(crate) fn relative(&self) -> T {
        self.relative
    }

    /// A multiple of the round-off, for what must be solved as well as it can.
    pub(crate) fn round_off(multiple: f64) -> Self {
        let small = T::EPSILON * T::from_f64(multiple);
        Self {
            relative: small,
            q: SVector::repeat(small),
            v: SVector::repeat(small),
        }
    }

    /// A part of the tolerance, in its own units, but not less than round-off.
    pub(crate) fn part(&self, part: f64) -> T {
        let round_off = T::EPSILON * T::from_f64(SMALLEST_TOLERANCE) / self.relative;
        T::from_f64(part).max(round_off)
    }

    /// Root mean square of an error in units of the tolerance; the values at
    /// both ends of the step, whichever is larger, set the scale.
    pub(crate) fn norm(
        &self,
        error: (&SVector<T, N>, &SVector<T, N>),
        start: &State<T, N>,
        end: &State<T, N>,
    ) -> T {
        let error = (error.0.as_slice(), error.1.as_slice());
        let (start, end) = (start.at(), end.at());
        self.scale().norm(error, (start.q, start.v), (end.q, end.v))
    }

    /// The tolerance over slices.
    pub(crate) fn scale(&self) -> Scale<'_, T> {
        Scale {
            relative: self.relative,
            q: self.q.as_slice(),
            v: self.v.as_slice(),
        }
    }
}

impl<T: Real> Scale<'_, T> {
    /// As [`Tolerance::norm`].
    #[inline(always)]
    pub(crate) fn norm(&self, error: (&[T], &[T]), start: (&[T], &[T]), end: (&[T], &[T])) -> T {
        let n = self.q.len();
        let [error, start, end] = [error, start, end].map(|(q, v)| (&q[..n], &v[..n]));
        let scale = self.first(n);
        let mut sum = T::zero();
        for k in 0..n {
            let (start, end) = ((start.0[k], start.1[k]), (end.0[k], end.1[k]));
            sum += scale.square(k, (error.0[k], error.1[k]), start, end);
        }
        scale.mean(sum)
    }

    /// The scale of all `n` coordinates, in slices whose length the compiler sees to be `n`.
    #[inline(always)]
    pub(crate) fn first(&self, n: usize) -> Self {
        Self {
            q: &self.q[..n],
            v: &self.v[..n],
            ..*self
        }
    }

    /// What coordinate `k` and its velocity add to the sum of squares.
    #[inline(always)]
    pub(crate) fn square(&self, k: usize, error: (T, T), start: (T, T), end: (T, T)) -> T {
        let q = self.q[k] + self.relative * start.0.abs().max(end.0.abs());
        let v = self.v[k] + self.relative * start.1.abs().max(end.1.abs());
        let (q, v) = (error.0 / q, error.1 / v);
        q * q + v * v
    }

    /// The root mean square of that sum.
    #[inline(always)]
    pub(crate) fn mean(&self, sum: T) -> T {
        (sum / T::from_f64(2.0 * self.q.len().max(1) as f64)).sqrt()
    }
}

/// Refuses a bound that is not ahead.
pub(crate) fn check_bound<T: Real>(t: T, bound: T) -> Result<(), IntegrateError<T>> {
    if bound.is_finite() && bound > t {
        Ok(())
    } else {
        Err(IntegrateError::BadBound { t, bound })
    }
}

/// How PI control answers to errors: the next step is as the last, times
/// `SAFETY · before^memory / error^reaction`, both exponents times the inverse order
/// of the estimate. The gain of the integral part is their difference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gains {
    /// Exponent of the error.
    pub(crate) reaction: f64,
    /// Exponent of the error of the step before.
    pub(crate) memory: f64,
}

impl Gains {
    /// For explicit methods. The integral part is small: mechanisms change their speed
    /// smoothly, and a control that follows it calmly has fewer steps rejected, and
    /// errors that are more alike from one start to the next.
    pub(crate) const CALM: Self = Self {
        reaction: 0.6,
        memory: 0.4,
    };
    /// For implicit methods, whose estimates jump when transients end.
    pub(crate) const QUICK: Self = Self {
        reaction: 0.88,
        memory: 0.16,
    };
}

/// PI control of the step size.
#[derive(Clone, Debug)]
pub(crate) struct Control<T> {
    /// The step to try next; zero before the first.
    pub(crate) h: T,
    reaction: T,
    memory: T,
    longest_jump: T,
    shortest_jump: T,
    last_error: T,
    rejected: bool,
    /// The longest step that was accepted.
    longest: T,
    /// How many of the last accepted steps were short in a row.
    short: usize,
}

impl<T: Real> Control<T> {
    /// Control of a method whose estimate is `O(h^order)`; a step may shrink
    /// by `least` and grow by `most` at once.
    pub(crate) fn new(order: u8, gains: Gains, (least, most): (f64, f64)) -> Self {
        let order = f64::from(order);
        Self {
            h: T::zero(),
            reaction: T::from_f64(gains.reaction / order),
            memory: T::from_f64(gains.memory / order),
            longest_jump: T::from_f64(most),
            shortest_jump: T::from_f64(least),
            last_error: T::from_f64(REMEMBERED_ERROR),
            rejected: false,
            longest: T::zero(),
            short: 0,
        }
    }

    /// Begins anew: trials at a step that failed tell nothing of the next one.
    pub(crate) fn restart(&mut self) {
        self.h = T::zero();
        self.last_error = T::from_f64(REMEMBERED_ERROR);
        self.rejected = false;
        self.longest = T::zero();
        self.short = 0;
    }

    /// Whether a step that a singular configuration still stands in the way of is so short
    /// that shorter ones would only creep up to it, or comes after too many that were short.
    pub(crate) fn creeps(&self, h: T) -> bool {
        h < self.longest * T::EPSILON.powf(T::from_f64(CREEPING)) || self.short > MOST_SHORT
    }

    /// Whether a step is so short that its error can only be round-off.
    pub(crate) fn is_short(&self, h: T) -> bool {
        h < self.longest * T::EPSILON.powf(T::from_f64(SHORT))
    }

    /// Where the next trial step ends: at the bound if it is near, half-way
    /// there if it is less than two steps away, so that no tiny step remains.
    pub(crate) fn end(&self, t: T, bound: T) -> Result<T, IntegrateError<T>> {
        let left = bound - t;
        if self.h * T::from_f64(1.0 + STRETCH) >= left || is_lost(left, t, bound) {
            return Ok(bound);
        }
        let two = T::from_f64(2.0);
        let h = if self.h * two > left {
            left / two
        } else {
            self.h
        };
        match is_lost(h, t, bound) {
            true => Err(IntegrateError::StepUnderflow { t, h }),
            false => Ok(t + h),
        }
    }

    /// Whether nothing tells how long the next step is to be: none was made, or only such as end
    /// where a caller wanted, too soon to tell.
    pub(crate) fn is_unknown(&self, t: T, bound: T) -> bool {
        is_lost(self.h, t, bound)
    }

    /// Judges a trial step of length `h` by its error in units of the tolerance,
    /// and sets the next.
    pub(crate) fn judge(&mut self, h: T, error: T) -> bool {
        if !error.is_finite() {
            self.h = h * T::from_f64(RETREAT);
            self.rejected = true;
            return false;
        }
        let plain = error.powf(self.reaction);
        if error > T::one() {
            let jump = (T::from_f64(SAFETY) / plain).max(self.shortest_jump);
            self.h = h * jump;
            self.rejected = true;
            return false;
        }
        let wished = T::from_f64(SAFETY) * self.last_error.powf(self.memory) / plain;
        let most = if self.rejected {
            T::one()
        } else {
            self.longest_jump
        };
        // An error of zero makes `wished` infinite, which `most` bounds.
        let next = h * wished.max(self.shortest_jump).min(most);
        // A step that was cut to end at the bound says nothing against the
        // longer one that was planned.
        self.h = if self.rejected || h >= self.h {
            next
        } else {
            next.max(self.h)
        };
        self.last_error = error.max(T::from_f64(REMEMBERED_ERROR));
        self.rejected = false;
        self.longest = self.longest.max(h);
        let is_short = self.is_short(h);
        self.short = if is_short { self.short + 1 } else { 0 };
        true
    }
}

/// Whether a step is lost in the round-off of time on the way to a bound.
fn is_lost<T: Real>(h: T, t: T, bound: T) -> bool {
    let resolution = T::EPSILON * t.abs().max(bound.abs());
    h <= resolution * T::from_f64(SMALLEST_STEP)
}
