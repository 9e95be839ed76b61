//! The full form: least squares on `B y = f` for `y = (q̈, r)`.
//!
//! In:  the terms of a state.
//! Out: the `q̈` of `[M E; A 0; 0 Dᵀ] y = [p₁; p₂; 0]`.
//!
//! Source: Phong & Hoang (2012), eqs. 3.9–3.11. They solve the normal equations;
//! here the rows go into a triangular factor one by one, because `BᵀB` squares the
//! condition number. Accelerations and forces are scaled by the diagonal of the
//! mass matrix, so that the result does not depend on units.

use super::{Known, Solver, Source, Tangent, Which};
use crate::linalg::{Triangle, dot, guard, passes};
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::SVector;

impl<T: Real, const N: usize, const R: usize> Solver<T, N, R> {
    /// The acceleration by least squares.
    pub(super) fn full<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let (mut state, mut known) = (*state, Known::Rank);
        mechanism.terms(&state, &mut self.terms);
        let squared = self.factorise_terms(mechanism, &state)?;
        self.begin(squared);
        if self.near || !passes(squared, guard()) {
            (state, known) = self.landed(mechanism, &state)?;
        }
        self.counters.robust_accelerations += 1;
        let decided = self.singular_acceleration(mechanism, &state, known)?;
        mechanism.terms(&state, &mut self.terms);
        let bias = self.stabilised_bias(mechanism, &state);
        self.safe = None;
        self.factorise_metric(mechanism, Source::Terms, state.t)?;
        let mut tangent = Tangent::default();
        let all = Which::All;
        self.tangent(mechanism, &state, Source::Terms, all, known, &mut tangent)?;
        let unit = self.units();
        let mut triangle = Triangle::default();
        self.insert_motion(&mut triangle, &unit);
        if tangent.strong == self.rows.regular(Which::All) {
            self.insert_rows(&mut triangle, &unit, &bias);
        } else {
            self.insert_decided(&mut triangle, &unit, &tangent, &decided);
        }
        self.insert_ideality(&mut triangle, &unit, &tangent);
        let (scaled, _reaction) = triangle.solve();
        Ok(scaled.component_mul(&unit))
    }

    /// What one unit of each scaled acceleration is worth: `1/√mⱼⱼ`, or one for a
    /// coordinate without inertia.
    fn units(&self) -> SVector<T, N> {
        SVector::from_fn(|j, _| {
            let mass = self.terms.mass[(j, j)];
            if mass > T::zero() {
                T::one() / mass.sqrt()
            } else {
                T::one()
            }
        })
    }

    /// `M q̈ + r = p₁`.
    fn insert_motion(&self, triangle: &mut Triangle<T, N>, unit: &SVector<T, N>) {
        for i in 0..N {
            let row = core::array::from_fn(|j| unit[i] * self.terms.mass[(i, j)] * unit[j]);
            let mut identity = [T::zero(); N];
            identity[i] = T::one();
            triangle.insert(row, identity, unit[i] * self.terms.force[i]);
        }
    }

    /// `A q̈ = p₂`, where all rows count.
    fn insert_rows(
        &self,
        triangle: &mut Triangle<T, N>,
        unit: &SVector<T, N>,
        bias: &SVector<T, R>,
    ) {
        for (row, value) in self.scaled(bias).into_iter().enumerate() {
            let scale = self.rows.scale(row);
            let entry = |j| scale * self.terms.jacobian[(row, j)] * unit[j];
            triangle.insert(core::array::from_fn(entry), [T::zero(); N], value);
        }
    }

    /// What rows and branch rows decide in their place, where some rows vanish.
    fn insert_decided(
        &self,
        triangle: &mut Triangle<T, N>,
        unit: &SVector<T, N>,
        tangent: &Tangent<T, N, R>,
        decided: &SVector<T, N>,
    ) {
        let w = self.metric.factor.transposed_product(&decided.data.0[0]);
        for direction in tangent.decided() {
            let mut row = self.metric.factor.product(direction);
            for j in 0..N {
                row[j] *= unit[j];
            }
            triangle.insert(row, [T::zero(); N], dot(direction, &w));
        }
    }

    /// `Dᵀr = 0`: ideal constraints do no work in the free directions.
    fn insert_ideality(
        &self,
        triangle: &mut Triangle<T, N>,
        unit: &SVector<T, N>,
        tangent: &Tangent<T, N, R>,
    ) {
        let (free, count) = tangent.free();
        for direction in &free.data.0[..count] {
            let motion = self.lower(*direction);
            let row = core::array::from_fn(|j| motion[j] / unit[j]);
            triangle.insert([T::zero(); N], row, T::zero());
        }
    }
}
