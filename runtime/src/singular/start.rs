//! Which sheet a motion begins on.
//!
//! In:  a state of which nothing is known but that it is on the constraints.
//! Out: a [`Chart`] there, or the news that nothing tells which sheet is meant.
//!
//! Where the constraints are regular, however little, their null space is the tangent
//! space. In a singular configuration and within round-off of it, two sheets with
//! normals `n±` cross, which the second derivatives `H` of the constraint combination
//! that loses its gradient show: `H = n₊n₋ᵀ + n₋n₊ᵀ` on the directions that the other
//! constraints leave free. The velocity tells which sheet is meant, or the position
//! where it is off one of them.

use super::chart::Chart;
use super::part::split_tangent;
use super::point::Point;
use super::sheet_selection::finding_tangent;
use crate::dynamics::{Core, SolverView, Source, Which};
use crate::equations::{At, sized};
use crate::linalg::{Workspace, is_zero};
use crate::tolerance::accepted;
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::SMatrix;

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// The chart of the sheet that a motion begins on; none in a singular configuration in
    /// which nothing tells which sheet is meant.
    pub(crate) fn start_at(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<Option<Chart<T, N, R>>, DynamicsError<T>> {
        self.prepare(mechanism, state)?;
        mechanism.position(state, &mut self.position);
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        let freedoms = self.freedoms();
        let mut tangent = SMatrix::<T, N, N>::zeros();
        let free = &mut tangent.as_mut_slice()[..N * freedoms];
        let (mut solver, workspace, _) = self.lend(mechanism);
        if !finding_tangent()(&mut solver, state.at(), free, &workspace)? {
            return Ok(None);
        }
        Ok(solver.chart(state, (tangent, freedoms), &workspace))
    }
}

impl<T: Real, const N: usize, const R: usize> SolverView<'_, T, N, R> {
    /// A chart at a state whose metric is factorised.
    fn chart(
        &mut self,
        state: &State<T, N>,
        (tangent, freedoms): (SMatrix<T, N, N>, usize),
        workspace: &Workspace<'_, T>,
    ) -> Option<Chart<T, N, R>> {
        let equations = &mut self.equations;
        let components = equations.mechanism.structure().components;
        let mut own = tangent;
        if !components.is_empty() {
            let (independent, count) = self.rows.active(Which::All)?;
            let all = &tangent.as_slice()[..N * freedoms];
            let rows = &independent[..count];
            split_tangent(
                components,
                (N, R),
                (all, rows),
                own.as_mut_slice(),
                workspace,
            );
        }
        equations.mechanism.position(state, equations.position);
        let (mass, jacobian) = (&equations.position.mass, &equations.position.jacobian);
        let other = self.metric.of_chart(mass, jacobian, self.rows).ok()?;
        let mut chart = Chart::new(
            state,
            own,
            other.as_ref().unwrap_or(&self.metric.factor),
            (self.rows, jacobian),
            (self.coordinate_scale, self.sizes, accepted(self.tolerance)),
            components,
            workspace,
        )?;
        if !is_zero(equations.position.drift.as_slice()) {
            // Where only the time leads away from a singular configuration, the velocity tells
            // where to.
            chart.set_drift(&chart.across(&state.v), &state.v, None);
            let mut point = Point::zeros();
            if self.place(&chart, state, &mut point, workspace).is_ok() {
                chart.set_drift(&point.drift, &point.state.v, None);
            }
        }
        Some(chart)
    }

    /// How far a state, at which the metric is factorised, is off the sheet with this tangent
    /// space, where another one crosses it.
    #[inline(never)]
    pub(crate) fn distance_from_sheet(
        &mut self,
        state: At<'_, T>,
        tangent: &[T],
        workspace: &Workspace<'_, T>,
    ) -> Option<T> {
        let state = sized(state);
        let mut columns = SMatrix::<T, N, N>::zeros();
        columns.as_mut_slice()[..tangent.len()].copy_from_slice(tangent);
        let mut point = Point::zeros();
        let chart = self.chart(&state, (columns, tangent.len() / N), workspace)?;
        let placed = self.place(&chart, &state, &mut point, workspace);
        let moved = point.state.q - state.q;
        match placed {
            Ok(placement) if placement.is_crossing() => Some(chart.view().length(moved.as_slice())),
            _ => None,
        }
    }
}
