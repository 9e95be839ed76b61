//! The form with independent and dependent coordinates:
//! `DᵀMD q̈ᵢ = Dᵀ(p₁ − M q̈ₚ)`, `q̈ = q̈ₚ + D q̈ᵢ`.
//!
//! In:  the terms of a state.
//! Out: `q̈`, or an error at a singular position and near it.
//!
//! Source: Phong & Hoang (2012), eqs. 2.16–2.25, with `D = [E; −A_d⁻¹Aᵢ]`. The
//! dependent coordinates are chosen by pivoting, anew at every state, so that
//! `A_d` is as well conditioned as the position allows.

use super::Core;
use crate::linalg::{Elimination, Workspace, add_scaled, add_subspace_solution, set_units};
use crate::once::compiled_once;
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::SVector;

/// Vectors of all coordinates that the elimination has room for.
const VECTORS: usize = 3;

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// The acceleration, by elimination of the dependent coordinates.
    #[inline(never)]
    pub(super) fn partitioning(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        mechanism.terms(state, &mut self.terms);
        let bias = self.stabilised_bias(mechanism, state);
        self.require_independent_rows(mechanism, state)?;
        self.counters.cheap_accelerations += 1;
        let mut jacobian = self.terms.jacobian;
        for column in &mut jacobian.data.0 {
            for (row, entry) in column.iter_mut().enumerate() {
                *entry *= self.rows.scale[row];
            }
        }
        let mut right = self.scaled(&bias);
        let mut columns = [[T::zero(); N]; N];
        let mut vectors = [[T::zero(); N]; VECTORS];
        let mut dependent = [0; R];
        let workspace = Workspace::new(
            columns.as_flattened_mut(),
            vectors.as_flattened_mut(),
            &mut dependent,
        );
        let mut acceleration = SVector::<T, N>::zeros();
        partitioned()(
            (
                self.terms.mass.as_slice(),
                self.terms.force.as_slice(),
                self.metric.factor.as_slice(),
            ),
            (jacobian.as_mut_slice(), &mut right),
            &workspace,
            acceleration.as_mut_slice(),
        )
        .map_err(|coordinate| DynamicsError::MassSingular {
            t: state.t,
            coordinate,
            structure: mechanism.structure(),
        })?;
        Ok(acceleration)
    }
}

/// The acceleration by mass matrix, force and the factor of the metric, constraint rows and
/// their right-hand sides, which are used up; or an independent coordinate along which there is
/// no mass.
pub(crate) fn partition<'a, T: Real>(
    (mass, force, metric): (&[T], &[T], &[T]),
    (jacobian, right): (&'a mut [T], &'a mut [T]),
    workspace: &Workspace<'a, T>,
    acceleration: &mut [T],
) -> Result<(), usize> {
    let (n, rows) = (force.len(), right.len());
    let columns = workspace.numbers(n * n);
    let units = workspace.numbers(n);
    set_units(metric, units);
    let eliminated = Elimination::new(jacobian, right, units, workspace);
    // `q̈ₚ`: dependent coordinates from `p₂`, independent ones zero.
    for (j, offset) in eliminated.dependent.iter().zip(&*eliminated.offset) {
        acceleration[*j] = *offset;
    }
    let is_free = |j: &usize| !eliminated.dependent.contains(j);
    let mut count = 0;
    for independent in (0..n).filter(is_free) {
        let column = &mut columns[count * n..][..n];
        column[independent] = T::one();
        let table = &eliminated.table[independent * rows..][..rows];
        for (j, entry) in eliminated.dependent.iter().zip(table) {
            column[*j] = -*entry;
        }
        count += 1;
    }
    let rest = workspace.numbers(n);
    rest.copy_from_slice(force);
    for (j, entry) in acceleration.iter().enumerate() {
        add_scaled(rest, -*entry, &mass[j * n..][..n]);
    }
    let columns = &mut columns[..count * n];
    // `units` no longer holds the weights, and serves as room.
    add_subspace_solution(mass, columns, rest, units, acceleration)
        .map_err(|column| (0..n).filter(is_free).nth(column).unwrap_or(column))
}

compiled_once! {
    fn partitioned<T>: for<'a> fn(
        (&[T], &[T], &[T]),
        (&'a mut [T], &'a mut [T]),
        &Workspace<'a, T>,
        &mut [T],
    ) -> Result<(), usize> = partition;
}
