//! The linear systems of the implicit method's Newton iteration.
//!
//! In:  derivatives of the acceleration, the step length.
//! Out: changes of the stages' accelerations.

use super::collocation::{Collocation, MOST_PAIRS, by_stage, weigh};
use super::lu::{Entry, factorise, solve};
use crate::Real;
use crate::linalg::Workspace;
use core::ops::Mul;
use nalgebra::Complex;

/// Memory for the factors of `W` for `N` coordinates.
#[derive(Clone, Debug)]
pub(super) struct FactorRoom<T, const N: usize> {
    real: [[T; N]; N],
    complex: [[[Complex<T>; N]; N]; MOST_PAIRS],
    orders: [[usize; N]; MOST_PAIRS + 1],
}

/// `W` for the real and the complex eigenvalues at a step length, over slices.
pub(super) struct Factors<'a, T> {
    /// `W` of the real eigenvalue, by rows.
    real: &'a mut [T],
    /// Those of the complex ones.
    complex: &'a mut [Complex<T>],
    /// The orders of the rows of all.
    orders: &'a mut [usize],
    /// Room for two vectors.
    across: &'a mut [Complex<T>],
}

impl<T: Real, const N: usize> FactorRoom<T, N> {
    pub(super) fn new() -> Self {
        let zero = Complex::new(T::zero(), T::zero());
        Self {
            real: [[T::zero(); N]; N],
            complex: [[[zero; N]; N]; MOST_PAIRS],
            orders: [[0; N]; MOST_PAIRS + 1],
        }
    }

    /// The same over slices, with room for two vectors.
    pub(super) fn factors<'a>(&'a mut self, across: &'a mut [Complex<T>]) -> Factors<'a, T> {
        Factors {
            real: self.real.as_flattened_mut(),
            complex: self.complex.as_flattened_mut().as_flattened_mut(),
            orders: self.orders.as_flattened_mut(),
            across,
        }
    }
}

impl<T: Real> Factors<'_, T> {
    /// Factorises for a step length, from `∂q̈/∂q` and `∂q̈/∂q̇`, column by column; `false`
    /// where a matrix is singular.
    pub(super) fn factorise(
        &mut self,
        derivatives: (&[T], &[T]),
        h: T,
        coefficients: &Collocation<T>,
        workspace: &Workspace<'_, T>,
    ) -> bool {
        let n = self.orders.len() / (MOST_PAIRS + 1);
        let sizes = workspace.numbers(n);
        let (zero, one) = (T::zero(), T::one());
        let (order, orders) = self.orders.split_at_mut(n);
        let factor = coefficients.real.value * h;
        set_matrix(self.real, n, derivatives, factor, (zero, one));
        if !factorise(self.real, order, sizes) {
            return false;
        }
        let (zero, one) = (Complex::new(zero, zero), Complex::new(one, zero));
        for (i, eigen) in coefficients.complex[..coefficients.pairs]
            .iter()
            .enumerate()
        {
            let matrix = &mut self.complex[i * n * n..][..n * n];
            set_matrix(matrix, n, derivatives, eigen.value * h, (zero, one));
            if !factorise(matrix, &mut orders[i * n..][..n], sizes) {
                return false;
            }
        }
        true
    }

    /// `x = W⁻¹ y` of the real eigenvalue.
    pub(super) fn solve_real(&self, y: &[T], x: &mut [T]) {
        solve(self.real, &self.orders[..y.len()], y, x);
    }

    /// The change of the stages' accelerations that removes what is left of their
    /// equations; with room for two vectors.
    pub(super) fn solve(
        &mut self,
        (rest, change): (&[T], &mut [T]),
        (along, solved): (&mut [T], &mut [T]),
        coefficients: &Collocation<T>,
    ) {
        let n = along.len();
        let Collocation { real, complex, .. } = coefficients;
        let stages = coefficients.stages;
        let rest = by_stage(rest, n);
        for (k, along) in along.iter_mut().enumerate() {
            *along = weigh(&real.left, &rest, k, T::zero());
        }
        self.solve_real(along, solved);
        for (i, right) in real.right[..stages].iter().enumerate() {
            for (change, solved) in change[i * n..][..n].iter_mut().zip(&*solved) {
                *change = *right * *solved;
            }
        }
        // The other eigenvector of a pair is the conjugate.
        let two = T::from_f64(2.0);
        let (across, solved) = self.across.split_at_mut(n);
        for (pair, eigen) in complex[..coefficients.pairs].iter().enumerate() {
            for (k, across) in across.iter_mut().enumerate() {
                *across = Complex::new(T::zero(), T::zero());
                for (left, rest) in eigen.left.iter().zip(&rest) {
                    *across += *left * rest[k];
                }
            }
            let factors = &self.complex[pair * n * n..][..n * n];
            let order = &self.orders[(pair + 1) * n..][..n];
            solve::<T, _>(factors, order, across, solved);
            for (i, right) in eigen.right[..stages].iter().enumerate() {
                for (change, solved) in change[i * n..][..n].iter_mut().zip(&*solved) {
                    *change += (*right * *solved).re * two;
                }
            }
        }
    }
}

/// `W(λ) = 1 − λ h ∂q̈/∂q̇ − λ² h² ∂q̈/∂q`, by rows, for `factor` = `λ h`.
fn set_matrix<T: Real, F: Entry<T> + Mul<T, Output = F>>(
    out: &mut [F],
    n: usize,
    (by_q, by_v): (&[T], &[T]),
    factor: F,
    (zero, one): (F, F),
) {
    let square = factor * factor;
    for (i, row) in out.chunks_exact_mut(n.max(1)).enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            let unit = if i == j { one } else { zero };
            *entry = unit - factor * by_v[j * n + i] - square * by_q[j * n + i];
        }
    }
}
