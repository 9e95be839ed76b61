//! How far coordinates reach, and over what distance constraints change, in one metric.
//!
//! In:  coordinates of accepted states, the metric of the kinetic energy.
//! Out: [`CoordinateScale`], in which round-off and differences of positions are measured.
//!
//! Both are the same until an angle has gone round: its round-off grows with every turn,
//! what depends on it does not.

use crate::linalg::length;
use crate::natural_size::{Kind, NaturalSizes};
use crate::{Real, Structure};
use core::f64::consts::TAU;

/// By which factor a coordinate grows before the length of the coordinates is measured
/// again: round-off is needed to no more digits.
const SCALE_STEP: f64 = 1.125;

/// Lengths in the metric of the kinetic energy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct CoordinateScale<T> {
    /// The largest length of the coordinates so far: what their round-off is relative to.
    pub(crate) size: T,
    /// The largest length of the coordinates so far, where angles of many turns count as one turn:
    /// constraints change over a distance of about this length, or of the limit, if that is less.
    pub(crate) range: T,
    /// The range without a limit.
    pub(super) unlimited: T,
    /// The limit of the range; zero where it is not known.
    limit: T,
}

impl<T: Real> CoordinateScale<T> {
    /// How many times larger round-off, and the error of a step that is relative to the
    /// coordinates, are for the turns that angles have made.
    pub(crate) fn turns(&self) -> T {
        self.size / self.range
    }

    /// Whether the range is that of its limit.
    pub(super) fn is_limited(&self) -> bool {
        self.range < self.unlimited
    }

    /// Limits the range, where constraints are known to change over a shorter distance. It does
    /// not become shorter than it was.
    pub(super) fn limit(&mut self, most: T) {
        self.limit = self.limit.max(most);
        self.range = self.unlimited.min(self.limit);
    }

    /// Takes note of coordinates `q`, which are used up, and sets the `sizes` up to which they are
    /// not looked at again; `turns` tells which of them are angles that have gone round. Functions
    /// of an angle have at least the round-off of an angle of one.
    pub(super) fn extend(
        &mut self,
        structure: &Structure,
        factor: &[T],
        q: &mut [T],
        sizes: &mut [T],
        turns: &[bool],
    ) {
        let lengths = q.len().saturating_sub(structure.states);
        let moved = sizes[..lengths].iter().any(|size| *size > T::zero());
        // Integrals of states are no lengths.
        q[lengths..].fill(T::zero());
        sizes[lengths..].fill(T::from_f64(f64::INFINITY));
        let natural = NaturalSizes::measure(structure, &q[..lengths]);
        for (coordinate, size) in q[..lengths].iter_mut().enumerate() {
            *size = size.abs();
            let least = match structure.kind(coordinate) {
                Some(kind @ (Kind::Angle | Kind::Unknown)) => natural.of(kind),
                Some(Kind::Ratio | Kind::Length) | None => None,
            };
            *size = size.max(least.unwrap_or_default());
        }
        for (known, size) in sizes.iter_mut().zip(&*q) {
            *known = known.max(*size * T::from_f64(SCALE_STEP));
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
        let mut range = length(factor, q);
        if moved {
            (size, range) = (self.size.max(size), self.unlimited.max(range));
        }
        let limit = self.limit;
        *self = Self {
            size,
            range: match limit > T::zero() {
                true => range.min(limit),
                false => range,
            },
            unlimited: range,
            limit,
        };
    }
}
