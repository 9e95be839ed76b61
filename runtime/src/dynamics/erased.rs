//! The solver of a mechanism whose sizes are forgotten.
//!
//! In:  a solver and its mechanism.
//! Out: [`SolverView`], which is [`Constrained`]: equations with the metric of the kinetic
//!      energy, and what is known of the constraint rows.
//!
//! Code outside of the evaluations works on these, so that it is compiled once, whatever the
//! sizes of mechanisms are.

use super::Core;
use super::coordinate_scale::CoordinateScale;
use super::metric::{Metric, MetricView};
use super::rows::{Rows, RowsView};
use super::solver::{Source, factorise};
use crate::equations::{At, Bound, Constraints, Equations};
use crate::linalg::{Workspace, solve_upper_transposed};
use crate::singular::{Chart, Nodes, Session};
use crate::{Counters, DynamicsError, Mechanism, Real, Structure};

/// Equations with a metric, and with what is known of the constraint rows.
pub(crate) trait Constrained<T: Real>: Equations<T> {
    /// Factorises the metric where the constraints were evaluated last.
    fn factorise(&mut self, t: T) -> Result<(), DynamicsError<T>>;
    /// Makes the mass matrix the metric there; whether it is definite.
    fn factorise_mass(&mut self) -> bool;
    /// What is known of the metric and the rows.
    fn known(&self) -> Known<'_, T>;
    /// What is known of the metric and the rows, to be changed.
    fn learn(&mut self) -> Learning<'_, T>;
    /// How far a state, at which the metric is factorised, is off the sheet with this tangent
    /// space; `None` where that can't be told.
    fn distance(
        &mut self,
        state: At<'_, T>,
        tangent: &[T],
        workspace: &Workspace<'_, T>,
    ) -> Option<T>;
}

/// What is known of the metric and the rows.
#[derive(Clone, Copy)]
pub(crate) struct Known<'a, T> {
    /// The factor `U` of the metric, column by column.
    pub(crate) factor: &'a [T],
    /// What rows are multiplied by to have size one.
    pub(crate) scale: &'a [T],
    /// Which rows restrict positions.
    pub(crate) holonomic: &'a [bool],
    /// The lengths that round-off and differences of positions are measured by.
    pub(crate) coordinate_scale: CoordinateScale<T>,
}

/// What is known of the metric and the rows, to be changed.
pub(crate) struct Learning<'a, T> {
    pub(crate) metric: MetricView<'a, T>,
    pub(crate) rows: RowsView<'a, T>,
    pub(crate) counters: &'a mut Counters,
    /// The constraints where they were evaluated last.
    pub(crate) at: Constraints<'a, T>,
}

impl<T: Real> Known<'_, T> {
    /// How many rows there are.
    pub(crate) fn r(&self) -> usize {
        self.scale.len()
    }

    /// `w := U⁻ᵀw`, back to the mechanism's own coordinates.
    pub(crate) fn lower(&self, w: &mut [T]) {
        solve_upper_transposed(self.factor, w);
    }

    /// A right-hand side of rows scaled to size one.
    pub(crate) fn scaled(&self, right: &[T], scaled: &mut [T]) {
        for (target, (right, scale)) in scaled.iter_mut().zip(right.iter().zip(self.scale)) {
            *target = *scale * *right;
        }
    }
}

impl<'s, T: Real> dyn Constrained<T> + 's {
    /// Evaluates the constraints and factorises the metric at a position.
    pub(crate) fn visit(&mut self, t: T, q: &[T]) -> Result<(), DynamicsError<T>> {
        self.locate(t, q);
        self.factorise(t)
    }
}

/// The parts of a solver that [`Constrained`] gives access to.
pub(crate) struct SolverView<'a, T, const N: usize, const R: usize> {
    pub(crate) equations: Bound<'a, T, N, R>,
    pub(crate) metric: &'a mut Metric<T, N>,
    pub(crate) rows: &'a mut Rows<T, R>,
    pub(crate) counters: &'a mut Counters,
    pub(crate) nodes: &'a mut Nodes<T, N>,
    pub(crate) weakest: &'a mut usize,
    expected: &'a mut bool,
    pub(crate) coordinate_scale: CoordinateScale<T>,
    pub(crate) sizes: &'a [T; N],
    pub(crate) tolerance: Option<T>,
}

