//! The nodes that are kept of an interpolation.
//!
//! Out: [`Nodes`], which [`super::recall`] writes and reads.

use crate::Real;
use nalgebra::SVector;

/// Nodes on each side of a singular configuration.
pub(super) const SIDE: usize = 5;
/// Nodes on both.
pub(super) const NODES: usize = 2 * SIDE;

/// The nodes of the last interpolation on a curve.
#[derive(Clone, Debug)]
pub(crate) struct Nodes<T, const N: usize> {
    /// Positions, tangents, and the accelerations that the constraints demand of a motion
    /// with the velocity of the tangent.
    pub(super) points: [[SVector<T, N>; 3]; NODES],
    /// How the round-off of each is magnified.
    pub(super) noise: [T; NODES],
    /// Their spacing, as a change of the sine.
    pub(super) spacing: T,
    /// How fast the sine changes along the curve.
    pub(super) rate: T,
    /// How well they resolved the sheet where they were found.
    pub(super) score: T,
    pub(super) known: bool,
}

impl<T: Real, const N: usize> Nodes<T, N> {
    pub(crate) fn new() -> Self {
        Self {
            points: [[SVector::zeros(); 3]; NODES],
            noise: [T::zero(); NODES],
            spacing: T::zero(),
            rate: T::zero(),
            score: T::zero(),
            known: false,
        }
    }

    pub(crate) fn forget(&mut self) {
        self.known = false;
    }
}
