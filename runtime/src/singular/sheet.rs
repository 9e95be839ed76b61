//! The sheet of the constraint set on which the motion lives, at regular states.
//!
//! In:  a [`ChartView`], a state near the sheet.
//! Out: the state on the sheet that has the same coordinates in the chart ([`PointView`]),
//!      its tangent space there, and the accelerations that the constraints demand.
//!
//! All are solutions of one square system, `[A; D*] x = right`: the constraint rows, and
//! the rows that measure how far `x` goes along the chart. Everything is over slices, and
//! compiled once for mechanisms of all sizes.
//!
//! Not here: states where that system is nearly singular ([`super::nodes`]).

use super::obstacle::Obstacle;
use super::product::ChartView;
use super::stored_nodes::NodesView;
use crate::Real;
use crate::equations::{At, Equations};
use crate::linalg::{Eliminated, Frame, Matrix, Right, Workspace, add_scaled, is_zero};
use crate::tolerance::{contraction, critical, near_dependent, round_off};

/// Corrections after which a state is given up.
const MAX_CORRECTIONS: usize = 12;

/// What must be left of a row to be sure that it does not turn against the others within
/// a step.
const MAY_TURN: f64 = 0.5;

/// Entries of a Jacobian, most of which are zero, that are looked at together.
const GLANCE: usize = 8;

/// A state on the sheet, and the sheet's geometry there.
#[derive(Debug)]
pub(super) struct PointView<'a, T> {
    pub(super) t: T,
    pub(super) q: &'a mut [T],
    pub(super) v: &'a mut [T],
    /// The tangent space: `D* D̃ = 1`.
    pub(super) tangent: &'a mut [T],
    /// The velocity of the sheet where the coordinates of the chart rest.
    pub(super) drift: &'a mut [T],
    /// The acceleration where the coordinates of the chart do not accelerate.
    pub(super) particular: &'a mut [T],
    /// About the sine by which the weakest combination of constraint rows is independent
    /// of the others.
    pub(super) sine: T,
    /// The spacing of nodes, as a change of the sine; zero without any.
    pub(super) spacing: T,
}

impl<'a, T: Real> PointView<'a, T> {
    /// Room for a state on the sheet of a chart.
    pub(super) fn new(chart: &ChartView<'_, T>, workspace: &Workspace<'a, T>) -> Self {
        let n = chart.n();
        Self {
            t: T::zero(),
            q: workspace.any(n),
            v: workspace.any(n),
            tangent: workspace.any(n * chart.freedoms),
            drift: workspace.any(n),
            particular: workspace.any(n),
            sine: T::zero(),
            spacing: T::zero(),
        }
    }

    pub(super) fn at(&self) -> At<'_, T> {
        At {
            t: self.t,
            q: self.q,
            v: self.v,
        }
    }

    /// Becomes a state of which nothing else is known yet.
    pub(super) fn set(&mut self, state: At<'_, T>) {
        self.t = state.t;
        self.q.copy_from_slice(state.q);
        self.v.copy_from_slice(state.v);
    }

    /// Gives the state the velocity of these coordinates in the chart.
    pub(super) fn move_along(&mut self, along: &[T]) {
        let n = self.q.len();
        self.v.copy_from_slice(self.drift);
        for (tangent, along) in self.tangent.chunks_exact(n).zip(along) {
            add_scaled(self.v, *along, tangent);
        }
    }
}

/// What constraint rows are to be instead of zero, in the order and scale of the frame's rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shift<'a, T>(pub(super) Option<(T, &'a [T])>);

impl<T: Real> Shift<'_, T> {
    /// Zero.
    pub(super) const NONE: Self = Self(None);

    /// By how much rows are short of the shift, in `room` if that is not zero.
    fn opposite<'b>(
        self,
        residual: &'b [T],
        chart: &ChartView<'b, T>,
        room: &'b mut [T],
    ) -> Right<'b, T> {
        let Some((share, rows)) = self.0 else {
            return chart.right(-T::one(), residual);
        };
        room.fill(T::zero());
        for ((target, shift), &row) in room.iter_mut().zip(rows).zip(chart.rows) {
            *target = share * *shift - chart.row_scale[row] * residual[row];
        }
        Right::Given(room)
    }
}

