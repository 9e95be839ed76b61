//! The memory in which sheets are evaluated.
//!
//! Out: a [`Workspace`] for a mechanism with `N` coordinates.
//!
//! That of small mechanisms is part of their solver. Large ones, with the standard library,
//! take theirs from the heap, once: when they first come near a singular configuration,
//! which many never do.

use crate::Real;
use crate::linalg::Workspace;

/// Square matrices of all coordinates that there is room for. A sheet takes two for its
/// frame, and others as the block of near-dependent rows is large: fourteen to interpolate,
/// and one for each look into a step, of which there may be forty.
const MATRICES: usize = 64;
/// Vectors of all coordinates that there is room for, of which an interpolation takes 250:
/// with the standard library the matrices of small mechanisms among them.
const VECTORS: usize = 288
    + if cfg!(feature = "std") {
        SMALL * MATRICES
    } else {
        0
    };
/// Lists of indices.
const LISTS: usize = 16;
/// Coordinates up to which a mechanism is small.
const SMALL: usize = 8;

/// The matrices of large mechanisms.
#[cfg(feature = "std")]
type Matrices<T, const N: usize> = Vec<T>;
#[cfg(not(feature = "std"))]
type Matrices<T, const N: usize> = [[[T; N]; N]; MATRICES];

/// Memory for a mechanism with `N` coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Memory<T, const N: usize> {
    vectors: [[T; N]; VECTORS],
    matrices: Matrices<T, N>,
    indices: [[usize; N]; LISTS],
}

impl<T: Real, const N: usize> Memory<T, N> {
    pub(crate) fn new() -> Self {
        Self {
            vectors: [[T::zero(); N]; VECTORS],
            #[cfg(feature = "std")]
            matrices: Vec::new(),
            #[cfg(not(feature = "std"))]
            matrices: [[[T::zero(); N]; N]; MATRICES],
            indices: [[0; N]; LISTS],
        }
    }

    /// All of it.
    pub(crate) fn workspace(&mut self) -> Workspace<'_, T> {
        #[cfg(feature = "std")]
        if N > SMALL && self.matrices.is_empty() {
            // Of zeros, which the system gives without a page being touched.
            self.matrices = vec![T::zero(); MATRICES * N * N];
        }
        #[cfg(feature = "std")]
        let matrices = &mut self.matrices;
        #[cfg(not(feature = "std"))]
        let matrices = self.matrices.as_flattened_mut().as_flattened_mut();
        let vectors = self.vectors.as_flattened_mut();
        Workspace::new(vectors, matrices, self.indices.as_flattened_mut())
    }
}
