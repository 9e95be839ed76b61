//! Where a function of time leaves the side of zero that it is on.
//!
//! In:  a function on an interval, as smooth as the inside of a step.
//! Out: the first bracket in which its sign changes; the zero in it, to round-off.
//!
//! The function is taken for the polynomial through [`NODES`] Chebyshev points. Where the
//! coefficients say that the polynomial has no zero, or that it is monotone, the ends
//! decide; elsewhere the interval is halved and sampled anew. So two zeros are found however
//! close they are, unless the function between them is smaller than the error of the
//! polynomial, which the last coefficients estimate.
//!
//! Sources: Boyd, SIAM Journal on Numerical Analysis 40 (2002) 1666–1682 (Chebyshev
//! expansions and subdivision); Brent, Algorithms for Minimization without Derivatives
//! (1973), chapter 4.

use crate::Real;
use crate::linalg::{column, largest};

/// Points of an interval at which a function is sampled, both ends included.
pub(crate) const NODES: usize = 9;
/// Degree of the polynomial through them.
const DEGREE: usize = NODES - 1;
/// `cos(kπ/DEGREE)`.
const COSINES: [f64; NODES] = [
    1.0,
    0.923_879_532_511_286_7,
    0.707_106_781_186_547_5,
    0.382_683_432_365_089_8,
    0.0,
    -0.382_683_432_365_089_8,
    -0.707_106_781_186_547_5,
    -0.923_879_532_511_286_7,
    -1.0,
];
/// Times closer than this multiple of the round-off of time are one.
const SAME_TIME: f64 = 8.0;
/// What coefficients are off by, relative to the largest sample.
const ROUND_OFF: f64 = 1e-15;
/// Every sample.
const ALL: [usize; NODES] = [0, 1, 2, 3, 4, 5, 6, 7, 8];
/// Halvings of an interval; then the samples decide.
const MOST_HALVINGS: usize = 48;
/// Intervals of a search; then the samples decide.
const MOST_INTERVALS: usize = 256;
/// Steps of Brent's method. Bisection alone would need fewer than this for any
/// pair of numbers of a float type; it never takes three times as many.
const MOST_STEPS: usize = 400;

/// Functions of states within a step are off by this part of its accepted error.
const NOISE: f64 = 0.01;
/// The least that such functions are off by, and what they are off by with fixed steps, in units of
/// round-off.
const NOISE_OF_FIXED: f64 = 4096.0;

/// What is told from noise within a step, in units of what functions are off by. By experiment:
/// with less, what Newton's iterations leave within a step counts as motion.
const TOLD: f64 = 1e4;
/// What is told at any tolerance.
const SURELY_TOLD: f64 = 0.01;

/// What functions of states within a step are off by, relative to their size there, if steps
/// follow a tolerance.
pub(crate) fn noise<T: Real>(tolerance: Option<T>) -> T {
    let accepted = tolerance.unwrap_or(T::zero()) * T::from_f64(NOISE);
    accepted.max(T::EPSILON * T::from_f64(NOISE_OF_FIXED))
}

/// The least that is told from noise within a step, as a part of what is known from steps before:
/// the length of an excursion from zero, the height of one between two ends at which the function
/// is zero, as the velocity of what dry friction holds.
pub(crate) fn told<T: Real>(noise: T) -> T {
    (noise * T::from_f64(TOLD)).min(T::from_f64(SURELY_TOLD))
}

/// How far times may differ and be the same, at a time (s).
pub(crate) fn moment<T: Real>(t: T) -> T {
    T::EPSILON * T::from_f64(SAME_TIME) * t.abs()
}

/// Samples of a function on an interval.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Samples<T> {
    pub(crate) times: [T; NODES],
    pub(crate) values: [T; NODES],
}

/// What the polynomial through samples does.
enum Shape {
    /// It has no zero.
    Clear,
    /// It is monotone.
    Monotone,
    /// Nobody knows.
    Open,
}

