//! What changes its sign where sheets cross.
//!
//! In:  eliminations at two states of a step.
//! Out: how many sheets were crossed on the way from one to the other.

use super::sheet::Sheet;
use crate::Real;
use crate::equations::At;
use crate::linalg::{Block, Eliminated, Frame, Workspace};

/// What changes its sign where sheets cross.
pub(super) struct DeterminantSigns<'a, T> {
    block: Block<'a, T>,
    /// Whether the determinant of the whole system is negative.
    pub(super) negative: bool,
}

impl<'a, T: Real> DeterminantSigns<'a, T> {
    pub(super) fn of(frame: &mut Frame<'_, T>, workspace: &Workspace<'a, T>) -> Self {
        Self {
            block: frame.block().copy(workspace),
            negative: frame.is_negative(),
        }
    }

    /// How many sheets were crossed on the way from the state of other signs. Blocks count them,
    /// and determinants tell whether their number is odd. A block also changes its sign where one
    /// of the rows before it loses its pivot, which is no crossing by itself, and may hide one:
    /// then the number is at least one less.
    pub(super) fn changes_from(
        &self,
        other: &DeterminantSigns<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> usize {
        let changes = self.block.sign_changes_from(&other.block, workspace);
        let odd = self.negative != other.negative;
        match (changes % 2 == 1) == odd {
            true => changes,
            false => changes.checked_sub(1).unwrap_or(1),
        }
    }
}

/// A state of a step: the order of elimination for all of its states, and the signs there.
pub(crate) struct Reference<'a, T> {
    pub(super) like: Eliminated<'a, T>,
    pub(super) signs: DeterminantSigns<'a, T>,
}

impl<T: Real> Sheet<'_, T> {
    /// Which of `count` positions is nearest to a singular configuration. Its order of elimination
    /// serves all of them: its small pivots come last, in one block, so that every change of sign
    /// on the way is one of the block. An order from a regular position may leave two such rows out
    /// of the block. `None` where the constraints can't be eliminated at one of them.
    pub(super) fn nearest(
        &mut self,
        count: usize,
        at: &dyn Fn(usize, &mut [T]) -> T,
        q: &mut [T],
    ) -> Option<usize> {
        let (mut nearest, mut least) = (0, T::one());
        for k in 0..count {
            let t = at(k, q);
            self.eliminate_widely(t, q).ok()?;
            if self.frame.smallest() < least {
                (nearest, least) = (k, self.frame.smallest());
            }
        }
        Some(nearest)
    }

    /// What other states of a step are compared with; `None` where the constraints can't be
    /// eliminated.
    pub(super) fn reference<'b>(
        &mut self,
        t: T,
        q: &[T],
        workspace: &Workspace<'b, T>,
    ) -> Option<Reference<'b, T>> {
        self.eliminate_widely(t, q).ok()?;
        Some(Reference {
            like: self.frame.eliminated(workspace),
            signs: DeterminantSigns::of(&mut self.frame, workspace),
        })
    }

    /// How many sheets are crossed on the way to a state; `None` where that can't be told.
    pub(super) fn sign_changes(
        &mut self,
        from: &Reference<'_, T>,
        to: At<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Option<usize> {
        self.eliminate((to.t, to.q), Some(&from.like)).ok()?;
        Some(workspace.scope(|workspace| {
            let there = DeterminantSigns::of(&mut self.frame, workspace);
            there.changes_from(&from.signs, workspace)
        }))
    }
}
