//! The sheet of the constraint set on which the motion lives, at regular states.
//!
//! In:  a [`Chart`], a state near the sheet.
//! Out: the state on the sheet that has the same coordinates in the chart ([`Point`]),
//!      its tangent space there, and the accelerations that the constraints demand.
//!
//! All are solutions of one square system, `[A; D*] x = right`: the constraint rows, and
//! the rows that measure how far `x` goes along the chart.
//!
//! Not here: states where that system is nearly singular ([`super::nodes`]).

use super::chart::Chart;
use super::kept::Nodes;
use super::obstacle::Obstacle;
use crate::linalg::{Frame, add_scaled, dot, is_zero};
use crate::tolerance::{contraction, critical, near_dependent, round_off};
use crate::{Mechanism, Position, Real, State, Terms};
use nalgebra::{SMatrix, SVector};

/// Corrections after which a state is given up.
const MAX_CORRECTIONS: usize = 12;

/// What must be left of a row to be sure that it does not turn against the others within
/// a step.
const MAY_TURN: f64 = 0.5;

/// A state on the sheet, and the sheet's geometry there.
#[derive(Clone, Debug)]
pub(crate) struct Point<T, const N: usize> {
    pub(crate) state: State<T, N>,
    /// The tangent space: `D* D̃ = 1`, in the chart's first columns.
    pub(crate) tangent: SMatrix<T, N, N>,
    /// The velocity of the sheet where the coordinates of the chart rest.
    pub(crate) drift: SVector<T, N>,
    /// The acceleration where the coordinates of the chart do not accelerate.
    pub(crate) particular: SVector<T, N>,
    /// About the sine by which the weakest combination of constraint rows is independent
    /// of the others.
    pub(crate) sine: T,
}

impl<T: Real, const N: usize> Point<T, N> {
    pub(crate) fn zeros() -> Self {
        Self {
            state: State::default(),
            tangent: SMatrix::zeros(),
            drift: SVector::zeros(),
            particular: SVector::zeros(),
            sine: T::zero(),
        }
    }

    /// Gives the state the velocity of these coordinates in the chart.
    pub(super) fn move_along(&mut self, along: &[T; N], freedoms: usize) {
        self.state.v = self.drift;
        for (tangent, along) in self.tangent.data.0.iter().zip(along).take(freedoms) {
            add_scaled(self.state.v.as_mut_slice(), *along, tangent);
        }
    }
}

impl<T: Real, const N: usize, const R: usize> Chart<T, N, R> {
    /// The length of what two columns of matrices differ by.
    pub(crate) fn apart(&self, a: &SMatrix<T, N, N>, b: &SMatrix<T, N, N>, column: usize) -> T {
        self.length(&(SVector::from(a.data.0[column]) - SVector::from(b.data.0[column])))
    }

    /// The length of a vector in the diagonal of the metric.
    pub(crate) fn length(&self, x: &SVector<T, N>) -> T {
        let scaled = x.iter().zip(&self.column_scale);
        let sum = scaled.fold(T::zero(), |sum, (x, scale)| {
            let x = *x / *scale;
            sum + x * x
        });
        sum.sqrt()
    }

    /// `D* x`.
    pub(crate) fn coordinates(&self, x: &SVector<T, N>) -> [T; N] {
        let [x] = &x.data.0;
        let mut along = [T::zero(); N];
        for (along, dual) in along.iter_mut().zip(&self.dual.data.0[..self.freedoms]) {
            *along = dot(dual, x);
        }
        along
    }
}

/// What evaluates the sheet: a mechanism, a chart, and buffers.
pub(crate) struct Sheet<'a, T, const N: usize, const R: usize> {
    pub(crate) mechanism: &'a dyn Mechanism<T, N, R>,
    pub(crate) chart: &'a Chart<T, N, R>,
    pub(crate) position: &'a mut Position<T, N, R>,
    pub(crate) terms: &'a mut Terms<T, N, R>,
    pub(crate) frame: &'a mut Frame<T, N, R>,
    /// The nodes of the last interpolation.
    pub(crate) nodes: &'a mut Nodes<T, N>,
    /// Whether any row restricts positions.
    pub(crate) holonomic: bool,
}