/// Where the samples of an interval are.
pub(crate) fn nodes<T: Real>((from, to): (T, T)) -> [T; NODES] {
    let half = T::from_f64(0.5);
    let (centre, radius) = ((from + to) * half, (to - from) * half);
    column(|j| match j {
        0 => from,
        DEGREE => to,
        _ => centre - radius * T::from_f64(COSINES[j]),
    })
}

impl<T: Real> Samples<T> {
    /// Samples a function on an interval.
    pub(crate) fn of<E>(
        function: &mut dyn FnMut(T) -> Result<T, E>,
        interval: (T, T),
    ) -> Result<Self, E> {
        let times = nodes(interval);
        let mut values = [T::zero(); NODES];
        for (value, t) in values.iter_mut().zip(times) {
            *value = function(t)?;
        }
        Ok(Self { times, values })
    }

    fn ends(&self) -> (T, T) {
        (self.times[0], self.times[DEGREE])
    }

    /// The largest of them.
    pub(crate) fn size(&self) -> T {
        largest(&self.values)
    }

    /// Whether the function is zero at the beginning, but for the round-off of the time.
    pub(crate) fn begins_at_zero(&self) -> bool {
        let moment = moment(self.times[0]);
        let rise = (self.values[1] - self.values[0]).abs();
        self.values[0].abs() * (self.times[1] - self.times[0]) <= rise * moment
    }

    /// How much the round-off of time changes the function at the ends.
    pub(crate) fn round_off_of_time(&self) -> T {
        let ((from, to), steepest) = (self.ends(), self.slope(0).max(self.slope(DEGREE - 1)));
        moment(from.abs().max(to.abs())) * steepest
    }

    /// How steep the function is between a sample and the next.
    fn slope(&self, place: usize) -> T {
        let rise = self.values[place + 1] - self.values[place];
        (rise / (self.times[place + 1] - self.times[place])).abs()
    }

    /// The side on which the function goes away from zero, if it does all the way and is
    /// beyond some noise from the beginning.
    pub(crate) fn leaves_zero(&self, noise: T) -> Option<T> {
        let side = self.values[0].sign();
        let away = self
            .values
            .windows(2)
            .all(|pair| side * pair[1] >= side * pair[0]);
        let clear = self.values[0].abs() > noise;
        (clear && away).then_some(side)
    }

    /// What the polynomial through the samples does.
    fn shape(&self) -> Shape {
        let largest = self.size();
        if largest == T::zero() {
            return Shape::Monotone;
        }
        let c = coefficients(&self.values);
        let number = T::from_f64;
        // What is left out is about as large as what was taken last.
        let uncertainty = c[DEGREE].abs() + c[DEGREE - 1].abs() + number(ROUND_OFF) * largest;
        let sum = |list: &[T]| list.iter().fold(T::zero(), |sum: T, x| sum + x.abs());
        if c[0].abs() > sum(&c[1..]) + uncertainty {
            return Shape::Clear;
        }
        let mut slope = [T::zero(); NODES + 1];
        for k in (1..NODES).rev() {
            slope[k - 1] = slope[k + 1] + number(2.0 * k as f64) * c[k];
        }
        slope[0] *= number(0.5);
        let uncertainty = uncertainty * number((DEGREE * DEGREE) as f64);
        if slope[0].abs() > sum(&slope[1..]) + uncertainty {
            Shape::Monotone
        } else {
            Shape::Open
        }
    }
}

/// The coefficients of the Chebyshev expansion of the polynomial through samples.
fn coefficients<T: Real>(values: &[T; NODES]) -> [T; NODES] {
    column(|k| {
        let mut sum = T::zero();
        for (j, value) in values.iter().enumerate() {
            // From the upper end down, as cosines go.
            let place = (k * (DEGREE - j)) % (2 * DEGREE);
            let cosine = COSINES[place.min(2 * DEGREE - place)];
            let share = if j == 0 || j == DEGREE { 0.5 } else { 1.0 };
            sum += *value * T::from_f64(share * cosine);
        }
        let share = if k == 0 || k == DEGREE { 1.0 } else { 2.0 };
        sum * T::from_f64(share / DEGREE as f64)
    })
}

/// When a function has left the side of zero that it was on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Left {
    /// Once it is zero.
    AtZero,
    /// Once it is beyond zero.
    BeyondZero,
}

