//! How far coordinates reach, and over what distance constraints change, in one metric.
//!
//! In:  coordinates of accepted states, the metric of the kinetic energy.
//! Out: [`CoordinateScale`], in which round-off and differences of positions are measured.
//!
//! Both are the same until an angle has gone round: its round-off grows with every turn,
//! what depends on it does not.

use super::Core;
use crate::linalg::length;
use crate::{Mechanism, Real, State, Structure};
use core::f64::consts::TAU;
use nalgebra::SMatrix;

/// By which factor a coordinate grows before the length of the coordinates is measured
/// again: round-off is needed to no more digits.
const SCALE_STEP: f64 = 1.125;

/// Lengths in the metric of the kinetic energy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct CoordinateScale<T> {
    /// The largest length of the coordinates so far: what their round-off is relative to.
    pub(crate) size: T,
    /// The same where angles of many turns count as one turn: constraints change over a
    /// distance of about this length.
    pub(crate) range: T,
}

impl<T: Real> CoordinateScale<T> {
    /// How many times larger round-off, and the error of a step that is relative to the
    /// coordinates, are for the turns that angles have made.
    pub(crate) fn turns(&self) -> T {
        self.size / self.range
    }

    /// Takes note of coordinates `q`, which are used up, and up to which sizes none is looked
    /// at again; `turns` tells which of them are angles that have gone round. Functions of an
    /// angle have the round-off of an angle of one, however small it is.
    fn extend(
        &mut self,
        structure: &Structure,
        factor: &[T],
        q: &mut [T],
        (sizes, weights): (&mut [T], &mut [T]),
        turns: &[bool],
    ) {
        let moved = weights.iter().any(|weight| *weight > T::zero());
        let lengths = q.len().saturating_sub(structure.states);
        // Integrals of states are no lengths.
        q[lengths..].fill(T::zero());
        sizes[lengths..].fill(T::from_f64(f64::INFINITY));
        for (size, coordinate) in q.iter_mut().zip(structure.freedoms()) {
            *size = size.abs();
            if coordinate.may_be_angle() {
                *size = size.max(T::one());
            }
        }
        for ((known, weight), size) in sizes.iter_mut().zip(weights).zip(&*q) {
            *known = known.max(*size * T::from_f64(SCALE_STEP));
            if *known > T::zero() {
                *weight = T::one() / (*known * *known);
            }
        }
        let mut size = length(factor, q);
        if size == T::zero() {
            // Where all are lengths of zero, one unit stands for them until they move.
            q.fill(T::one());
            size = length(factor, q);
        }
        for (range, turns) in q.iter_mut().zip(turns) {
            if *turns {
                *range = range.min(T::from_f64(TAU));
            }
        }
        let range = length(factor, q);
        *self = match moved {
            true => Self {
                size: self.size.max(size),
                range: self.range.max(range),
            },
            false => Self { size, range },
        };
    }
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Takes note of the length of the coordinates in the metric, where one of them is
    /// larger than it was.
    #[inline]
    pub(crate) fn observe_coordinate_scale(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) {
        let [q] = &state.q.data.0;
        let sizes = q.iter().zip(&self.sizes);
        if sizes.fold(false, |any, (q, size)| any | (q.abs() > *size)) {
            self.extend_coordinate_scale(mechanism, state);
        }
    }

    /// Measures that length.
    #[inline(never)]
    fn extend_coordinate_scale(&mut self, mechanism: &dyn Mechanism<T, N, R>, state: &State<T, N>) {
        let turns = self.turns(mechanism, state);
        let [mut q] = state.q.data.0;
        self.coordinate_scale.extend(
            mechanism.structure(),
            self.metric.factor.as_slice(),
            &mut q,
            (&mut self.sizes, &mut self.weights),
            &turns,
        );
    }

    /// Which coordinates are beyond a turn, and leave the constraint rows as they are when
    /// they go back by one: angles, and coordinates on which the rows do not depend.
    fn turns(&mut self, mechanism: &dyn Mechanism<T, N, R>, state: &State<T, N>) -> [bool; N] {
        let turn = T::from_f64(TAU);
        let is_beyond = |q: &T| q.abs() > turn;
        let mut turns = [false; N];
        if !state.q.iter().any(is_beyond) {
            return turns;
        }
        mechanism.position(state, &mut self.position);
        let here = self.position.jacobian;
        for j in (0..N).filter(|&j| is_beyond(&state.q[j])) {
            let mut back = *state;
            back.q[j] -= turn * state.q[j].sign();
            mechanism.position(&back, &mut self.position);
            turns[j] = are_alike(&here, &self.position.jacobian);
        }
        mechanism.position(state, &mut self.position);
        turns
    }
}

/// Whether two Jacobians are the same to half of the digits.
fn are_alike<T: Real, const N: usize, const R: usize>(
    one: &SMatrix<T, R, N>,
    other: &SMatrix<T, R, N>,
) -> bool {
    let most = one
        .iter()
        .fold(T::zero(), |most: T, entry| most.max(entry.abs()));
    let mut pairs = one.iter().zip(other);
    pairs.all(|(one, other)| (*one - *other).abs() <= most * T::EPSILON.sqrt())
}
