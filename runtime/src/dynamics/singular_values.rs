//! Singular values of the constraint rows in the metric.
//!
//! In:  a Jacobian, and what is known of the metric and the rows.
//! Out: [`SingularValueDecomposition`]: combinations of rows that are orthogonal, their
//!      lengths, which are the singular values, and the directions that they decide;
//!      the second derivatives of the combination that loses its gradient.
//!
//! Not here: what follows for the rank ([`super::rank`]).

use super::Core;
use super::erased::{Constrained, Known};
use super::solver::Source;
use crate::equations::At;
use crate::linalg::{
    Breakdown, Workspace, add_scaled, count_above, dot, lift_row, lift_rows, norm, orthogonalise,
    scale,
};
use crate::once::compiled_once;
use crate::tolerance::difference;
use crate::{DynamicsError, Real};

/// Rows in the metric, combined until they are orthogonal.
#[derive(Debug)]
pub(crate) struct SingularValueDecomposition<'a, T> {
    /// The directions that the combinations decide, of length one, largest first.
    directions: &'a mut [T],
    /// The combinations, as columns.
    left: &'a mut [T],
    /// Singular values.
    pub(crate) values: &'a mut [T],
    /// How many coordinates there are.
    n: usize,
}

impl<'a, T: Real> SingularValueDecomposition<'a, T> {
    /// Combines the rows of a Jacobian.
    pub(crate) fn new(
        jacobian: &[T],
        known: Known<'_, T>,
        workspace: &Workspace<'a, T>,
    ) -> Result<Self, Breakdown> {
        let r = known.r();
        let n = jacobian.len() / r;
        let directions = workspace.numbers(n * r);
        let left = workspace.numbers(r * r);
        let values = workspace.numbers(r);
        lift_rows(known.factor, jacobian, known.scale, 0..r, directions);
        for entry in left.iter_mut().step_by(r + 1) {
            *entry = T::one();
        }
        orthogonalise((directions, n), (left, r), values)?;
        for (value, column) in values.iter_mut().zip(directions.chunks_exact_mut(n)) {
            *value = norm(column);
            if *value > T::zero() {
                scale(column, T::one() / *value);
            }
        }
        Ok(Self {
            directions,
            left,
            values,
            n,
        })
    }

    /// Combines the rows of the Jacobian where the constraints were evaluated last.
    pub(crate) fn here(
        solver: &mut dyn Constrained<T>,
        t: T,
        workspace: &Workspace<'a, T>,
    ) -> Result<Self, DynamicsError<T>> {
        solver.learn().counters.rank_decisions += 1;
        let (jacobian, known) = (solver.constraints().jacobian, solver.known());
        let decomposition = Self::new(jacobian, known, workspace);
        decomposition.map_err(|Breakdown| DynamicsError::NotFinite { t })
    }

    /// How many singular values are above a bound.
    pub(crate) fn above(&self, least: T) -> usize {
        count_above(self.values, least)
    }

    /// The directions of the largest singular values, one after the other.
    pub(crate) fn decided(&self, count: usize) -> &[T] {
        &self.directions[..count * self.n]
    }

    /// A combination of rows.
    pub(crate) fn left(&self, k: usize) -> &[T] {
        let r = self.values.len();
        &self.left[k * r..(k + 1) * r]
    }

    /// Adds to `w`, along the directions of some of the combinations, what it lacks to have this
    /// right-hand side.
    pub(crate) fn decide(&self, count: usize, least: T, right: &[T], w: &mut [T]) {
        let directions = self.directions.chunks_exact(self.n);
        for (k, (value, direction)) in self.values.iter().zip(directions).enumerate().take(count) {
            if *value > least {
                let wanted = dot(self.left(k), right) / *value;
                let share = wanted - dot(direction, w);
                add_scaled(w, share, direction);
            }
        }
    }