/// The first part of an interval in which a function leaves the side of zero that it is
/// on, which is kept in `side` (its sign; zero if that is not known yet). A function that is
/// on the other side from the beginning leaves it there.
pub(crate) fn first_crossing<T: Real, E>(
    function: &mut dyn FnMut(T) -> Result<T, E>,
    samples: &Samples<T>,
    side: &mut T,
    left: Left,
) -> Result<Option<(T, T)>, E> {
    let mut pending = [*samples; MOST_HALVINGS + 1];
    let mut count = 1;
    let mut looked_at = 0;
    while count > 0 {
        let part = pending[count - 1];
        count -= 1;
        looked_at += 1;
        let (from, to) = part.ends();
        let middle = (from + to) * T::from_f64(0.5);
        let splits = from < middle && middle < to;
        let exhausted = looked_at > MOST_INTERVALS || count >= MOST_HALVINGS || !splits;
        let crossing = match part.shape() {
            Shape::Clear | Shape::Monotone => leaves(&part, &[0, DEGREE], side, left),
            Shape::Open if exhausted => leaves(&part, &ALL, side, left),
            Shape::Open => {
                pending[count] = Samples::of(function, (middle, to))?;
                pending[count + 1] = Samples::of(function, (from, middle))?;
                count += 2;
                None
            }
        };
        if crossing.is_some() {
            return Ok(crossing);
        }
    }
    Ok(None)
}

/// The first pair of samples between which the side is left.
fn leaves<T: Real>(
    part: &Samples<T>,
    places: &[usize],
    side: &mut T,
    left: Left,
) -> Option<(T, T)> {
    for pair in places.windows(2) {
        let (first, second) = (pair[0], pair[1]);
        let sign = part.values[second].sign();
        let is_left = match left {
            Left::AtZero => sign != *side,
            Left::BeyondZero => sign == -*side,
        };
        if *side == T::zero() {
            *side = sign;
        } else if is_left {
            return Some((part.times[first], part.times[second]));
        }
    }
    None
}

/// A zero of a function between two times at which it has opposite signs.
pub(crate) fn zero<T: Real, E>(
    function: &mut dyn FnMut(T) -> Result<T, E>,
    (mut a, mut fa): (T, T),
    (mut b, mut fb): (T, T),
) -> Result<T, E> {
    let two = T::from_f64(2.0);
    // `b` is the best so far, `a` the one before, `c` on the other side of zero.
    let (mut c, mut fc) = (a, fa);
    let mut last = b - a;
    let mut before_last = last;
    for _ in 0..MOST_STEPS {
        if fc.abs() < fb.abs() {
            (a, b, c) = (b, c, b);
            (fa, fb, fc) = (fb, fc, fb);
        }
        let half = (c - b) / two;
        let resolution = T::EPSILON * b.abs();
        if fb == T::zero() || half.abs() <= resolution {
            break;
        }
        let guess = interpolate((a, fa), (b, fb), (c, fc));
        let step = guess - b;
        let inside = (step / half) > T::zero() && (step / half) < T::from_f64(1.5);
        if inside && step.abs() < (before_last / two).abs() {
            (before_last, last) = (last, step);
        } else {
            (before_last, last) = (half, half);
        }
        (a, fa) = (b, fb);
        b += if last.abs() > resolution {
            last
        } else {
            resolution * half.sign()
        };
        fb = function(b)?;
        if fb.sign() == fc.sign() {
            (c, fc) = (a, fa);
            last = b - a;
            before_last = last;
        }
    }
    Ok(b)
}

/// Inverse quadratic interpolation, or the secant where two points are one.
fn interpolate<T: Real>((a, fa): (T, T), (b, fb): (T, T), (c, fc): (T, T)) -> T {
    if a == c || fa == fc || fa == fb {
        return b - fb * (c - b) / (fc - fb);
    }
    a * fb * fc / ((fa - fb) * (fa - fc))
        + b * fa * fc / ((fb - fa) * (fb - fc))
        + c * fa * fb / ((fc - fa) * (fc - fb))
}
