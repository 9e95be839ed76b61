//! The linear systems of the implicit method's Newton iteration.
//!
//! In:  derivatives of the acceleration, the step length.
//! Out: changes of the stages' accelerations.

use super::collocation::{Collocation, MOST_PAIRS, MOST_STAGES};
use super::lu::Lu;
use crate::{AccelerationJacobian, Real};
use nalgebra::{Complex, SVector};

/// A vector for each stage, with room for those of the largest method.
pub(super) type StageVectors<T, const N: usize> = [SVector<T, N>; MOST_STAGES];

/// `W` for the real and the complex eigenvalues at a step length.
#[derive(Clone, Debug)]
pub(super) struct Factors<T, const N: usize> {
    /// The step length.
    pub(super) h: T,
    /// `W` of the real eigenvalue.
    pub(super) real: Lu<T, N>,
    complex: [Option<Lu<Complex<T>, N>>; MOST_PAIRS],
}

impl<T: Real, const N: usize> Factors<T, N> {
    /// `None` where a matrix is singular.
    #[inline(never)]
    pub(super) fn new(
        jacobian: &AccelerationJacobian<T, N>,
        h: T,
        coefficients: &Collocation<T>,
    ) -> Option<Self> {
        let factor = coefficients.real.value * h;
        let mut matrix = [[T::zero(); N]; N];
        for (i, row) in matrix.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let one = if i == j { T::one() } else { T::zero() };
                let (by_q, by_v) = (jacobian.q[(i, j)], jacobian.v[(i, j)]);
                *entry = one - by_v * factor - by_q * (factor * factor);
            }
        }
        let real = Lu::new(matrix)?;
        let mut complex = [const { None }; MOST_PAIRS];
        let used = coefficients.complex.iter().take(coefficients.pairs);
        for (place, eigen) in complex.iter_mut().zip(used) {
            let factor = eigen.value * h;
            let square = factor * factor;
            let mut matrix = [[Complex::new(T::zero(), T::zero()); N]; N];
            for (i, row) in matrix.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    let one = if i == j { T::one() } else { T::zero() };
                    let (by_q, by_v) = (jacobian.q[(i, j)], jacobian.v[(i, j)]);
                    *entry = Complex::new(one, T::zero()) - factor * by_v - square * by_q;
                }
            }
            *place = Some(Lu::new::<T>(matrix)?);
        }
        Some(Self { h, real, complex })
    }

    /// The change of the stages' accelerations that removes what is left of their
    /// equations.
    #[inline(never)]
    pub(super) fn solve(
        &self,
        rest: &StageVectors<T, N>,
        coefficients: &Collocation<T>,
    ) -> StageVectors<T, N> {
        let Collocation { real, complex, .. } = coefficients;
        let stages = coefficients.stages;
        let mut along = [T::zero(); N];
        for (left, rest) in real.left[..stages].iter().zip(rest) {
            for k in 0..N {
                along[k] += *left * rest[k];
            }
        }
        let along = self.real.solve(&along);
        let mut change = [SVector::zeros(); MOST_STAGES];
        for (right, change) in real.right[..stages].iter().zip(&mut change) {
            for k in 0..N {
                change[k] = *right * along[k];
            }
        }
        // The other eigenvector of a pair is the conjugate.
        let two = T::from_f64(2.0);
        for (eigen, factors) in complex.iter().zip(self.complex.iter().flatten()) {
            let mut across = [Complex::new(T::zero(), T::zero()); N];
            for (left, rest) in eigen.left[..stages].iter().zip(rest) {
                for k in 0..N {
                    across[k] += *left * rest[k];
                }
            }
            let across = factors.solve::<T>(&across);
            for (right, change) in eigen.right[..stages].iter().zip(&mut change) {
                for k in 0..N {
                    change[k] += (*right * across[k]).re * two;
                }
            }
        }
        change
    }
}
