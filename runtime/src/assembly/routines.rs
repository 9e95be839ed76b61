//! What assembles states of mechanisms of all sizes.
//!
//! Out: [`Routines`], which are part of the table of a scalar.

use super::draft::{Draft, Refusal};
use super::{inertia, position, velocity};
use crate::Real;
use crate::equations::Equations;
use crate::linalg::{Breakdown, Workspace};

pub(super) type Assemble<T> =
    fn(&mut dyn Equations<T>, Draft<'_, T>, &Workspace<'_, T>) -> Result<(), Refusal>;
type Negative<T> = fn(&[T], usize, &Workspace<'_, T>) -> Result<Option<usize>, Breakdown>;

/// The routines of a scalar.
#[derive(Debug)]
pub(crate) struct Routines<T> {
    /// Moves the coordinates that are not held onto the constraints.
    pub(super) positions: Assemble<T>,
    /// Moves the velocities that are not held onto the constraints.
    pub(super) velocities: Assemble<T>,
    /// The coordinate that makes the kinetic energy negative, if it can be.
    pub(super) negative: Negative<T>,
}

impl<T: Real> Routines<T> {
    pub(crate) const fn new() -> Self {
        Self {
            positions: position::assemble,
            velocities: velocity::assemble,
            negative: inertia::negative,
        }
    }
}
