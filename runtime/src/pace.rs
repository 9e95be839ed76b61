//! How long steps have been of late.
//!
//! In:  the lengths of steps, one after another.
//! Out: the longest of late, which short ones between long ones hardly change.

use crate::Real;

/// The longest step of late.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace<T> {
    longest: T,
}

impl<T: Real> Pace<T> {
    /// No step yet.
    pub(crate) fn new() -> Self {
        Self { longest: T::zero() }
    }

    /// The longest step of late (s); zero before the first.
    pub(crate) fn longest(self) -> T {
        self.longest
    }

    /// Takes note of a step, and returns the share that it leaves of whatever is known from
    /// before: half after a step as long as those of late, nearly all after a short one.
    pub(crate) fn observe(&mut self, length: T) -> T {
        if self.longest > T::zero() {
            self.longest *= self.longest / (self.longest + length);
        }
        self.longest = self.longest.max(length);
        match self.longest > T::zero() {
            true => self.longest / (self.longest + length),
            false => T::one(),
        }
    }
}
