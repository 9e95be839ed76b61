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
use crate::linalg::{Elimination, Workspace, add_product, project_onto};
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::SVector;

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
        let right = self.scaled(&bias);
        let mut acceleration = self.terms.force;
        let solved = solve(
            self.terms.mass.as_slice(),
            (self.terms.jacobian.as_slice(), self.rows.scales().0),
            &right,
            acceleration.as_mut_slice(),
            &self.memory.workspace(),
        );
        match solved {
            Ok(()) => Ok(acceleration),
            Err(coordinate) => Err(DynamicsError::MassSingular {
                t: state.t,
                coordinate,
                structure: mechanism.structure(),
            }),
        }
    }
}

/// Replaces a force by the acceleration; the coordinate along which the mass matrix is
/// singular, where there is one.
fn solve<T: Real>(
    mass: &[T],
    (jacobian, scale): (&[T], &[T]),
    right: &[T],
    force: &mut [T],
    workspace: &Workspace<'_, T>,
) -> Result<(), usize> {
    let (n, r) = (force.len(), right.len());
    let (table, offset) = (workspace.numbers(n * r), workspace.numbers(r));
    for (entry, (lever, scale)) in table
        .iter_mut()
        .zip(jacobian.iter().zip(scale.iter().cycle()))
    {
        *entry = *lever * *scale;
    }
    offset.copy_from_slice(right);
    let (unit, particular) = (workspace.numbers(n), workspace.numbers(n));
    units(mass, unit);
    let eliminated = Elimination::new(table, offset, unit, workspace);
    // `q̈ₚ`: dependent coordinates from `p₂`, independent ones zero.
    for (j, offset) in eliminated.dependent.iter().zip(&*eliminated.offset) {
        particular[*j] = *offset;
    }
    let columns = workspace.numbers(n * (n - eliminated.dependent.len()));
    for (column, independent) in columns.chunks_exact_mut(n).zip(independent(&eliminated, n)) {
        column[independent] = T::one();
        for (k, &j) in eliminated.dependent.iter().enumerate() {
            column[j] = -eliminated.entry(k, independent);
        }
    }
    add_product(force, -T::one(), mass, particular);
    project_onto(mass, columns, force, workspace)
        .map_err(|column| independent(&eliminated, n).nth(column).unwrap_or(column))?;
    for (entry, particular) in force.iter_mut().zip(particular) {
        *entry += *particular;
    }
    Ok(())
}

/// The coordinates that are not dependent, of `n`: those that move in a column of `D` and in
/// no other.
fn independent<T: Real>(eliminated: &Elimination<'_, T>, n: usize) -> impl Iterator<Item = usize> {
    (0..n).filter(|j| !eliminated.dependent.contains(j))
}

/// What one unit of each scaled acceleration is worth: `1/√mⱼⱼ`, or one for a
/// coordinate without inertia.
pub(super) fn units<T: Real>(mass: &[T], units: &mut [T]) {
    let diagonal = mass.iter().step_by(units.len() + 1);
    for (unit, mass) in units.iter_mut().zip(diagonal) {
        *unit = match *mass > T::zero() {
            true => T::one() / mass.sqrt(),
            false => T::one(),
        };
    }
}
