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
use crate::linalg::{Triangle, column};
use crate::singular::Point;
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
        let unit = self.units();
        let mut triangle = Triangle::default();
        self.insert_motion(&mut triangle, &unit);
        self.insert_decided(&mut triangle, &unit, &point);
        self.insert_ideality(&mut triangle, &unit, &point);
        let (scaled, _reaction) = triangle.solve();
        Ok(self.stabilised(scaled.component_mul(&unit), state, &point))
    }

    /// What one unit of each scaled acceleration is worth: `1/√mⱼⱼ`, or one for a
    /// coordinate without inertia.
    pub(super) fn units(&self) -> SVector<T, N> {
        let unit = |j: usize| {
            let mass = self.terms.mass[(j, j)];
            if mass > T::zero() {
                T::one() / mass.sqrt()
            } else {
                T::one()
            }
        };
        SVector::from(column(unit))
    }

    /// `M q̈ + r = p₁`.
    #[inline(never)]
    fn insert_motion(&self, triangle: &mut Triangle<T, N>, unit: &SVector<T, N>) {
        for i in 0..N {
            let row = column(|j| unit[i] * self.terms.mass[(i, j)] * unit[j]);
            let mut identity = [T::zero(); N];
            identity[i] = T::one();
            triangle.insert(row, identity, unit[i] * self.terms.force[i]);
        }
    }

    /// What the constraints decide: `q̈ − aₚ` lies in the tangent space. The projection
    /// `1 − D̃D*` onto the complement has as many rows as there are coordinates.
    #[inline(never)]
    fn insert_decided(
        &self,
        triangle: &mut Triangle<T, N>,
        unit: &SVector<T, N>,
        point: &Point<T, N>,
    ) {
        let Some(chart) = &self.session.chart else {
            return;
        };
        for i in 0..N {
            let mut row = [T::zero(); N];
            row[i] = T::one();
            for k in 0..chart.freedoms {
                let share = point.tangent[(i, k)];
                for (entry, dual) in row.iter_mut().zip(&chart.dual.data.0[k]) {
                    *entry -= share * *dual;
                }
            }
            let mut value = T::zero();
            for (j, entry) in row.iter_mut().enumerate() {
                *entry *= unit[j] / unit[i];
                value += *entry / unit[j] * point.particular[j];
            }
            triangle.insert(row, [T::zero(); N], value);
        }
    }

    /// `D̃ᵀr = 0`: ideal constraints do no work in the free directions.
    #[inline(never)]
    fn insert_ideality(
        &self,
        triangle: &mut Triangle<T, N>,
        unit: &SVector<T, N>,
        point: &Point<T, N>,
    ) {
        for k in 0..self.freedoms() {
            let row = column(|j| point.tangent[(j, k)] / unit[j]);
            triangle.insert([T::zero(); N], row, T::zero());
        }
    }
}