/// Of which kind a sheet is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kind<'a, T> {
    /// Whether any row restricts positions.
    pub(super) holonomic: bool,
    /// One for rows that restrict velocities only, zero for the others, in the order of the
    /// frame's rows; empty if there are none such.
    pub(super) velocity: &'a [T],
    /// Whether it is a curve that stays where it is.
    pub(super) is_curve: bool,
}

/// What evaluates the sheet: a mechanism, a chart, and buffers.
pub(super) struct Sheet<'a, T> {
    pub(super) equations: &'a mut dyn Equations<T>,
    pub(super) chart: ChartView<'a, T>,
    pub(super) frame: Frame<'a, T>,
    /// The nodes of the last interpolation.
    pub(super) nodes: NodesView<'a, T>,
    pub(super) kind: Kind<'a, T>,
    /// A right-hand side in the order and scale of the frame's rows, and a solution.
    right: &'a mut [T],
    pub(super) solution: &'a mut [T],
}

impl<'a, T: Real> Sheet<'a, T> {
    pub(super) fn new(
        equations: &'a mut dyn Equations<T>,
        chart: ChartView<'a, T>,
        nodes: NodesView<'a, T>,
        kind: Kind<'a, T>,
        workspace: &Workspace<'a, T>,
    ) -> Self {
        let n = chart.n();
        let (right, solution) = workspace.any(2 * n).split_at_mut(n);
        Self {
            equations,
            chart,
            frame: Frame::new(chart.column_places, chart.rows.len(), workspace),
            nodes,
            kind,
            right,
            solution,
        }
    }

    /// The constraint row that comes last in the elimination, by its place among the
    /// independent ones.
    pub(super) fn weakest_row(&self) -> usize {
        self.frame.weakest_row()
    }

