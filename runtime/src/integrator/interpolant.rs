//! The state at any time within a step.
//!
//! In:  the two ends of an accepted step with their accelerations, and what the
//!      method knows about the inside.
//! Out: [`Interpolant`], a polynomial for `q` and one for `q̇`.
//!
//! With `θ` the fraction of the step, both polynomials are written as
//! `c₀ + θ(c₁ + (1−θ)(c₂ + θ(c₃ + (1−θ)(c₄ + …))))`. The first four coefficients
//! are those of the cubic through both ends with the derivatives there, so that
//! consecutive steps join with continuous derivatives, also where the end was
//! moved back onto the constraints.
//!
//! Source: Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I
//! (1993), section II.6.

use super::collocation::cardinal;
use crate::linalg::add_scaled;
use crate::once::compiled_once;
use crate::{Real, State};
use nalgebra::SVector;

/// Number of coefficients of the longest interpolant, that of DOP853.
pub(crate) const COEFFICIENTS: usize = 8;

/// Most stages of an implicit method inside of a step.
const MOST_BETWEEN: usize = 4;

/// The polynomials of one step.
#[derive(Clone, Debug)]
pub(crate) struct Interpolant<T, const N: usize> {
    q: [SVector<T, N>; COEFFICIENTS],
    v: [SVector<T, N>; COEFFICIENTS],
    used: usize,
}

impl<T: Real, const N: usize> Default for Interpolant<T, N> {
    fn default() -> Self {
        let zero = [SVector::zeros(); COEFFICIENTS];
        Self {
            q: zero,
            v: zero,
            used: 1,
        }
    }
}

impl<T: Real, const N: usize> Interpolant<T, N> {
    /// The cubic part: both ends of the step and the derivatives there.
    pub(crate) fn set_ends(
        &mut self,
        start: (&State<T, N>, &SVector<T, N>),
        end: (&State<T, N>, &SVector<T, N>),
    ) {
        let h = end.0.t - start.0.t;
        set_cubic(
            &mut self.q,
            h,
            (&start.0.q, &start.0.v),
            (&end.0.q, &end.0.v),
        );
        set_cubic(&mut self.v, h, (&start.0.v, start.1), (&end.0.v, end.1));
        self.used = 4;
    }

    /// The polynomials through both ends and up to [`MOST_BETWEEN`] states between, at
    /// fractions of the step, whose coordinates and velocities are used up.
    #[inline(never)]
    pub(crate) fn set_stages(
        &mut self,
        (start, end): (&State<T, N>, &State<T, N>),
        nodes: &[T],
        (q, v): (&mut [T], &mut [T]),
    ) {
        let mut out = [[T::zero(); N]; MOST_BETWEEN + 2];
        for (coefficients, ends, values) in [
            (&mut self.q, (&start.q, &end.q), q),
            (&mut self.v, (&start.v, &end.v), v),
        ] {
            let ends = (ends.0.as_slice(), ends.1.as_slice());
            through()(out.as_flattened_mut(), ends, nodes, values);
            for (coefficient, column) in coefficients.iter_mut().zip(out) {
                *coefficient = SVector::from(column);
            }
        }
        self.used = nodes.len() + 2;
    }

    /// Appends the next pair of coefficients.
    pub(crate) fn push(&mut self, q: SVector<T, N>, v: SVector<T, N>) {
        if self.used < COEFFICIENTS {
            self.q[self.used] = q;
            self.v[self.used] = v;
            self.used += 1;
        }
    }

    /// Raises the cubic for `q` to the quintic that has the accelerations of
    /// both ends; `q̇` keeps its cubic, which has them already. Errors `O(h⁶)`
    /// and `O(h⁴)`.
    ///
    /// The derivative of the quintic would be no better for `q̇`: it divides the
    /// error of the step's end by `h`.
    pub(crate) fn complete_hermite(&mut self, h: T, start: &SVector<T, N>, end: &SVector<T, N>) {
        let two = T::from_f64(2.0);
        let half_square = h * h / two;
        let fourth = start * half_square + self.q[2] - self.q[3];
        let fifth = end * half_square + self.q[2] + self.q[3] * two - fourth;
        self.push(fourth, SVector::zeros());
        self.push(fifth, SVector::zeros());
    }

    /// Coordinates and velocities at the fraction `theta` of the step.
    pub(crate) fn at(&self, theta: T) -> (SVector<T, N>, SVector<T, N>) {
        let rest = T::one() - theta;
        let last = self.used - 1;
        let (mut q, mut v) = (self.q[last], self.v[last]);
        for i in (0..last).rev() {
            let factor = if i % 2 == 0 { theta } else { rest };
            q = self.q[i] + q * factor;
            v = self.v[i] + v * factor;
        }
        (q, v)
    }
}

/// The polynomial through both ends and values between, one coefficient after the
/// other: each is what is left of the values at an end, which is then divided out.
pub(crate) fn set_through<T: Real>(
    out: &mut [T],
    (start, end): (&[T], &[T]),
    nodes: &[T],
    values: &mut [T],
) {
    let n = start.len();
    let (ends, out) = out.split_at_mut(2 * n);
    let (first, second) = ends.split_at_mut(n);
    first.copy_from_slice(start);
    second.copy_from_slice(end);
    add_scaled(second, -T::one(), start);
    for (j, theta) in nodes.iter().enumerate() {
        let values = &mut values[j * n..][..n];
        for ((value, start), slope) in values.iter_mut().zip(start).zip(&*second) {
            *value = ((*value - *start) / *theta - *slope) / (T::one() - *theta);
        }
    }
    for k in 0..nodes.len() {
        let at_end = k % 2 == 1;
        let place = if at_end { T::one() } else { T::zero() };
        let out = &mut out[k * n..][..n];
        out.fill(T::zero());
        for j in 0..nodes.len() {
            add_scaled(out, cardinal(nodes, j, place), &values[j * n..][..n]);
        }
        for (j, theta) in nodes.iter().enumerate() {
            let over = if at_end { T::one() - *theta } else { *theta };
            for (value, out) in values[j * n..][..n].iter_mut().zip(&*out) {
                *value = (*value - *out) / over;
            }
        }
    }
}

/// The cubic through both ends `(value, derivative)`.
fn set_cubic<T: Real, const N: usize>(
    out: &mut [SVector<T, N>; COEFFICIENTS],
    h: T,
    start: (&SVector<T, N>, &SVector<T, N>),
    end: (&SVector<T, N>, &SVector<T, N>),
) {
    let difference = end.0 - start.0;
    out[0] = *start.0;
    out[1] = difference;
    out[2] = start.1 * h - difference;
    out[3] = difference - end.1 * h - out[2];
}

compiled_once! {
    fn through<T>: fn(&mut [T], (&[T], &[T]), &[T], &mut [T]) = set_through;
}
