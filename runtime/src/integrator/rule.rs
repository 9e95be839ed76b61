//! From accelerations of the stages of an implicit step to their states.
//!
//! In:  coefficients of a method with `S` stages, the length of a step, accelerations.
//! Out: coordinates and velocities of the stages.
//!
//! The number of stages is known where this is compiled, of coordinates it is data: sums
//! over stages are written out, and one pass over the coordinates does for all stages, since
//! passes over short vectors cost more than their products.

use super::collocation::{Collocation, MOST_STAGES, by_stage, weigh};
use crate::Real;
use crate::equations::At;
use crate::linalg::{column, scaled};
use crate::once::compiled_once;

/// `v_i = v₀ + h Σ A_ij a_j` and `q_i = q₀ + h (c_i v₀ + Σ h (A²)_ij a_j)` of a method with `S`
/// stages.
pub(super) struct Rule<T, const S: usize> {
    /// `h`.
    pub(super) h: T,
    /// `c_i`.
    pub(super) nodes: [T; S],
    /// `A`.
    matrix: [[T; MOST_STAGES]; S],
    /// `h A²`.
    square: [[T; MOST_STAGES]; S],
}

impl<T: Real, const S: usize> Rule<T, S> {
    #[inline(always)]
    pub(super) fn new(coefficients: &Collocation<T>, h: T) -> Self {
        let zero = [T::zero(); MOST_STAGES];
        let (mut matrix, mut square) = ([zero; S], [zero; S]);
        for i in 0..S {
            matrix[i] = coefficients.matrix[i];
            square[i] = scaled(h, &coefficients.square[i]);
        }
        Self {
            h,
            nodes: column(|i| coefficients.nodes[i]),
            matrix,
            square,
        }
    }

    /// One coordinate of stage `i` and its velocity, from those at the start and the accelerations
    /// of all stages.
    #[inline(always)]
    pub(super) fn state(&self, i: usize, (q, v): (T, T), a: &[T; S]) -> (T, T) {
        let moved = weigh(&self.square[i], a, self.nodes[i] * v);
        let faster = weigh(&self.matrix[i], a, T::zero());
        (self.h.mul_add(moved, q), self.h.mul_add(faster, v))
    }

    /// Writes the states of all stages.
    #[inline(always)]
    pub(super) fn set_states(&self, start: At<'_, T>, a: &[T], (q, v): (&mut [T], &mut [T])) {
        let n = start.q.len();
        let (start_q, start_v) = (&start.q[..n], &start.v[..n]);
        let a = by_stage::<T, S>(a, n);
        let (q, v) = (by_stage_mut::<T, S>(q, n), by_stage_mut::<T, S>(v, n));
        for k in 0..n {
            let a = column(|j| a[j][k]);
            for i in 0..S {
                (q[i][k], v[i][k]) = self.state(i, (start_q[k], start_v[k]), &a);
            }
        }
    }
}

/// The vectors of `S` stages, which are one after the other, to be changed.
#[inline(always)]
pub(super) fn by_stage_mut<T, const S: usize>(vectors: &mut [T], n: usize) -> [&mut [T]; S] {
    let mut rest = vectors;
    [(); S].map(|()| {
        let (stage, others) = core::mem::take(&mut rest).split_at_mut(n);
        rest = others;
        stage
    })
}

compiled_once! {
    /// [`Rule::set_states`] for a step of some length.
    pub(super) fn setting_states<T>: fn(
        &Collocation<T>,
        At<'_, T>,
        &[T],
        T,
        (&mut [T], &mut [T]),
    ) = |coefficients, start, a, h, out| match coefficients.stages {
        3 => Rule::<_, 3>::new(coefficients, h).set_states(start, a, out),
        _ => Rule::<_, 5>::new(coefficients, h).set_states(start, a, out),
    };
}
