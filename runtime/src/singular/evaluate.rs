//! Sheets of a mechanism of known sizes.
//!
//! In:  a mechanism, its solver, a [`Chart`].
//! Out: what is asked of the [`Sheet`] of the chart, in the memory of the solver.

use super::chart::Chart;
use super::kept::Nodes;
use super::memory::Memory;
use super::obstacle::Obstacle;
use super::place::Placement;
use super::session::Session;
use super::sheet::{Point, Sheet};
use crate::dynamics::Core;
use crate::equations::Bound;
use crate::linalg::Workspace;
use crate::{Mechanism, Real, State};

/// What sheets are evaluated with.
struct Evaluator<'a, T, const N: usize, const R: usize> {
    equations: Bound<'a, T, N, R>,
    nodes: &'a mut Nodes<T, N>,
    memory: &'a mut Memory<T, N, R>,
    weakest: &'a mut usize,
    holonomic: bool,
}

impl<T: Real, const N: usize, const R: usize> Evaluator<'_, T, N, R> {
    /// Does something on the sheet of a chart.
    fn on<V>(
        mut self,
        chart: &Chart<T, N, R>,
        work: impl FnOnce(&mut Sheet<'_, T>, &Workspace<'_, T>) -> V,
    ) -> V {
        let workspace = self.memory.workspace();
        let mut sheet = Sheet::new(
            &mut self.equations,
            chart.view(),
            self.nodes.view(),
            self.holonomic,
            &workspace,
        );
        let done = work(&mut sheet, &workspace);
        *self.weakest = sheet.weakest_row();
        done
    }
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// What sheets are evaluated with, and the chart at hand.
    fn evaluator<'a>(
        &'a mut self,
        mechanism: &'a dyn Mechanism<T, N, R>,
    ) -> (Evaluator<'a, T, N, R>, Option<&'a Chart<T, N, R>>) {
        let Session { nodes, chart, .. } = &mut self.session;
        let evaluator = Evaluator {
            equations: Bound {
                mechanism,
                position: &mut self.position,
                terms: &mut self.terms,
            },
            nodes,
            memory: &mut self.memory,
            weakest: &mut self.weakest,
            holonomic: self.rows.any_holonomic(),
        };
        (evaluator, chart.as_ref())
    }

    /// Does something on the sheet of a chart.
    pub(crate) fn on_sheet<V>(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        chart: &Chart<T, N, R>,
        work: impl FnOnce(&mut Sheet<'_, T>, &Workspace<'_, T>) -> V,
    ) -> V {
        let (evaluator, _) = self.evaluator(mechanism);
        evaluator.on(chart, work)
    }

    /// Puts a state onto the sheet of a chart.
    #[inline(never)]
    pub(crate) fn place_on(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        chart: &Chart<T, N, R>,
        state: &State<T, N>,
        point: &mut Point<T, N>,
    ) -> Result<Placement<T>, Obstacle> {
        let (evaluator, _) = self.evaluator(mechanism);
        evaluator.place(chart, state, point)
    }

    /// Puts a state onto the sheet of the chart at hand; none if there is no such chart.
    #[inline(never)]
    pub(crate) fn place_here(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        point: &mut Point<T, N>,
    ) -> Option<Result<Placement<T>, Obstacle>> {
        let (evaluator, chart) = self.evaluator(mechanism);
        Some(evaluator.place(chart?, state, point))
    }

    /// The geometry of the sheet of the chart at hand at a state as it is; none if there is no
    /// such chart.
    pub(crate) fn geometry_here(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        point: &mut Point<T, N>,
    ) -> Option<Result<(), Obstacle>> {
        let (evaluator, chart) = self.evaluator(mechanism);
        let chart = chart?;
        Some(evaluator.on(chart, |sheet, _| {
            point.change(chart.freedoms, |point| sheet.look_at(state.at(), point))
        }))
    }
}

impl<T: Real, const N: usize, const R: usize> Evaluator<'_, T, N, R> {
    fn place(
        self,
        chart: &Chart<T, N, R>,
        state: &State<T, N>,
        point: &mut Point<T, N>,
    ) -> Result<Placement<T>, Obstacle> {
        self.on(chart, |sheet, workspace| {
            point.change(chart.freedoms, |point| {
                sheet.put(state.at(), point, workspace)
            })
        })
    }
}
