//! Sheets of a mechanism of known sizes.
//!
//! In:  a mechanism, its solver, a [`Chart`].
//! Out: what is asked of the [`Sheets`] of the chart, in the memory of the solver.

use super::chart::Chart;
use super::obstacle::Obstacle;
use super::place::Placement;
use super::point::Point;
use super::sheets::{Sheets, measuring, placing};
use crate::dynamics::{Core, SolverView};
use crate::linalg::Workspace;
use crate::tolerance::window;
use crate::{Mechanism, Real, State};

/// Something that is done on the sheet.
type Work<'a, T> = &'a mut dyn FnMut(&mut Sheets<'_, T>, &Workspace<'_, T>);

impl<T: Real, const N: usize, const R: usize> SolverView<'_, T, N, R> {
    /// Does something on the sheet of a chart.
    #[inline(never)]
    fn on_sheet(&mut self, chart: &Chart<T, N, R>, workspace: &Workspace<'_, T>, work: Work<T>) {
        let mut sheets = Sheets {
            equations: &mut self.equations,
            chart: chart.view(),
            nodes: self.nodes.slices(),
            holonomic: &self.rows.holonomic,
            weakest: self.weakest,
        };
        work(&mut sheets, workspace);
    }

    /// Puts a state onto the sheet of a chart.
    #[inline(never)]
    pub(crate) fn place(
        &mut self,
        chart: &Chart<T, N, R>,
        state: &State<T, N>,
        point: &mut Point<T, N>,
        workspace: &Workspace<'_, T>,
    ) -> Result<Placement, Obstacle> {
        let mut placed = Err(Obstacle::Undetermined);
        self.on_sheet(chart, workspace, &mut |sheets, workspace| {
            placed = placing()(sheets, state.at(), &mut point.slices(), workspace);
        });
        placed
    }
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Does something on the sheet of a chart.
    pub(crate) fn on_sheet(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        chart: &Chart<T, N, R>,
        work: Work<T>,
    ) {
        let (mut solver, workspace, _) = self.lend(mechanism);
        solver.on_sheet(chart, &workspace, work);
    }

    /// Puts a state onto the sheet of the chart at hand; none if there is no such chart.
    #[inline(never)]
    pub(crate) fn place_here(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        point: &mut Point<T, N>,
    ) -> Option<Result<Placement, Obstacle>> {
        let (mut solver, workspace, chart) = self.lend(mechanism);
        Some(solver.place(chart?, state, point, &workspace))
    }

    /// The geometry of the sheet of the chart at hand at a state as it is; `false` if there is
    /// no such chart, or the state lies next to a singular configuration.
    pub(crate) fn measure_here(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        point: &mut Point<T, N>,
    ) -> bool {
        let (mut solver, workspace, chart) = self.lend(mechanism);
        let Some(chart) = chart else {
            return false;
        };
        let mut measured = Ok(());
        solver.on_sheet(chart, &workspace, &mut |sheets, workspace| {
            measured = measuring()(sheets, state.at(), &mut point.slices(), workspace);
        });
        measured.is_ok() && point.sine() > window()
    }
}
