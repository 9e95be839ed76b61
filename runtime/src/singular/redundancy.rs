//! Constraints of which some follow from the others.
//!
//! In:  the constraint rows where they were evaluated last.
//! Out: how many of them are independent, whichever these are; whether those that were chosen
//!      are about as independent as others.
//!
//! The rows that were chosen at an accepted state may become dependent where all of them
//! together do not: that is no singular configuration.

use super::found::Searched;
use super::sheet::Sheet;
use crate::Real;
use crate::linalg::{Workspace, dot, independent_columns, lift_rows};
use crate::tolerance::{regular, window};

/// Within a step, the volume that other rows span may be this many times that of the chosen rows;
/// at its beginning none was larger.
const MUCH_LARGER: f64 = 4.0;

/// To tell whether all rows become dependent, they are looked at before and after, at a distance of
/// this many times the time within which passages happen at once, and of at most this part of a
/// step.
const KNOWN: f64 = 32.0;
const MOST_AWAY: f64 = 0.125;
/// All rows count as dependent where less than this part of the volume is left that they span
/// there.
const LEFT: f64 = 0.2;

impl<T: Real> Sheet<'_, T> {
    /// The rank of all rows, at most their rank at regular states; `None` where the chosen ones are
    /// all there are.
    pub(super) fn rank_of_all_rows(&self, workspace: &Workspace<'_, T>) -> Option<usize> {
        if !self.are_some_left(workspace) {
            return None;
        }
        let all = 0..self.rows();
        Some(workspace.scope(|workspace| self.span(all, window(), workspace).0))
    }

    /// Whether other rows are far more independent than the chosen ones: these may become
    /// dependent by themselves nearby, and their determinant change its sign.
    pub(super) fn chose_poorly(&self, workspace: &Workspace<'_, T>) -> bool {
        if !self.are_some_left(workspace) {
            return false;
        }
        let chosen = self.chart.rows.iter().copied();
        let of_chosen = workspace.scope(|workspace| self.span(chosen, T::zero(), workspace).1);
        let (rank, of_others) =
            workspace.scope(|workspace| self.span(0..self.rows(), regular(), workspace));
        // In a singular configuration itself nothing can be told.
        rank == self.constraints() && of_others > of_chosen * T::from_f64(MUCH_LARGER)
    }

    /// Whether all rows become dependent where the chosen ones do within a step: about as near
    /// as their positions are known, the volume that they span falls to zero. Beside a singular
    /// configuration it falls to what is left there.
    pub(super) fn all_depend(
        &mut self,
        step: &Searched<'_, T>,
        t: T,
        workspace: &Workspace<'_, T>,
    ) -> bool {
        let away = step.at_once() * T::from_f64(KNOWN);
        let away = away.min(step.length * T::from_f64(MOST_AWAY));
        let [before, here, after] = [t - away, t, t + away].map(|t| {
            workspace.scope(|workspace| {
                let q = workspace.numbers(self.chart.n());
                step.position(t, q);
                self.eliminate_widely(t, q).ok()?;
                self.correct(q);
                self.equations.locate(t, q);
                Some(self.span(0..self.rows(), T::zero(), workspace).1)
            })
        });
        let beside = before.into_iter().chain(after).fold(T::zero(), T::max);
        here.is_none_or(|here| here < beside * T::from_f64(LEFT))
    }

    fn rows(&self) -> usize {
        self.chart.row_scale.len()
    }

    /// Whether there are rows that were not chosen, and room to look at them.
    fn are_some_left(&self, workspace: &Workspace<'_, T>) -> bool {
        let (n, r) = (self.chart.n(), self.rows());
        self.constraints() < r && workspace.has_room(n * r)
    }

    /// How many of some rows are independent, at most as many as were chosen, and the volume that
    /// these span.
    fn span(
        &self,
        rows: impl ExactSizeIterator<Item = usize>,
        least: T,
        workspace: &Workspace<'_, T>,
    ) -> (usize, T) {
        let (chart, n) = (&self.chart, self.chart.n());
        let jacobian = self.equations.constraints().jacobian;
        let vectors = workspace.any(n * rows.len());
        lift_rows(chart.metric, jacobian, chart.row_scale, rows, vectors);
        let chosen = workspace.indices(self.constraints());
        let count = independent_columns(vectors, n, &|_| false, least, chosen);
        // What is left of each row is its distance from the span of those before it.
        let left = |place: &usize| {
            let vector = &vectors[place * n..][..n];
            dot(vector, vector).sqrt()
        };
        let volume = chosen[..count].iter().map(left);
        (count, volume.fold(T::one(), |volume, left| volume * left))
    }
}