impl<T: Real, const N: usize, const R: usize> Sheet<'_, T, N, R> {
    /// How many constraint rows take part.
    pub(super) fn constraints(&self) -> usize {
        N - self.chart.freedoms
    }

    /// Evaluates and eliminates the constraints at a position, in the order of another
    /// frame if there is one.
    pub(super) fn eliminate(
        &mut self,
        state: &State<T, N>,
        like: Option<&Frame<T, N, R>>,
    ) -> Result<(), Obstacle> {
        self.load(state);
        match like {
            Some(other) => self.frame.factorise_like(other),
            None => self.frame.factorise(self.constraints(), near_dependent()),
        }
        .map_err(|_| Obstacle::NotRegular)
    }

    /// The same with all rows last that could turn within a step.
    pub(super) fn eliminate_widely(&mut self, state: &State<T, N>) -> Result<(), Obstacle> {
        self.load(state);
        let result = self
            .frame
            .factorise(self.constraints(), T::from_f64(MAY_TURN));
        result.map_err(|_| Obstacle::NotRegular)
    }

    /// Evaluates the constraints at a position.
    fn load(&mut self, state: &State<T, N>) {
        self.mechanism.position(state, self.position);
        let constraints = self.constraints();
        let chart = self.chart;
        let (rows, duals) = self.frame.rows_mut().split_at_mut(constraints);
        for (target, &row) in rows.iter_mut().zip(&chart.rows) {
            let scale = chart.row_scale[row];
            for (j, (entry, column)) in target.iter_mut().zip(&chart.column_scale).enumerate() {
                *entry = scale * self.position.jacobian[(row, j)] * *column;
            }
        }
        for (target, dual) in duals.iter_mut().zip(&chart.dual.data.0) {
            for ((entry, dual), column) in target.iter_mut().zip(dual).zip(&chart.column_scale) {
                *entry = *dual * *column;
            }
        }
    }

    /// The solution of the square system for right-hand sides of the constraint rows and
    /// of the coordinates in the chart.
    pub(super) fn solve(&self, right: &SVector<T, R>, along: &[T; N]) -> SVector<T, N> {
        let mut x = self.frame.solve(&self.scaled(right, along));
        for (x, scale) in x.iter_mut().zip(&self.chart.column_scale) {
            *x *= *scale;
        }
        SVector::from(x)
    }

    /// Corrects what interpolation leaves of position and velocity in the rows that are
    /// safely independent. The near-dependent ones would magnify round-off.
    pub(super) fn polish(
        &mut self,
        point: &mut Point<T, N>,
        like: &Frame<T, N, R>,
    ) -> Result<(), Obstacle> {
        let still = [T::zero(); N];
        self.eliminate(&point.state, Some(like))?;
        let position = self.scaled(&-self.position.residual, &still);
        let velocity = -(self.position.jacobian * point.state.v + self.position.drift);
        let velocity = self.scaled(&velocity, &still);
        let (q, v) = (
            self.frame.solve_independent(&position),
            self.frame.solve_independent(&velocity),
        );
        for (j, scale) in self.chart.column_scale.iter().enumerate() {
            point.state.q[j] += *scale * q[j];
            point.state.v[j] += *scale * v[j];
        }
        Ok(())
    }

    /// Right-hand sides in the order and scale of the frame's rows.
    pub(super) fn scaled(&self, right: &SVector<T, R>, along: &[T; N]) -> [T; N] {
        let constraints = self.constraints();
        let mut all = [T::zero(); N];
        for (place, &row) in all[..constraints].iter_mut().zip(&self.chart.rows) {
            *place = self.chart.row_scale[row] * right[row];
        }
        let rest = all[constraints..].iter_mut();
        for (place, along) in rest.zip(along) {
            *place = *along;
        }
        all
    }

    /// Moves a position along the chart's complement onto the sheet, by Newton's
    /// iteration; leaves its frame.
    pub(super) fn project(
        &mut self,
        state: &mut State<T, N>,
        like: Option<&Frame<T, N, R>>,
    ) -> Result<(), Obstacle> {
        self.eliminate(state, like)?;
        self.project_from_here(state, like)
    }

    /// The same, from a position whose frame is at hand.
    fn project_from_here(
        &mut self,
        state: &mut State<T, N>,
        like: Option<&Frame<T, N, R>>,
    ) -> Result<(), Obstacle> {
        let mut before: Option<T> = None;
        for _ in 0..MAX_CORRECTIONS {
            if !self.holonomic {
                return Ok(());
            }
            let correction = self.solve(&-self.position.residual, &[T::zero(); N]);
            let size = self.chart.length(&correction);
            if !size.is_finite() {
                return Err(Obstacle::NotFinite);
            }
            let noise = round_off::<T>() * self.chart.reach / self.frame.smallest();
            if size <= noise {
                return Ok(());
            }
            if before.is_some_and(|before| size > before * contraction()) {
                // Where round-off is all that is left, it does not contract either.
                let stuck = size <= noise * critical();
                return if stuck {
                    Ok(())
                } else {
                    Err(Obstacle::NotContracting)
                };
            }
            state.q += correction;
            before = Some(size);
            self.eliminate(state, like)?;
        }
        Err(Obstacle::NotContracting)
    }

    /// The sheet's geometry at a position on it whose frame is at hand, for a velocity of
    /// these coordinates in the chart, or as it is.
    pub(super) fn measure(&mut self, along: Option<&[T; N]>, point: &mut Point<T, N>) {
        let zero = SVector::zeros();
        for i in 0..self.chart.freedoms {
            let mut unit = [T::zero(); N];
            unit[i] = T::one();
            point.tangent.data.0[i] = self.solve(&zero, &unit).data.0[0];
        }
        let still = is_zero(self.position.drift.as_slice());
        point.drift = match still {
            false => self.solve(&-self.position.drift, &[T::zero(); N]),
            true => SVector::zeros(),
        };
        if let Some(along) = along {
            point.move_along(along, self.chart.freedoms);
        }
        self.mechanism.terms(&point.state, self.terms);
        point.particular = self.solve(&self.terms.bias, &[T::zero(); N]);
        point.sine = self.frame.smallest();
    }

    /// The geometry at a state as it is.
    pub(crate) fn measure_here(
        &mut self,
        state: &State<T, N>,
        point: &mut Point<T, N>,
    ) -> Result<(), Obstacle> {
        self.eliminate(state, None)?;
        point.state = *state;
        self.measure(None, point);
        Ok(())
    }

    /// Puts a state whose frame is at hand onto the sheet where the constraints are
    /// regular.
    pub(super) fn place_regular(
        &mut self,
        state: &State<T, N>,
        point: &mut Point<T, N>,
    ) -> Result<(), Obstacle> {
        point.state = *state;
        self.project_from_here(&mut point.state, None)?;
        let along = self.chart.coordinates(&state.v);
        self.measure(Some(&along), point);
        Ok(())
    }
}
