//! Integrals over the length of a step.
//!
//! In:  a function of the time.
//! Out: its integral, by Gauss's formula of order 8 on the whole step or on parts of it.
//!
//! Steps are as long as the motion allows, and a mechanism whose constraints prescribe its
//! motion may turn many times in one of them.

use crate::Real;

/// Bisections of a step, one in the other.
const DEEPEST: u32 = 20;
/// Bisections of a step altogether: the power of a body at rest is round-off, which no part of
/// the step is too short for.
const MOST: u32 = 2000;

/// Relative difference of an integral and that by halves below which it is noise if it is no
/// smaller than this part of that of the span that was halved: of a smooth function it is a
/// 256th, and of one that turns many times within the span it is still large.
const NOISE: f64 = 1e-6;
const CONTRACTED: f64 = 0.5;

/// What the parts of a span are judged by.
#[derive(Clone, Copy, Debug)]
struct Limits<T> {
    accuracy: T,
    least: T,
    /// How much the formula differs from that by halves on the span that was halved last,
    /// relative to the size of the function.
    differed: T,
}

/// A function of the time that may fail.
pub(super) type Function<'a, T, E> = &'a mut dyn FnMut(T) -> Result<T, E>;

/// A span of time, and Gauss's formula there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Integral<T> {
    start: T,
    length: T,
    /// What the formula gives.
    pub(super) value: T,
    /// What it would give if the function were as large everywhere as it is somewhere.
    size: T,
}

impl<T: Real> Integral<T> {
    /// The integral over a span of time.
    #[inline(never)]
    pub(super) fn over<E>(function: Function<'_, T, E>, start: T, length: T) -> Result<Self, E> {
        let (mut mean, mut largest) = (T::zero(), T::zero());
        for (node, weight) in gauss::<T>() {
            let value = function(start + length * node)?;
            mean += weight * value;
            largest = largest.max(value.abs());
        }
        Ok(Self {
            start,
            length,
            value: mean * length,
            size: largest * length,
        })
    }

    /// The integral by that of both halves, or of halves of them where the two are not what
    /// the whole is. It is as exact as `accuracy` says, relative to the size of the function;
    /// what is smaller than `least` is left as it is, and so is what noise does.
    pub(super) fn refined<E>(
        &self,
        function: Function<'_, T, E>,
        accuracy: T,
        least: T,
    ) -> Result<T, E> {
        let limits = Limits {
            accuracy,
            least,
            differed: T::from_f64(f64::INFINITY),
        };
        self.bisected(function, limits, DEEPEST, &mut { MOST })
    }

    #[inline(never)]
    fn bisected<E>(
        &self,
        function: Function<'_, T, E>,
        limits: Limits<T>,
        depth: u32,
        most: &mut u32,
    ) -> Result<T, E> {
        let half = self.length * T::from_f64(0.5);
        let first = Self::over(function, self.start, half)?;
        let second = Self::over(function, self.start + half, half)?;
        let (sum, size) = (first.value + second.value, first.size.max(second.size));
        let differs = (sum - self.value).abs() / size;
        let contracts = differs <= limits.differed * T::from_f64(CONTRACTED);
        let is_noise = differs <= T::from_f64(NOISE) && !contracts;
        // Where the function vanishes, `differs` is NaN, with which comparisons are false.
        let goes_on = size > limits.least && differs > limits.accuracy && !is_noise;
        if !goes_on || depth == 0 || *most == 0 {
            return Ok(sum);
        }
        let limits = Limits {
            differed: differs,
            ..limits
        };
        *most -= 1;
        let first = first.bisected(function, limits, depth - 1, most)?;
        Ok(first + second.bisected(function, limits, depth - 1, most)?)
    }
}

/// Gauss's formula with four nodes on [0, 1], exact for polynomials of degree 7:
/// `(node, weight)`.
fn gauss<T: Real>() -> [(T, T); 4] {
    let number = T::from_f64;
    let root = number(2.0) / number(7.0) * (number(6.0) / number(5.0)).sqrt();
    let inner = (number(3.0) / number(7.0) - root).sqrt() / number(2.0);
    let outer = (number(3.0) / number(7.0) + root).sqrt() / number(2.0);
    let half = number(0.5);
    let part = number(30.0).sqrt() / number(72.0);
    let (more, less) = (number(0.25) + part, number(0.25) - part);
    [
        (half - outer, less),
        (half - inner, more),
        (half + inner, more),
        (half + outer, less),
    ]
}

#[cfg(test)]
mod tests {
    use super::{Integral, MOST};
    use bricard_testkit::Random;
    use core::convert::Infallible;

    /// The integral of a function over a second, and how often it was evaluated.
    fn integral(function: impl Fn(f64) -> f64, accuracy: f64) -> (f64, u32) {
        let mut evaluations = 0;
        let mut counted = |t| {
            evaluations += 1;
            Ok::<_, Infallible>(function(t))
        };
        let Ok(whole) = Integral::over(&mut counted, 0.0, 1.0);
        let Ok(value) = whole.refined(&mut counted, accuracy, 0.0);
        (value, evaluations)
    }

    #[test]
    fn a_function_that_turns_many_times_is_followed() {
        for turns in [0.7, 3.0, 20.3, 50.0] {
            let (value, _) = integral(|t| (turns * t).sin() + 1.0, 1e-12);
            let exact = (1.0 - f64::cos(turns)) / turns + 1.0;
            assert!((value - exact).abs() < 1e-12, "{turns}: {value} {exact}");
        }
    }

    /// Near a singular configuration accelerations have fewer digits than asked for.
    #[test]
    fn noise_beside_a_smooth_function_is_not_followed() {
        let noisy = |t: f64| (3.0 * t).sin() + 1e-9 * (1e9 * t).sin();
        let (value, evaluations) = integral(noisy, 1e-12);
        let exact = (1.0 - f64::cos(3.0)) / 3.0;
        assert!((value - exact).abs() < 1e-9, "{value} {exact}");
        assert!(evaluations < 200, "{evaluations}");
    }

    #[test]
    fn a_function_that_is_round_off_is_not_followed_into_ever_shorter_parts() {
        let mut random = Random::seeded(7);
        let mut evaluations = 0_u32;
        let mut noise = |_| {
            evaluations += 1;
            Ok::<_, Infallible>(random.within(1e-32))
        };
        let Ok(whole) = Integral::over(&mut noise, 0.0, 1.0);
        let Ok(value) = whole.refined(&mut noise, 1e-9, 0.0);
        assert!(value.abs() < 1e-32, "{value}");
        // Four nodes on each half of what is bisected, of which one more is left as it is.
        assert!(evaluations <= 4 + 8 * (2 * MOST + 1), "{evaluations}");
    }
}