    /// How the rows share a lifted force by the singular values above a bound, and for which of
    /// them nothing tells: those with more than some part in one of the other combinations.
    pub(crate) fn share(
        &self,
        lifted: &[T],
        (least, part): (T, T),
        shares: &mut [T],
        unknown: &mut [bool],
    ) {
        let directions = self.directions.chunks_exact(self.n);
        for (k, (value, direction)) in self.values.iter().zip(directions).enumerate() {
            if *value > least {
                add_scaled(shares, dot(direction, lifted) / *value, self.left(k));
                continue;
            }
            for (unknown, own) in unknown.iter_mut().zip(self.left(k)) {
                *unknown |= own.abs() > part;
            }
        }
    }
}

/// `U⁻¹aᵀ` for one row `a` of a Jacobian.
pub(super) fn lift<T: Real>(jacobian: &[T], known: Known<'_, T>, row: usize, lifted: &mut [T]) {
    lift_row(known.factor, jacobian, (row, known.r()), lifted);
}

/// The second derivatives, along some directions, of the combination of rows that loses its
/// gradient; leaves the constraints evaluated at the state.
pub(crate) fn second_derivatives<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    combination: &[T],
    kernel: &[T],
    second: &mut [T],
    workspace: &Workspace<'_, T>,
) {
    let n = state.q.len();
    let count = kernel.len() / n;
    let distance = difference::<T>() * solver.known().coordinate_scale.range;
    workspace.scope(|workspace| {
        let lowered = workspace.numbers(kernel.len());
        lowered.copy_from_slice(kernel);
        for column in lowered.chunks_exact_mut(n) {
            solver.known().lower(column);
        }
        let (moved, gradient) = (workspace.numbers(n), workspace.numbers(n));
        for (i, second) in second.chunks_exact_mut(count).enumerate() {
            for sign in [T::one(), -T::one()] {
                moved.copy_from_slice(state.q);
                add_scaled(moved, sign * distance, &lowered[i * n..][..n]);
                solver.locate(state.t, moved);
                let (jacobian, scale) = (solver.constraints().jacobian, solver.known().scale);
                for (entry, levers) in gradient.iter_mut().zip(jacobian.chunks_exact(scale.len())) {
                    *entry = T::zero();
                    for (lever, (part, scale)) in levers.iter().zip(combination.iter().zip(scale)) {
                        *entry += *part * *scale * sign * *lever;
                    }
                }
                for (entry, column) in second.iter_mut().zip(lowered.chunks_exact(n)) {
                    *entry += dot(gradient, column) / (distance + distance);
                }
            }
        }
    });
    solver.locate(state.t, state.q);
    make_symmetric(second, count);
}

/// Takes the mean of a matrix of `n` rows and its transpose.
fn make_symmetric<T: Real>(matrix: &mut [T], n: usize) {
    for i in 0..n {
        for j in 0..i {
            let mean = (matrix[i * n + j] + matrix[j * n + i]) * T::from_f64(0.5);
            (matrix[i * n + j], matrix[j * n + i]) = (mean, mean);
        }
    }
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Decomposes the rows of a Jacobian in the metric at hand, and does something with them.
    #[inline(never)]
    pub(crate) fn decompose(
        &mut self,
        source: Source,
        t: T,
        work: &mut dyn FnMut(&SingularValueDecomposition<'_, T>),
    ) -> Result<(), DynamicsError<T>> {
        self.counters.rank_decisions += 1;
        let (known, jacobian, workspace) = self.known(source);
        let decomposition = decomposing()(jacobian, known, &workspace);
        decomposition
            .map(|decomposition| work(&decomposition))
            .map_err(|Breakdown| DynamicsError::NotFinite { t })
    }

    /// How many singular values are above a bound.
    pub(crate) fn rank_above(
        &mut self,
        source: Source,
        t: T,
        least: T,
    ) -> Result<usize, DynamicsError<T>> {
        let mut rank = 0;
        self.decompose(source, t, &mut |decomposition| {
            rank = decomposition.above(least)
        })?;
        Ok(rank)
    }
}

compiled_once! {
    fn decomposing<T>: for<'b> fn(
        &[T],
        Known<'_, T>,
        &Workspace<'b, T>,
    ) -> Result<SingularValueDecomposition<'b, T>, Breakdown> =
        |jacobian, known, workspace| SingularValueDecomposition::new(jacobian, known, workspace);
}
