//! The nodes that are stored of an interpolation.
//!
//! Out: [`Nodes`], which [`super::node_reuse`] writes and reads.

use crate::Real;

/// Nodes on each side of a singular configuration.
pub(super) const SIDE: usize = 5;
/// Nodes on both.
pub(super) const NODES: usize = 2 * SIDE;

/// The nodes of the last interpolation on a curve.
#[derive(Clone, Debug)]
pub(crate) struct Nodes<T, const N: usize> {
    /// Of each node the position, the tangent, and the acceleration that the constraints
    /// demand of a motion with the velocity of the tangent.
    points: [[[T; N]; 3]; NODES],
    quality: Quality<T>,
}

/// How well the nodes serve.
#[derive(Clone, Debug)]
pub(super) struct Quality<T> {
    /// How the round-off of each is magnified.
    pub(super) noise: [T; NODES],
    /// Their spacing, as a change of the sine; that of the last interpolation, also where its
    /// nodes are not kept.
    pub(super) spacing: T,
    /// How fast the sine changes along the curve.
    pub(super) rate: T,
    /// How well they resolved the sheet where they were found.
    pub(super) score: T,
    pub(super) known: bool,
}

/// The nodes over slices.
#[derive(Debug)]
pub(crate) struct NodesView<'a, T> {
    /// Of each node three vectors, one after the other.
    pub(super) points: &'a mut [T],
    pub(super) quality: &'a mut Quality<T>,
}

impl<T: Real, const N: usize> Nodes<T, N> {
    pub(crate) fn new() -> Self {
        Self {
            points: [[[T::zero(); N]; 3]; NODES],
            quality: Quality {
                noise: [T::zero(); NODES],
                spacing: T::zero(),
                rate: T::zero(),
                score: T::zero(),
                known: false,
            },
        }
    }

    pub(crate) fn forget(&mut self) {
        self.quality.known = false;
    }

    pub(super) fn view(&mut self) -> NodesView<'_, T> {
        NodesView {
            points: self.points.as_flattened_mut().as_flattened_mut(),
            quality: &mut self.quality,
        }
    }
}
