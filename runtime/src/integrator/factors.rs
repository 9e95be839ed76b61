//! The linear systems of the implicit method's Newton iteration.
//!
//! In:  derivatives of the acceleration, the step length.
//! Out: changes of the stages' accelerations.

use super::collocation::{Collocation, MOST_PAIRS};
use super::lu::Lu;
use crate::{AccelerationJacobian, Real};
use nalgebra::{Complex, SVector};

/// A vector for each stage.
pub(super) type StageVectors<T, const N: usize, const S: usize> = [SVector<T, N>; S];

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
    pub(super) fn new<const S: usize>(
        jacobian: &AccelerationJacobian<T, N>,
        h: T,
        coefficients: &Collocation<T, S>,
    ) -> Option<Self> {
        let zero = T::zero();
        let factor = coefficients.real.value * h;
        let real = |i: usize, j: usize| {
            let one = if i == j { T::one() } else { zero };
            one - jacobian.v[(i, j)] * factor - jacobian.q[(i, j)] * (factor * factor)
        };
        let matrix = core::array::from_fn(|i| core::array::from_fn(|j| real(i, j)));
        let real = Lu::new(matrix)?;
        let mut complex = [const { None }; MOST_PAIRS];
        let used = coefficients.complex.iter().take(coefficients.pairs);
        for (place, eigen) in complex.iter_mut().zip(used) {
            let factor = eigen.value * h;
            let square = factor * factor;
            let entry = |i: usize, j: usize| {
                let one = if i == j { T::one() } else { zero };
                Complex::new(one, zero) - factor * jacobian.v[(i, j)] - square * jacobian.q[(i, j)]
            };
            let matrix = core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)));
            *place = Some(Lu::new::<T>(matrix)?);
        }
        Some(Self { h, real, complex })
    }

    /// The change of the stages' accelerations that removes what is left of their
    /// equations.
    pub(super) fn solve<const S: usize>(
        &self,
        rest: &StageVectors<T, N, S>,
        coefficients: &Collocation<T, S>,
    ) -> StageVectors<T, N, S> {
        let Collocation { real, complex, .. } = coefficients;
        let zero = Complex::new(T::zero(), T::zero());
        let along = core::array::from_fn(|k| {
            (0..S).fold(T::zero(), |sum, i| sum + real.left[i] * rest[i][k])
        });
        let along = self.real.solve(&along);
        let mut change: StageVectors<T, N, S> =
            core::array::from_fn(|i| SVector::from_fn(|k, _| real.right[i] * along[k]));
        for (eigen, factors) in complex.iter().zip(self.complex.iter().flatten()) {
            let across = core::array::from_fn(|k| {
                (0..S).fold(zero, |sum, i| sum + eigen.left[i] * rest[i][k])
            });
            let across = factors.solve::<T>(&across);
            // The other eigenvector of the pair is the conjugate.
            let two = T::from_f64(2.0);
            for (i, change) in change.iter_mut().enumerate() {
                for (k, entry) in change.iter_mut().enumerate() {
                    *entry += (eigen.right[i] * across[k]).re * two;
                }
            }
        }
        change
    }
}
