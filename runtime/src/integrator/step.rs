//! One accepted step, and the state at any time within it.
//!
//! In:  what an integrator did.
//! Out: [`Step`].

use super::interpolant::Interpolant;
use crate::{Real, State};
use nalgebra::SVector;

/// An accepted step of an integrator.
///
/// Both ends satisfy the constraints to round-off if the system projects.
#[derive(Clone, Debug)]
pub struct Step<T, const N: usize> {
    pub(crate) start: State<T, N>,
    pub(crate) end: State<T, N>,
    pub(crate) rejected: u32,
    pub(crate) evaluations: u32,
    /// The length of the step as it was integrated: longer than from start to
    /// end if it was cut.
    pub(crate) span: T,
    pub(crate) interpolant: Interpolant<T, N>,
}

impl<T: Real, const N: usize> Step<T, N> {
    pub(crate) fn new() -> Self {
        let (start, end) = (State::default(), State::default());
        Self {
            start,
            end,
            rejected: 0,
            evaluations: 0,
            span: T::zero(),
            interpolant: Interpolant::default(),
        }
    }

    /// The state from which the step was made.
    pub fn start(&self) -> &State<T, N> {
        &self.start
    }

    /// The state to which it led, back on the constraints.
    pub fn end(&self) -> &State<T, N> {
        &self.end
    }

    /// Its length (s).
    pub fn length(&self) -> T {
        self.end.t - self.start.t
    }

    /// Trial steps that were thrown away before this one was accepted.
    pub fn rejected(&self) -> u32 {
        self.rejected
    }

    /// Accelerations that were computed for it, those of rejected trials
    /// included.
    pub fn evaluations(&self) -> u32 {
        self.evaluations
    }

    /// Joins both ends, given the accelerations there; the length of the step.
    pub(super) fn set_ends(&mut self, first: &SVector<T, N>, last: &SVector<T, N>) -> T {
        self.span = self.length();
        self.interpolant
            .set_ends((&self.start, first), (&self.end, last));
        self.span
    }

    /// Joins both ends through states between, at fractions of the step, whose coordinates
    /// and velocities are used up.
    pub(super) fn set_stages(&mut self, nodes: &[T], states: (&mut [T], &mut [T])) {
        self.span = self.length();
        self.interpolant
            .set_stages((&self.start, &self.end), nodes, states);
    }

    /// This step up to an earlier end.
    pub(crate) fn cut(&self, end: State<T, N>) -> Self {
        Self {
            end,
            ..self.clone()
        }
    }

    /// The state at a time within the step, from the method's interpolant if it is kept,
    /// else from the cubic polynomial through both ends.
    pub(crate) fn inside_at(&self, t: T) -> State<T, N> {
        if self.span > T::zero() || t <= self.start.t || t >= self.end.t {
            return self.at(t);
        }
        self.start
            .towards(&self.end, (t - self.start.t) / self.length())
    }

    /// The state at a time within the step, from the method's interpolant; the
    /// ends themselves at and beyond the ends.
    ///
    /// The interpolated state satisfies the constraints as accurately as the
    /// interpolant follows the motion; project it where that isn't enough.
    pub fn at(&self, t: T) -> State<T, N> {
        if t <= self.start.t || self.span <= T::zero() {
            return self.start;
        }
        if t >= self.end.t {
            return self.end;
        }
        let (q, v) = self.interpolant.at((t - self.start.t) / self.span);
        State { t, q, v }
    }
}
