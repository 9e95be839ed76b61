//! What positions and velocities are assembled in.
//!
//! Out: buffers, one of each kind.

use super::decomposition::Decomposition;
use crate::{Position, Real};

/// One for positions and velocities, since it takes a good part of the stack where a
/// mechanism is large.
pub(super) struct Room<T, const N: usize, const R: usize> {
    pub(super) at: Position<T, N, R>,
    pub(super) matrix: Decomposition<T, N, R>,
}

impl<T: Real, const N: usize, const R: usize> Default for Room<T, N, R> {
    fn default() -> Self {
        Self {
            at: Position::default(),
            matrix: Decomposition::default(),
        }
    }
}
