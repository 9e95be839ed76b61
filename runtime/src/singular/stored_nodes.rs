//! The nodes that are stored of an interpolation.
//!
//! Out: [`Nodes`], which [`super::node_reuse`] writes and reads.

use crate::Real;
use core::ops::Range;

/// Nodes on each side of a singular configuration.
pub(super) const SIDE: usize = 5;
/// Nodes on both.
pub(super) const NODES: usize = 2 * SIDE;

/// The nodes of the last interpolation on the curve of each part.
#[derive(Clone, Debug)]
pub(crate) struct Nodes<T, const N: usize> {
    /// Of each part and node the position, the tangent, and the acceleration that the
    /// constraints demand of a motion with the velocity of the tangent.
    points: [[[T; N]; 3]; NODES],
    qualities: [Quality<T>; N],
    /// Whether those of any part are known.
    any: bool,
}

/// How well the nodes of a part serve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quality<T> {
    /// How the round-off of each node is magnified.
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

/// The nodes of all parts over slices.
#[derive(Debug)]
pub(crate) struct NodesSlices<'a, T> {
    points: &'a mut [T],
    qualities: &'a mut [Quality<T>],
    any: &'a mut bool,
}

impl<T> NodesSlices<'_, T> {
    /// Those of a part.
    pub(super) fn of(&mut self, index: usize, coordinates: Range<usize>) -> NodesView<'_, T> {
        const EACH: usize = 3 * NODES;
        NodesView {
            points: &mut self.points[EACH * coordinates.start..EACH * coordinates.end],
            quality: &mut self.qualities[index],
            any: self.any,
        }
    }
}

/// The nodes of a part over slices.
#[derive(Debug)]
pub(super) struct NodesView<'a, T> {
    /// Of each node three vectors, one after the other.
    pub(super) points: &'a mut [T],
    pub(super) quality: &'a mut Quality<T>,
    any: &'a mut bool,
}

impl<T> NodesView<'_, T> {
    /// Takes note that they are known.
    pub(super) fn set_known(&mut self) {
        self.quality.known = true;
        *self.any = true;
    }
}

impl<T: Real, const N: usize> Nodes<T, N> {
    pub(crate) fn new() -> Self {
        let quality = Quality {
            noise: [T::zero(); NODES],
            spacing: T::zero(),
            rate: T::zero(),
            score: T::zero(),
            known: false,
        };
        Self {
            points: [[[T::zero(); N]; 3]; NODES],
            qualities: [quality; N],
            any: false,
        }
    }

    pub(crate) fn forget(&mut self) {
        // Asked for often, and mostly none is known.
        if core::mem::take(&mut self.any) {
            for quality in &mut self.qualities {
                quality.known = false;
            }
        }
    }

    pub(super) fn slices(&mut self) -> NodesSlices<'_, T> {
        NodesSlices {
            points: self.points.as_flattened_mut().as_flattened_mut(),
            qualities: &mut self.qualities,
            any: &mut self.any,
        }
    }
}
