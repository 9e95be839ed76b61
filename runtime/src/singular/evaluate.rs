//! Sheets of a mechanism of known sizes.
//!
//! In:  a mechanism, its solver, a [`Chart`].
//! Out: what is asked of the [`Sheet`] of the chart, in the memory of the solver.

use super::chart::Chart;
use super::obstacle::Obstacle;
use super::place::Placement;
use super::sheet::{Point, Sheet};
use crate::dynamics::{Core, SolverView};
use crate::linalg::Workspace;
use crate::{Mechanism, Real, State};

/// Something that is done on a sheet.
type Work<'a, T> = &'a mut dyn FnMut(&mut Sheet<'_, T>, &Workspace<'_, T>);

impl<T: Real, const N: usize, const R: usize> SolverView<'_, T, N, R> {
    /// Does something on the sheet of a chart.
    #[inline(never)]
    fn on_sheet(&mut self, chart: &Chart<T, N, R>, workspace: &Workspace<'_, T>, work: Work<T>) {
        workspace.scope(|workspace| {
            let mut free = workspace.all();
            let workspace = free.workspace();
            let mut sheet = Sheet::new(
                &mut self.equations,
                chart.view(),
                self.nodes.view(),
                self.rows.any_holonomic(),
                &workspace,
            );
            work(&mut sheet, &workspace);
            *self.weakest = sheet.weakest_row();
        });
    }

    /// Puts a state onto the sheet of a chart.
    #[inline(never)]
    pub(super) fn place(
        &mut self,
        chart: &Chart<T, N, R>,
        state: &State<T, N>,
        point: &mut Point<T, N>,
        workspace: &Workspace<'_, T>,
    ) -> Result<Placement<T>, Obstacle> {
        let mut placed = Err(Obstacle::Undetermined);
        self.on_sheet(chart, workspace, &mut |sheet, workspace| {
            let at = state.at();
            placed = point.change(chart.freedoms, |point| sheet.put(at, point, workspace));
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

    /// Puts a state onto the sheet of a chart.
    pub(crate) fn place_on(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        chart: &Chart<T, N, R>,
        state: &State<T, N>,
        point: &mut Point<T, N>,
    ) -> Result<Placement<T>, Obstacle> {
        let (mut solver, workspace, _) = self.lend(mechanism);
        solver.place(chart, state, point, &workspace)
    }

    /// Puts a state onto the sheet of the chart at hand; none if there is no such chart.
    #[inline(never)]
    pub(crate) fn place_here(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        point: &mut Point<T, N>,
    ) -> Option<Result<Placement<T>, Obstacle>> {
        let (mut solver, workspace, chart) = self.lend(mechanism);
        Some(solver.place(chart?, state, point, &workspace))
    }

    /// The geometry of the sheet of the chart at hand at a state as it is; none if there is no
    /// such chart.
    pub(crate) fn geometry_here(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        point: &mut Point<T, N>,
    ) -> Option<Result<(), Obstacle>> {
        let (mut solver, workspace, chart) = self.lend(mechanism);
        let chart = chart?;
        let mut measured = Ok(());
        solver.on_sheet(chart, &workspace, &mut |sheet, _| {
            measured = point.change(chart.freedoms, |point| sheet.look_at(state.at(), point));
        });
        Some(measured)
    }
}
