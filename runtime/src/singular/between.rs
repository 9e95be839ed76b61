//! How many sheets are crossed between two states.
//!
//! In:  the ends of a step, a [`Sheet`].
//! Out: whether the step stays on its sheet, or else where it leaves it.
//!
//! Not here: when exactly sheets cross ([`super::passage`]).

use super::sheet::Sheet;
use crate::Real;
use crate::equations::At;
use crate::linalg::Workspace;

/// Parts of a step at whose ends redundant rows are looked at.
const LOOKS: usize = 4;
/// Halvings of a step in the search for a singular configuration.
const BISECTIONS: usize = 20;

impl<T: Real> Sheet<'_, T> {
    /// Counts the sheets crossed on the way from one state to another, `None` where that
    /// can't be told. If it is sought, also the fraction of the way up to which no crossing
    /// is seen.
    pub(super) fn crossed(
        &mut self,
        (start, end): (At<'_, T>, At<'_, T>),
        seeks: bool,
        workspace: &Workspace<'_, T>,
    ) -> (Option<usize>, T) {
        workspace.scope(|workspace| {
            let reference = self.reference(start.t, start.q, workspace);
            let mut changes_at = |there: At<'_, T>| {
                let reference = reference.as_ref()?;
                self.sign_changes(reference, there, workspace)
            };
            let changes = changes_at(end);
            let (mut before, mut after) = (T::zero(), T::one());
            if !seeks || changes == Some(0) {
                return (changes, after);
            }
            let q = workspace.numbers(start.q.len());
            for _ in 0..BISECTIONS {
                let middle = (before + after) * T::from_f64(0.5);
                let t = start.towards(end, middle, q);
                match changes_at(At { t, q, v: end.v }) {
                    Some(0) => before = middle,
                    _ => after = middle,
                }
            }
            (changes, after)
        })
    }

    /// Whether no sheet is seen to be crossed on the way from one state to another, at the ends of
    /// so many parts of it.
    pub(super) fn stays(
        &mut self,
        (start, end): (At<'_, T>, At<'_, T>),
        looks: usize,
        workspace: &Workspace<'_, T>,
    ) -> bool {
        workspace.scope(|workspace| {
            let q = workspace.numbers(start.q.len());
            let at =
                |k: usize, q: &mut [T]| start.towards(end, T::from_f64(k as f64 / looks as f64), q);
            let Some(nearest) = self.nearest(looks + 1, &at, q) else {
                return false;
            };
            let v = end.v;
            let t = at(nearest, q);
            let Some(reference) = self.reference(t, q, workspace) else {
                return false;
            };
            (0..=looks).filter(|k| *k != nearest).all(|k| {
                let t = at(k, q);
                let changes = self.sign_changes(&reference, At { t, q, v }, workspace);
                changes == Some(0) && !self.chose_poorly(workspace)
            })
        })
    }

    /// Whether other rows are far more independent than the chosen ones on the way from one state
    /// to another.
    pub(super) fn chose_poorly_between(
        &mut self,
        (start, end): (At<'_, T>, At<'_, T>),
        workspace: &Workspace<'_, T>,
    ) -> bool {
        workspace.scope(|workspace| {
            let q = workspace.numbers(start.q.len());
            (1..=LOOKS).any(|k| {
                let t = start.towards(end, T::from_f64(k as f64 / LOOKS as f64), q);
                self.equations.locate(t, q);
                self.chose_poorly(workspace)
            })
        })
    }
}