/// A solver, memory, and a chart.
type Loan<'a, T, const N: usize, const R: usize> = (
    SolverView<'a, T, N, R>,
    Workspace<'a, T>,
    Option<&'a Chart<T, N, R>>,
);

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Lends the solver, memory to work in, and the chart at hand.
    #[inline(never)]
    pub(crate) fn lend<'a>(
        &'a mut self,
        mechanism: &'a dyn Mechanism<T, N, R>,
    ) -> Loan<'a, T, N, R> {
        let Session {
            nodes,
            chart,
            tolerance,
            ..
        } = &mut self.session;
        let view = SolverView {
            equations: Bound {
                mechanism,
                position: &mut self.position,
                terms: &mut self.terms,
            },
            metric: &mut self.metric,
            rows: &mut self.rows,
            counters: &mut self.counters,
            nodes,
            weakest: &mut self.weakest,
            expected: &mut self.expected,
            coordinate_scale: self.coordinate_scale,
            sizes: &self.sizes,
            tolerance: *tolerance,
        };
        (view, self.memory.workspace(), chart.as_ref())
    }

    /// What is known of the metric and the rows, the Jacobian in a buffer, and memory to work
    /// in.
    pub(crate) fn known(&mut self, source: Source) -> (Known<'_, T>, &[T], Workspace<'_, T>) {
        let jacobian = match source {
            Source::Terms => &self.terms.jacobian,
            Source::Position => &self.position.jacobian,
        };
        let known = known(&self.metric, &self.rows, self.coordinate_scale);
        (known, jacobian.as_slice(), self.memory.workspace())
    }
}

/// What is known of a metric and rows.
pub(super) fn known<'a, T: Real, const N: usize, const R: usize>(
    metric: &'a Metric<T, N>,
    rows: &'a Rows<T, R>,
    coordinate_scale: CoordinateScale<T>,
) -> Known<'a, T> {
    Known {
        factor: metric.factor.as_slice(),
        scale: &rows.scale,
        holonomic: &rows.holonomic,
        coordinate_scale,
    }
}

impl<T: Real, const N: usize, const R: usize> Equations<T> for SolverView<'_, T, N, R> {
    fn structure(&self) -> &'static Structure {
        self.equations.structure()
    }

    fn locate(&mut self, t: T, q: &[T]) {
        self.equations.locate(t, q);
    }

    fn constraints(&self) -> Constraints<'_, T> {
        self.equations.constraints()
    }

    fn evaluate(&mut self, state: At<'_, T>) {
        self.equations.evaluate(state);
    }
}

impl<T: Real, const N: usize, const R: usize> Constrained<T> for SolverView<'_, T, N, R> {
    fn factorise(&mut self, t: T) -> Result<(), DynamicsError<T>> {
        *self.expected = false;
        let Bound {
            mechanism,
            position,
            ..
        } = &self.equations;
        factorise(
            (self.metric, self.rows, self.counters),
            (&position.mass, &position.jacobian),
            mechanism.structure(),
            t,
        )
    }

    fn factorise_mass(&mut self) -> bool {
        let mass = &self.equations.position.mass;
        self.metric.factor.factorise(mass).is_ok()
    }

    fn known(&self) -> Known<'_, T> {
        known(self.metric, self.rows, self.coordinate_scale)
    }

    fn learn(&mut self) -> Learning<'_, T> {
        Learning {
            metric: self.metric.view(),
            rows: self.rows.view(),
            counters: self.counters,
            at: self.equations.constraints(),
        }
    }

    fn distance(
        &mut self,
        state: At<'_, T>,
        tangent: &[T],
        workspace: &Workspace<'_, T>,
    ) -> Option<T> {
        self.distance_from_sheet(state, tangent, workspace)
    }
}
