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
use super::place::Placement;
use super::sheet::Point;
use crate::dynamics::{Combined, Core, Source, Which};
use crate::linalg::{
    add_scaled, column, count_above, dot, eigen, is_zero, norm, orthonormal, remove, scaled,
};
use crate::tolerance::{critical, difference, passes, regular, round_off, window};
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::{SMatrix, SVector};

/// A sheet is meant if the state is nearer to it than to the other by this factor.
const NEARER: f64 = 4.0;
/// A velocity that is not so much nearer to one sheet than to the other is off both.
const CLEARLY_NEARER: f64 = 1e3;
/// Part of a displacement that the gradient which is lost is at least, where it returns.
const RETURNS: f64 = 1e-2;
/// Eigenvalues of `H` below this part of the largest are zero.
const FLAT: f64 = 0.1;

/// Where a motion begins.
pub(crate) enum Start<T, const N: usize, const R: usize> {
    /// On this sheet.
    Sheet(Chart<T, N, R>),
    /// In a singular configuration in which nothing tells which sheet is meant.
    Undetermined,
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// The chart of the sheet that a motion begins on.
    pub(crate) fn start_at(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<Start<T, N, R>, DynamicsError<T>> {
        self.prepare(mechanism, state)?;
        mechanism.position(state, &mut self.position);
        self.safe = None;
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        let mut squared = self.factorise_constraints(Source::Position, Which::All);
        if !passes(squared, window()) && self.rows.regular(Which::All) < R {
            self.choose_rows();
            squared = self.factorise_constraints(Source::Position, Which::All);
        }
        let count = N - self.rows.regular(Which::All);
        let tangent = if passes(squared, window()) {
            self.null_space(count)
        } else {
            match self.singular_tangent(mechanism, state, count)? {
                Some(tangent) => tangent,
                None => return Ok(Start::Undetermined),
            }
        };
        Ok(match self.chart(mechanism, state, tangent, count) {
            Some(chart) => Start::Sheet(chart),
            None => Start::Undetermined,
        })
    }

    /// A chart at a state whose metric is factorised.
    pub(crate) fn chart(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        tangent: SMatrix<T, N, N>,
        freedoms: usize,
    ) -> Option<Chart<T, N, R>> {
        let (metric, rows) = (&self.metric, &self.rows);
        let mut chart = Chart::new(
            state,
            tangent,
            freedoms,
            metric,
            (rows, &self.position.jacobian),
            (self.reach, &self.sizes, self.accepted()),
        )?;
        mechanism.position(state, &mut self.position);
        if !is_zero(self.position.drift.as_slice()) {
            let mut point = Point::zeros();
            let placed = self.place_on(mechanism, &chart, state, &mut point);
            if placed.is_ok() {
                chart.set_drift(point.drift, T::zero());
            }
        }
        Some(chart)
    }

    /// What the factorised constraints leave free, in the first columns.
    fn null_space(&self, count: usize) -> SMatrix<T, N, N> {
        let zero = SVector::zeros();
        self.free(count, |axis| self.lifted.correct(axis, &zero))
    }

    /// Directions that are left when `remove` takes away what is decided, lowered.
    fn free(&self, count: usize, remove: impl Fn(&mut [T; N])) -> SMatrix<T, N, N> {
        let mut free = orthonormal(count, remove);
        for column in &mut free.data.0[..count] {
            self.metric.factor.backward(column);
        }
        free
    }

    /// The tangent space in a singular configuration or next to one.
    #[inline(never)]
    fn singular_tangent(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        freedoms: usize,
    ) -> Result<Option<SMatrix<T, N, N>>, DynamicsError<T>> {
        let combined = self.combine(Source::Position, Which::All, state.t)?;
        let count = N - freedoms;
        if count_above(&combined.values[..count], regular()) == count {
            let decided = &combined.directions.data.0[..count];
            return Ok(Some(self.free(freedoms, |axis| remove(axis, decided))));
        }
        let still = is_zero(self.position.drift.as_slice());
        let along = self.tangent_along(mechanism, state, freedoms)?;
        if along.is_some() {
            return Ok(along);
        }
        let near = combined.values[..count]
            .iter()
            .filter(|value| **value < window());
        if near.count() != 1 || !self.rows.all_holonomic() || !still {
            return Ok(None);
        }
        self.one_of_two(mechanism, state, &combined, freedoms)
    }

    /// The tangent space of the sheet that the velocity leads along: on it, the gradient
    /// that is lost returns in the direction of the sheet's normal. `None` where the
    /// velocity leads along the singular set, or is zero.
    #[inline(never)]
    fn tangent_along(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        freedoms: usize,
    ) -> Result<Option<SMatrix<T, N, N>>, DynamicsError<T>> {
        let speed = self.metric.factor.length(&state.v.data.0[0]);
        if speed == T::zero() {
            return Ok(None);
        }
        let span = difference::<T>() * self.reach / speed;
        let mut best = (difference::<T>() * T::from_f64(RETURNS), None);
        for span in [span, -span] {
            let moved = State::new(state.t + span, state.q + state.v * span, state.v);
            mechanism.position(&moved, &mut self.position);
            self.factorise_metric(mechanism, Source::Position, state.t)?;
            let combined = self.combine(Source::Position, Which::All, state.t)?;
            let count = N - freedoms;
            let least = combined.values[..count]
                .iter()
                .fold(T::one(), |a, b| a.min(*b));
            if least > best.0 {
                let decided = &combined.directions.data.0[..count];
                best = (
                    least,
                    Some(self.free(freedoms, |axis| remove(axis, decided))),
                );
            }
        }
        mechanism.position(state, &mut self.position);
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        Ok(best.1)
    }

    /// The tangent space of one of two sheets that cross.
    #[inline(never)]
    fn one_of_two(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        combined: &Combined<T, N, R>,
        freedoms: usize,
    ) -> Result<Option<SMatrix<T, N, N>>, DynamicsError<T>> {
        let strong = &combined.directions.data.0[..N - freedoms - 1];
        let kernel = orthonormal(freedoms + 1, |axis| remove(axis, strong));
        let second = self.second_derivatives(mechanism, state, combined, &kernel, freedoms + 1);
        let Some(normals) = normals(&second, freedoms + 1) else {
            return Ok(None);
        };
        let velocity = self.metric.factor.transposed_product(&state.v.data.0[0]);
        let mut sheets = [SMatrix::zeros(); 2];
        let mut away = [T::zero(); 2];
        for ((sheet, away), normal) in sheets.iter_mut().zip(&mut away).zip(&normals) {
            let mut across = [T::zero(); N];
            for (share, axis) in normal.iter().zip(&kernel.data.0) {
                add_scaled(&mut across, *share, axis);
            }
            *away = dot(&across, &velocity).abs();
            *sheet = self.free(freedoms, |axis| {
                remove(axis, strong);
                remove(axis, &[across]);
            });
        }
        let speed = norm(&velocity);
        let crosses = larger(away) > regular::<T>() * speed;
        let by_velocity = nearer(away, T::from_f64(CLEARLY_NEARER)).filter(|_| crosses);
        let distances = self.distances(mechanism, state, &sheets, freedoms)?;
        // Distances that are nothing but round-off tell nothing.
        let least = match crosses {
            true => regular(),
            false => round_off::<T>() * critical(),
        };
        let known = distances.filter(|away| larger(*away) > least * self.reach);
        let by_position = known.map(|away| nearer(away, T::from_f64(NEARER)));
        let meant = match (by_velocity, by_position) {
            (Some(one), None) => Some(one),
            (None, Some(other)) => other,
            (one, other) if Some(one) == other => one,
            _ => None,
        };
        Ok(meant.map(|meant| sheets[meant]))
    }

    /// How far a state is off two sheets; `None` where that can't be told.
    #[inline(never)]
    fn distances(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        sheets: &[SMatrix<T, N, N>; 2],
        freedoms: usize,
    ) -> Result<Option<[T; 2]>, DynamicsError<T>> {
        let mut distances = [T::zero(); 2];
        let mut known = true;
        for (sheet, distance) in sheets.iter().zip(&mut distances) {
            let mut point = Point::zeros();
            let chart = self.chart(mechanism, state, *sheet, freedoms);
            let placed = chart.as_ref().map(|chart| {
                let placed = self.place_on(mechanism, chart, state, &mut point);
                *distance = chart.view().length((point.state.q - state.q).as_slice());
                placed
            });
            known &= matches!(placed, Some(Ok(Placement::Crossing { .. })));
            mechanism.position(state, &mut self.position);
            self.factorise_metric(mechanism, Source::Position, state.t)?;
        }
        Ok(known.then_some(distances))
    }

    /// The second derivatives, along some directions, of the combination of rows that
    /// loses its gradient.
    #[inline(never)]
    pub(crate) fn second_derivatives(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        combined: &Combined<T, N, R>,
        kernel: &SMatrix<T, N, N>,
        count: usize,
    ) -> [[T; N]; N] {
        let distance = difference::<T>() * self.reach;
        let weakest = N - count;
        let mut lowered = *kernel;
        for column in &mut lowered.data.0[..count] {
            self.metric.factor.backward(column);
        }
        let mut second = [[T::zero(); N]; N];
        for (i, second) in second.iter_mut().enumerate().take(count) {
            for sign in [T::one(), -T::one()] {
                let moved = state.q + SVector::from(lowered.data.0[i]) * (sign * distance);
                let moved = State::new(state.t, moved, state.v);
                mechanism.position(&moved, &mut self.position);
                for row in 0..R {
                    let share = combined.left[(row, weakest)] * self.rows.scale(row) * sign;
                    for (entry, column) in second.iter_mut().zip(&lowered.data.0[..count]) {
                        let mut along = T::zero();
                        for (j, lever) in column.iter().enumerate() {
                            along += self.position.jacobian[(row, j)] * *lever;
                        }
                        *entry += share * along / (distance + distance);
                    }
                }
            }
        }
        mechanism.position(state, &mut self.position);
        let half = T::from_f64(0.5);
        let mut symmetric = second;
        for (i, row) in symmetric.iter_mut().enumerate() {
            *row = column(|j| (second[i][j] + second[j][i]) * half);
        }
        symmetric
    }
}

/// The normals of two sheets from the second derivatives; none where these are not of
/// that kind.
#[inline(never)]
fn normals<T: Real, const N: usize>(second: &[[T; N]; N], count: usize) -> Option<[[T; N]; 2]> {
    let (values, vectors) = eigen(*second, count);
    let (mut up, mut down) = (0, 0);
    for k in 0..count {
        if values[k] > values[up] {
            up = k;
        }
        if values[k] < values[down] {
            down = k;
        }
    }
    let most = values[up].max(-values[down]);
    let flat = most * T::from_f64(FLAT);
    let others = (0..count).filter(|k| *k != up && *k != down);
    let curved = others.fold(T::zero(), |most: T, k| most.max(values[k].abs()));
    // False for NaN, too.
    let two =
        values[up] > flat * flat / most && -values[down] > flat * flat / most && curved <= flat;
    if !two {
        return None;
    }
    let (more, less) = (values[up].sqrt(), (-values[down]).sqrt());
    Some([less, -less].map(|less| {
        let mut normal = scaled(more, &vectors[up]);
        add_scaled(&mut normal, less, &vectors[down]);
        let size = norm(&normal);
        scaled(T::one() / size, &normal)
    }))
}

fn larger<T: Real>([first, second]: [T; 2]) -> T {
    first.max(second)
}

/// Which of two distances is smaller by this factor, if one is.
fn nearer<T: Real>([first, second]: [T; 2], factor: T) -> Option<usize> {
    if first * factor < second {
        Some(0)
    } else if second * factor < first {
        Some(1)
    } else {
        None
    }
}
