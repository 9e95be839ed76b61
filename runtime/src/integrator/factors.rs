//! The linear systems of the implicit method's Newton iteration.
//!
//! In:  derivatives of the acceleration, the step length.
//! Out: changes of the stages' accelerations.

use super::collocation::{Collocation, Eigen, MOST_PAIRS, by_stage, weigh};
use super::lu::{Entry, factorise, solve};
use crate::Real;
use crate::linalg::{Workspace, column};
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
    /// `W` of one complex eigenvalue of each pair, by rows.
    complex: &'a mut [Complex<T>],
    /// The orders of the rows of all these matrices.
    orders: &'a mut [usize],
    /// Room for two vectors for each complex eigenvalue.
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

    /// The factors over slices, with room for two vectors for each complex eigenvalue.
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
        let sizes = workspace.any(n);
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

    /// The change of the accelerations `a` of `S` stages that removes what is left of their
    /// equations, where the states of the stages have the accelerations `found`; with room
    /// for two vectors.
    #[inline(always)]
    pub(super) fn solve<'b, const S: usize>(
        &'b mut self,
        (a, found): (&[T], &[T]),
        (along, solved): (&mut [T], &'b mut [T]),
        coefficients: &'b Collocation<T>,
    ) -> Changes<'b, T> {
        let n = solved.len();
        let along = &mut along[..n];
        let Collocation { real, complex, .. } = coefficients;
        let (across, out) = self.across.split_at_mut(MOST_PAIRS * n);
        let (first, second) = across.split_at_mut(n);
        let (a, found) = (by_stage::<T, S>(a, n), by_stage::<T, S>(found, n));
        for k in 0..n {
            let rest: [T; S] = column(|i| found[i][k] - a[i][k]);
            along[k] = weigh(&real.left, &rest, T::zero());
            first[k] = share(&complex[0], &rest);
            if S > 3 {
                second[k] = share(&complex[1], &rest);
            }
        }
        solve(self.real, &self.orders[..n], along, solved);
        for pair in 0..S / 2 {
            let factors = &self.complex[pair * n * n..][..n * n];
            let order = &self.orders[(pair + 1) * n..][..n];
            let (across, out) = (&across[pair * n..], &mut out[pair * n..]);
            solve::<T, _>(factors, order, across, out);
        }
        let (first, second) = out.split_at(n);
        Changes {
            coefficients,
            real: solved,
            complex: [first, &second[..n]],
        }
    }
}

/// Changes of the accelerations of all stages, along the eigenvectors.
pub(super) struct Changes<'a, T> {
    coefficients: &'a Collocation<T>,
    real: &'a [T],
    complex: [&'a [Complex<T>]; MOST_PAIRS],
}

impl<T: Real> Changes<'_, T> {
    /// What is added to component `k` of the accelerations.
    #[inline(always)]
    pub(super) fn at<const S: usize>(&self, k: usize) -> [T; S] {
        let Collocation { real, complex, .. } = self.coefficients;
        let two = T::from_f64(2.0);
        let mut change = [T::zero(); S];
        for (change, right) in change.iter_mut().zip(&real.right) {
            *change = *right * self.real[k];
        }
        // The other eigenvector of a pair is the conjugate.
        for (eigen, solved) in complex.iter().zip(&self.complex).take(S / 2) {
            for (change, right) in change.iter_mut().zip(&eigen.right) {
                *change += (*right * solved[k]).re * two;
            }
        }
        change
    }
}

/// The share of an eigenvector in one component of all stages.
#[inline(always)]
fn share<T: Real, const S: usize>(eigen: &Eigen<Complex<T>>, rest: &[T; S]) -> Complex<T> {
    let mut sum = Complex::new(T::zero(), T::zero());
    for (left, rest) in eigen.left.iter().zip(rest) {
        sum += *left * *rest;
    }
    sum
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
    for j in 0..n {
        let (by_q, by_v) = (&by_q[j * n..][..n], &by_v[j * n..][..n]);
        for i in 0..n {
            let unit = if i == j { one } else { zero };
            out[i * n + j] = unit - factor * by_v[i] - square * by_q[i];
        }
    }
}
