//! Rows that are surely independent.
//!
//! In:  a Jacobian whose metric is factorised, some of its rows.
//! Out: [`Independent`], where a lower bound of their singular values tells; the directions
//!      that they leave free.
//!
//! Not here: singular values, which decide where this does not ([`super::singular_values`]).

use super::erased::Constrained;
use super::singular_values::lift;
use crate::Real;
use crate::linalg::{
    Frame, Right, Workspace, order_by_first_row, orthonormalise, scale, solve_upper_transposed,
};
use crate::tolerance::near_dependent;

/// Rows in the metric, scaled to size one, eliminated and completed to a basis.
pub(crate) struct Independent<'a, T> {
    frame: Frame<'a, T>,
    count: usize,
    ones: &'a [T],
}

impl<'a, T: Real> Independent<'a, T> {
    /// Some rows where the constraints were evaluated last; `None` where it is not sure that
    /// all their singular values are above a bound.
    pub(crate) fn here(
        solver: &dyn Constrained<T>,
        rows: &[usize],
        least: T,
        workspace: &Workspace<'a, T>,
    ) -> Option<Self> {
        let (jacobian, known) = (solver.constraints().jacobian, solver.known());
        let (n, count) = (jacobian.len() / known.r(), rows.len());
        if count > n {
            return None;
        }
        let (places, first) = workspace.indices(2 * n).split_at_mut(n);
        order_by_first_row(jacobian, rows, places, first);
        let mut frame = Frame::new(places, n, workspace);
        frame.clear();
        let (ones, vector) = workspace.any(2 * n).split_at_mut(n);
        ones.fill(T::one());
        for (place, row) in rows.iter().enumerate() {
            lift(jacobian, known, *row, vector);
            scale(vector, known.scale[*row]);
            frame.set_row(place, vector);
        }
        frame.complete(count, near_dependent()).ok()?;
        // A comparison with NaN is false, so that rows with NaN are not sure to be independent.
        let is_sure = frame.least_singular_value(count, ones, vector) > least;
        is_sure.then_some(Self { frame, count, ones })
    }

    /// Fills columns with an orthonormal basis of what the rows leave free, lowered.
    pub(crate) fn span_free(&mut self, factor: &[T], free: &mut [T], workspace: &Workspace<'_, T>) {
        let n = self.ones.len();
        for (i, column) in free.chunks_exact_mut(n).enumerate() {
            let unit = Right::Unit(self.count + i);
            self.frame.solve(unit, self.ones, column);
        }
        orthonormalise(free, n, workspace);
        for column in free.chunks_exact_mut(n) {
            solve_upper_transposed(factor, column);
        }
    }
}
