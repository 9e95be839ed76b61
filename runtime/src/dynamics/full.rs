//! The full form: least squares on `B y = f` for `y = (q̈, r)`.
//!
//! In:  the terms of a state, the tangent space of its sheet.
//! Out: the `q̈` of `[M E; A 0; 0 Dᵀ] y = [p₁; p₂; 0]`, where the rows `A q̈ = p₂` are
//!      those that keep `q̈` on the sheet, singular configurations included.
//!
//! Source: Phong & Hoang (2012), eqs. 3.9–3.11. They solve the normal equations;
//! here the rows go into a triangular factor one by one, because `BᵀB` squares the
//! condition number. Accelerations and forces are scaled by the diagonal of the
//! mass matrix, so that the result does not depend on units.

use super::Core;
use super::partitioning::units;
use crate::linalg::{Triangle, Workspace, add_scaled};
use crate::singular::{Obstacle, Point};
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::SVector;

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
        if self.session.near || !self.measure_here(mechanism, state, &mut point) {
            self.place(mechanism, state, &mut point)?;
        }
        self.counters.robust_accelerations += 1;
        mechanism.terms(&point.state, &mut self.terms);
        let Some(chart) = &self.session.chart else {
            return Err(self.refusal(mechanism, Obstacle::Undetermined, state.t));
        };
        let sheet = Tangent {
            tangent: &point.tangent.as_slice()[..N * chart.freedoms],
            dual: &chart.dual.as_slice()[..N * chart.freedoms],
            particular: point.particular.as_slice(),
        };
        let mut acceleration = self.terms.force;
        let (mass, force) = (self.terms.mass.as_slice(), acceleration.as_mut_slice());
        solve(mass, &sheet, force, &self.memory.workspace());
        Ok(self.stabilised(acceleration, state, &point))
    }
}

/// What the constraints decide at a point of a sheet.
struct Tangent<'a, T> {
    tangent: &'a [T],
    dual: &'a [T],
    particular: &'a [T],
}

/// Replaces a force by the acceleration.
fn solve<T: Real>(
    mass: &[T],
    sheet: &Tangent<'_, T>,
    force: &mut [T],
    workspace: &Workspace<'_, T>,
) {
    let n = force.len();
    let unit = workspace.numbers(n);
    units(mass, unit);
    let mut triangle = Triangle::zeros(n, workspace);
    insert_motion(&mut triangle, mass, unit, force);
    insert_decided(&mut triangle, unit, sheet, workspace.numbers(n));
    // `D̃ᵀr = 0`: ideal constraints do no work in the free directions.
    for tangent in sheet.tangent.chunks_exact(n) {
        for ((_, b), (entry, unit)) in triangle.row().zip(tangent.iter().zip(&*unit)) {
            *b = *entry / *unit;
        }
        triangle.insert(T::zero());
    }
    let (scaled, _reaction) = triangle.solve();
    for (entry, (scaled, unit)) in force.iter_mut().zip(scaled.iter().zip(unit)) {
        *entry = *scaled * *unit;
    }
}

/// `M q̈ + r = p₁`.
fn insert_motion<T: Real>(triangle: &mut Triangle<'_, T>, mass: &[T], unit: &[T], force: &[T]) {
    for (i, column) in mass.chunks_exact(unit.len()).enumerate() {
        for (j, (a, b)) in triangle.row().enumerate() {
            *a = unit[i] * column[j] * unit[j];
            if j == i {
                *b = T::one();
            }
        }
        triangle.insert(unit[i] * force[i]);
    }
}

/// What the constraints decide: `q̈ − aₚ` lies in the tangent space. The projection
/// `1 − D̃D*` onto the complement has as many rows as there are coordinates.
fn insert_decided<T: Real>(
    triangle: &mut Triangle<'_, T>,
    unit: &[T],
    sheet: &Tangent<'_, T>,
    row: &mut [T],
) {
    let n = unit.len();
    for i in 0..n {
        row.fill(T::zero());
        row[i] = T::one();
        let duals = sheet.dual.chunks_exact(n);
        for (tangent, dual) in sheet.tangent.chunks_exact(n).zip(duals) {
            add_scaled(row, -tangent[i], dual);
        }
        let mut value = T::zero();
        for (j, (a, _)) in triangle.row().enumerate() {
            *a = row[j] * (unit[j] / unit[i]);
            value += *a / unit[j] * sheet.particular[j];
        }
        triangle.insert(value);
    }
}
