//! Constraints of which some follow from the others.
//!
//! In:  the constraint rows where they were evaluated last.
//! Out: how many of them are independent, whichever these are.
//!
//! The rows that were chosen at an accepted state may become dependent where all of them
//! together do not: that is no singular configuration.

use super::sheet::Sheet;
use crate::Real;
use crate::linalg::{Workspace, independent_columns, lift_row, scale};
use crate::tolerance::window;

impl<T: Real> Sheet<'_, T> {
    /// The rank of all rows, as many of which count as there are independent ones at regular
    /// states; `None` where the chosen ones are all there are.
    pub(super) fn rank_of_all_rows(&self, workspace: &Workspace<'_, T>) -> Option<usize> {
        let chart = &self.chart;
        let (n, r) = (chart.n(), chart.row_scale.len());
        if chart.rows.len() == r || !workspace.has_room(n * r) {
            return None;
        }
        Some(workspace.scope(|workspace| {
            let vectors = workspace.any(n * r);
            let jacobian = self.equations.constraints().jacobian;
            for (row, vector) in vectors.chunks_exact_mut(n).enumerate() {
                lift_row(chart.metric, jacobian, (row, r), vector);
                scale(vector, chart.row_scale[row]);
            }
            let chosen = workspace.indices(chart.rows.len());
            independent_columns(vectors, n, &|_| false, window(), chosen)
        }))
    }
}
