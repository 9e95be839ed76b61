//! The full form: least squares on `B y = f` for `y = (q̈, r)`.
//!
//! In:  the terms of a state, the tangent space of its sheet.
//! Out: the `q̈` of `[M E; A 0; 0 Dᵀ] y = [p₁; p₂; 0]`, where the rows `A q̈ = p₂` are
//!      those that keep `q̈` on the sheet, singular configurations included.
//!
//! Source: Phong & Hoang (2012), eqs. 3.9–3.11. They solve the normal equations;
//! here the rows go into a triangular factor one by one, because `BᵀB` squares the
//! condition number. Accelerations and forces are scaled by the diagonal of the metric, so
//! that the result does not depend on units, nor on where an Euler parameter has no inertia.

use super::Core;
use crate::linalg::{Triangle, Workspace, add_scaled, set_units};
use crate::once::compiled_once;
use crate::singular::Point;
use crate::{DynamicsError, Mechanism, Real, Stabilisation, State};
use nalgebra::SVector;

/// Vectors of all coordinates that the least squares have room for.
const VECTORS: usize = 5;

/// What the rows of the least squares are made of, over slices.
pub(crate) struct Squares<'a, T> {
    mass: &'a [T],
    force: &'a [T],
    /// The triangular factor of the metric.
    metric: &'a [T],
    /// `D̃`, and `D*`, which measures the coordinates in the chart.
    tangent: &'a [T],
    dual: &'a [T],
    /// The acceleration that the constraints demand.
    particular: &'a [T],
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// The acceleration by least squares.
    #[inline(never)]
    pub(super) fn full(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        if self.settings.published {
            return self.published(mechanism, state);
        }
        self.require_chart(mechanism, state)?;
        let mut point = Point::zeros();
        // Baumgarte's gains need to know how far off the sheet a state is.
        let is_off = matches!(self.settings.stabilisation, Stabilisation::Baumgarte { .. });
        if is_off || self.session.near || !self.measure_here(mechanism, state, &mut point) {
            self.place(mechanism, state, &mut point)?;
        }
        self.counters.robust_accelerations += 1;
        mechanism.terms(&point.state, &mut self.terms);
        let mut columns = [[[T::zero(); N]; N]; 2];
        let [tangent, dual] = columns.each_mut().map(|it| it.as_flattened_mut());
        if let Some(chart) = &self.session.chart {
            chart.view().spread(point.tangent.as_slice(), tangent);
            let view = chart.view();
            view.spread(view.dual, dual);
        }
        let squares = Squares {
            mass: self.terms.mass.as_slice(),
            force: self.terms.force.as_slice(),
            metric: self.metric.factor.as_slice(),
            tangent: &tangent[..N * self.freedoms()],
            dual,
            particular: point.particular.as_slice(),
        };
        let mut matrices = [[[T::zero(); N]; N]; 3];
        let mut vectors = [[T::zero(); N]; VECTORS];
        let workspace = Workspace::new(
            matrices.as_flattened_mut().as_flattened_mut(),
            vectors.as_flattened_mut(),
            &mut [],
        );
        let mut acceleration = SVector::<T, N>::zeros();
        least_squares()(&squares, &workspace, acceleration.as_mut_slice());
        Ok(self.stabilised(acceleration, state, &point))
    }
}

impl<T: Real> Squares<'_, T> {
    /// The acceleration of least squares.
    pub(crate) fn solve(&self, workspace: &Workspace<'_, T>, acceleration: &mut [T]) {
        let n = acceleration.len();
        let mut triangle = Triangle::new(n, workspace);
        let (a, b) = (workspace.numbers(n), workspace.numbers(n));
        let unit = workspace.numbers(n);
        set_units(self.metric, unit);
        self.insert_motion(&mut triangle, unit, (a, b));
        self.insert_decided(&mut triangle, unit, (a, b));
        self.insert_ideality(&mut triangle, unit, (a, b));
        let (scaled, _reaction) = triangle.solve();
        for ((acceleration, scaled), unit) in acceleration.iter_mut().zip(scaled).zip(&*unit) {
            *acceleration = *scaled * *unit;
        }
    }

    /// `M q̈ + r = p₁`, each row times the unit of its coordinate, in which all accelerations
    /// and forces are.
    fn insert_motion(
        &self,
        triangle: &mut Triangle<'_, T>,
        unit: &[T],
        (a, b): (&mut [T], &mut [T]),
    ) {
        let n = unit.len();
        for (i, force) in self.force.iter().enumerate() {
            for (j, entry) in a.iter_mut().enumerate() {
                *entry = unit[i] * self.mass[j * n + i] * unit[j];
            }
            b.fill(T::zero());
            b[i] = T::one();
            triangle.insert(a, b, unit[i] * *force);
        }
    }

    /// What the constraints decide: `q̈ − aₚ` lies in the tangent space. The projection
    /// `1 − D̃D*` onto the complement has as many rows as there are coordinates.
    fn insert_decided(
        &self,
        triangle: &mut Triangle<'_, T>,
        unit: &[T],
        (a, b): (&mut [T], &mut [T]),
    ) {
        let n = unit.len();
        for i in 0..n {
            a.fill(T::zero());
            b.fill(T::zero());
            a[i] = T::one();
            let columns = self.tangent.chunks_exact(n).zip(self.dual.chunks_exact(n));
            for (tangent, dual) in columns {
                add_scaled(a, -tangent[i], dual);
            }
            let mut value = T::zero();
            for (j, entry) in a.iter_mut().enumerate() {
                *entry *= unit[j] / unit[i];
                value += *entry / unit[j] * self.particular[j];
            }
            triangle.insert(a, b, value);
        }
    }

    /// `D̃ᵀr = 0`: ideal constraints do no work in the free directions.
    fn insert_ideality(
        &self,
        triangle: &mut Triangle<'_, T>,
        unit: &[T],
        (a, b): (&mut [T], &mut [T]),
    ) {
        for tangent in self.tangent.chunks_exact(unit.len().max(1)) {
            a.fill(T::zero());
            for ((entry, tangent), unit) in b.iter_mut().zip(tangent).zip(unit) {
                *entry = *tangent / *unit;
            }
            triangle.insert(a, b, T::zero());
        }
    }
}

compiled_once! {
    fn least_squares<T>: fn(&Squares<'_, T>, &Workspace<'_, T>, &mut [T]) =
        |squares, workspace, acceleration| squares.solve(workspace, acceleration);
}
