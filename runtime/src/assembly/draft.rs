//! A state that is being assembled, over slices.
//!
//! In:  a start, which of its values are held.
//! Out: [`Draft`], and why it can't be finished ([`Refusal`]).

use crate::equations::Equations;
use crate::linalg::{Breakdown, Workspace};

/// What moves a draft onto the constraints.
pub(super) type Assemble<T> =
    fn(&mut dyn Equations<T>, Draft<'_, T>, &Workspace<'_, T>) -> Result<(), Refusal>;

/// A state that is being assembled.
#[derive(Debug)]
pub(crate) struct Draft<'a, T> {
    /// Time (s).
    pub(super) t: T,
    pub(super) q: &'a mut [T],
    pub(super) v: &'a mut [T],
    /// Which coordinates are held, or which velocities.
    pub(super) held: &'a [bool],
    /// The error of each equation where there is a contradiction.
    pub(super) residual: &'a mut [T],
    /// Which held values stand in the way where there is a contradiction.
    pub(super) conflicting: &'a mut [bool],
    /// Whether constraints that are independent nearly depend on one another.
    pub(super) near_singular: &'a mut bool,
}

/// Why no consistent state could be found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Refusal {
    /// Something is infinite or NaN.
    NotFinite,
    /// No position near the guesses satisfies the constraints; their errors are in the draft.
    Positions,
    /// No velocity satisfies the constraints; their errors are in the draft.
    Velocities,
    /// No branch through the singular position has the held velocities.
    NoBranch,
    /// Several branches have the held velocities, and the guesses are equally near to these
    /// branches. This velocity, for one, tells them apart; its value on one of them is in the
    /// draft.
    ManyBranches(usize),
    /// This equation has no gradient where it holds.
    Vanishing(usize),
}

impl From<Breakdown> for Refusal {
    fn from(Breakdown: Breakdown) -> Self {
        Self::NotFinite
    }
}
