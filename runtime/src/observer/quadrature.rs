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
    /// what is smaller than `least` is left as it is.
    pub(super) fn refined<E>(
        &self,
        function: Function<'_, T, E>,
        accuracy: T,
        least: T,
    ) -> Result<T, E> {
        self.bisected(function, (accuracy, least), DEEPEST, &mut { MOST })
    }

    #[inline(never)]
    fn bisected<E>(
        &self,
        function: Function<'_, T, E>,
        limits: (T, T),
        depth: u32,
        most: &mut u32,
    ) -> Result<T, E> {
        let half = self.length * T::from_f64(0.5);
        let first = Self::over(function, self.start, half)?;
        let second = Self::over(function, self.start + half, half)?;
        let (sum, size) = (first.value + second.value, first.size.max(second.size));
        let (accuracy, least) = limits;
        let differs = size > least && (sum - self.value).abs() > accuracy * size;
        if !differs || depth == 0 || *most == 0 {
            return Ok(sum);
        }
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