    /// Its chart.
    pub(super) fn chart(&self) -> &ChartView<'a, T> {
        &self.chart
    }

    /// The smallest pivot of a constraint row in the last elimination.
    pub(super) fn smallest(&self) -> T {
        self.frame.smallest()
    }

    /// How many constraint rows take part.
    pub(super) fn constraints(&self) -> usize {
        self.chart.rows.len()
    }

    /// Evaluates and eliminates the constraints at a position, in the order of another
    /// elimination if there is one.
    pub(super) fn eliminate(
        &mut self,
        (t, q): (T, &[T]),
        like: Option<&Eliminated<'_, T>>,
    ) -> Result<(), Obstacle> {
        self.load(t, q);
        match like {
            Some(other) => self.frame.factorise_like(other),
            None => self
                .frame
                .factorise(self.chart.rows.len(), near_dependent()),
        }
        .map_err(|_| Obstacle::NotRegular)
    }

    /// Eliminates the constraints at a position, with all rows last that could turn within a step.
    pub(super) fn eliminate_widely(&mut self, t: T, q: &[T]) -> Result<(), Obstacle> {
        self.load(t, q);
        let constraints = self.constraints();
        let result = self.frame.factorise(constraints, T::from_f64(MAY_TURN));
        result.map_err(|_| Obstacle::NotRegular)
    }

    /// Evaluates the constraints at a position.
    fn load(&mut self, t: T, q: &[T]) {
        self.equations.locate(t, q);
        match self.frame.is_long() {
            true => {
                self.frame.clear();
                self.load_sparse();
            }
            false => self.load_all(),
        }
    }

    /// Takes all entries of the constraint rows and the duals.
    fn load_all(&mut self) {
        let chart = &self.chart;
        let jacobian = Matrix {
            entries: self.equations.constraints().jacobian,
            rows: chart.rows,
            factors: chart.row_scale,
        };
        self.frame
            .set_rows(jacobian, chart.dual, chart.column_scale);
    }

    /// Takes the entries of the constraint rows and the duals that are not zero.
    fn load_sparse(&mut self) {
        let chart = &self.chart;
        let jacobian = self.equations.constraints().jacobian;
        let columns = jacobian.chunks_exact(chart.row_scale.len());
        for (j, (entries, column)) in columns.zip(chart.column_scale).enumerate() {
            let (glances, rest) = entries.as_chunks::<GLANCE>();
            let mut set = |row: usize, entry: T| {
                if entry != T::zero() && chart.places[row] < chart.rows.len() {
                    let entry = chart.row_scale[row] * entry * *column;
                    self.frame.set_entry(chart.places[row], j, entry);
                }
            };
            for (first, glance) in glances.iter().enumerate() {
                // All are compared, which takes fewer instructions than to stop at the first.
                if glance.iter().fold(true, |none, x| none & (*x == T::zero())) {
                    continue;
                }
                for (row, entry) in (first * GLANCE..).zip(glance) {
                    set(row, *entry);
                }
            }
            for (row, entry) in (entries.len() - rest.len()..).zip(rest) {
                set(row, *entry);
            }
        }
        for (i, duals) in chart.dual.chunks_exact(chart.n()).enumerate() {
            for (j, (dual, column)) in duals.iter().zip(chart.column_scale).enumerate() {
                if *dual != T::zero() {
                    let row = chart.rows.len() + i;
                    self.frame.set_entry(row, j, *dual * *column);
                }
            }
        }
    }

    /// Corrects what interpolation leaves of position and velocity in the rows that are
    /// safely independent. The near-dependent ones would magnify round-off.
    pub(super) fn polish(
        &mut self,
        point: &mut PointView<'_, T>,
        like: &Eliminated<'_, T>,
    ) -> Result<(), Obstacle> {
        self.eliminate((point.t, point.q), Some(like))?;
        self.correct(point.q);
        self.rates(point.v, T::one());
        let (right, scales) = (Right::Given(self.right), self.chart.column_scale);
        self.frame.solve_independent(right, scales, self.solution);
        add_scaled(point.v, -T::one(), self.solution);
        Ok(())
    }

    /// Corrects a position whose frame is at hand in the rows that are safely independent.
    pub(super) fn correct(&mut self, q: &mut [T]) {
        let chart = &self.chart;
        let right = chart.right(-T::one(), self.equations.constraints().residual);
        let scales = chart.column_scale;
        self.frame.solve_independent(right, scales, self.solution);
        add_scaled(q, T::one(), self.solution);
    }

    /// The largest of the constraints that is left when the rows before the near-dependent
    /// ones are eliminated.
    pub(super) fn largest_residual(&mut self, shift: Shift<'_, T>) -> T {
        let residual = self.equations.constraints().residual;
        let right = shift.opposite(residual, &self.chart, self.right);
        self.frame.largest_reduced(right)
    }

    /// By how much a displacement in some time changes the near-dependent constraint, when the
    /// rows before it are eliminated.
    pub(super) fn reduced_change(&mut self, displacement: &[T], time: T) -> T {
        self.rates(displacement, time);
        let mut reduced = self.frame.reduced(Right::Given(self.right));
        reduced.next().unwrap_or_default()
    }

    /// The changes of constraint rows by a displacement in some time, as right-hand sides.
    pub(super) fn rates(&mut self, displacement: &[T], time: T) -> &[T] {
        let (chart, at) = (&self.chart, self.equations.constraints());
        self.right.fill(T::zero());
        for (place, &row) in chart.rows.iter().enumerate() {
            let mut change = at.drift[row] * time;
            let columns = at.jacobian.chunks_exact(at.drift.len());
            for (levers, moved) in columns.zip(displacement) {
                change += levers[row] * *moved;
            }
            self.right[place] = chart.row_scale[row] * change;
        }
        self.right
    }

    /// The displacement that changes the near-dependent constraint alone, as the pivot of its
    /// row says, at a regular state whose frame is at hand.
    pub(super) fn solve_weakest(&mut self, displacement: &mut [T]) {
        let weakest = Right::Unit(self.weakest_row());
        let scales = self.chart.column_scale;
        self.frame.solve(weakest, scales, displacement);
        let pivot = self.frame.block().first();
        for entry in displacement {
            *entry *= pivot;
        }
    }

    /// Moves a guess `q` along the chart's complement onto the sheet, or to where constraint rows
    /// are shifted, and takes back what then leads there from a position beside it along rows that
    /// restrict only velocities; leaves its frame.
    pub(super) fn project_from(
        &mut self,
        from: &[T],
        (t, q): (T, &mut [T]),
        like: &Eliminated<'_, T>,
        shift: Shift<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<(), Obstacle> {
        self.eliminate((t, q), Some(like))?;
        self.project_from_here(t, q, Some(like), shift)?;
        if self.kind.velocity.is_empty() {
            return Ok(());
        }
        self.straighten(from, q, workspace);
        self.eliminate((t, q), Some(like))?;
        self.project_from_here(t, q, Some(like), shift)
    }

    /// Takes back what led from a position to another, whose frame is at hand, along rows that
    /// restrict only velocities: no equation says where the position is along them.
    fn straighten(&mut self, from: &[T], q: &mut [T], workspace: &Workspace<'_, T>) {
        workspace.scope(|workspace| {
            let moved = workspace.any(q.len());
            moved.copy_from_slice(q);
            add_scaled(moved, -T::one(), from);
            self.rates(moved, T::zero());
        });
        for (right, velocity) in self.right.iter_mut().zip(self.kind.velocity) {
            *right *= *velocity;
        }
        let (right, scales) = (Right::Given(self.right), self.chart.column_scale);
        self.frame.solve(right, scales, self.solution);
        add_scaled(q, -T::one(), self.solution);
    }

    /// Newton's iteration of a projection, from a position whose frame is at hand.
    fn project_from_here(
        &mut self,
        t: T,
        q: &mut [T],
        like: Option<&Eliminated<'_, T>>,
        shift: Shift<'_, T>,
    ) -> Result<(), Obstacle> {
        let mut before: Option<T> = None;
        for _ in 0..MAX_CORRECTIONS {
            if !self.kind.holonomic {
                return Ok(());
            }
            let residual = self.equations.constraints().residual;
            let right = shift.opposite(residual, &self.chart, self.right);
            let scales = self.chart.column_scale;
            self.frame.solve(right, scales, self.solution);
            let size = self.chart.length(self.solution);
            if !size.is_finite() {
                return Err(Obstacle::NotFinite);
            }
            let noise = round_off::<T>() * self.chart.coordinate_scale.size / self.frame.smallest();
            if size <= noise {
                return Ok(());
            }
            if before.is_some_and(|before| size > before * contraction()) {
                // Where round-off is all that is left, it does not contract either.
                let stuck = size <= noise * critical();
                return match stuck {
                    true => Ok(()),
                    false => Err(Obstacle::NotContracting),
                };
            }
            add_scaled(q, T::one(), self.solution);
            before = Some(size);
            self.eliminate((t, q), like)?;
        }
        Err(Obstacle::NotContracting)
    }

    /// The sheet's geometry at a position on it whose frame is at hand, for a velocity of
    /// these coordinates in the chart, or as it is.
    pub(super) fn measure(&mut self, along: Option<&[T]>, point: &mut PointView<'_, T>) {
        let chart = self.chart;
        let scales = chart.column_scale;
        for (i, tangent) in point.tangent.chunks_exact_mut(chart.n()).enumerate() {
            let unit = Right::Unit(chart.rows.len() + i);
            self.frame.solve(unit, scales, tangent);
        }
        let drift = self.equations.constraints().drift;
        match is_zero(drift) {
            true => point.drift.fill(T::zero()),
            false => {
                let right = chart.right(-T::one(), drift);
                self.frame.solve(right, scales, point.drift);
            }
        }
        if let Some(along) = along {
            point.move_along(along);
        }
        self.equations.evaluate(point.at());
        let right = chart.right(T::one(), self.equations.constraints().bias);
        self.frame.solve(right, scales, point.particular);
        point.sine = self.frame.smallest();
    }

    /// The geometry at a state as it is.
    pub(super) fn measure_here(
        &mut self,
        state: At<'_, T>,
        point: &mut PointView<'_, T>,
    ) -> Result<(), Obstacle> {
        self.eliminate((state.t, state.q), None)?;
        point.set(state);
        self.measure(None, point);
        Ok(())
    }

    /// Puts a state whose frame is at hand onto the sheet where the constraints are
    /// regular.
    pub(super) fn place_regular(
        &mut self,
        state: At<'_, T>,
        point: &mut PointView<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<(), Obstacle> {
        point.set(state);
        self.project_from_here(state.t, point.q, None, Shift::NONE)?;
        let along = workspace.numbers(self.chart.freedoms);
        self.chart.coordinates(state.v, along);
        self.measure(Some(along), point);
        Ok(())
    }
}

impl<'a, T: Real> ChartView<'a, T> {
    /// A multiple of right-hand sides of the constraint rows, in their order and scale.
    fn right<'b>(&self, factor: T, entries: &'b [T]) -> Right<'b, T>
    where
        'a: 'b,
    {
        let column = Matrix {
            entries,
            rows: self.rows,
            factors: self.row_scale,
        };
        Right::Column(factor, column)
    }
}
