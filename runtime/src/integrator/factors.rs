//! The linear systems of the implicit method's Newton iteration.
//!
//! In:  derivatives of the acceleration, the step length.
//! Out: changes of the stages' accelerations.

use super::collocation::Collocation;
use super::lu::Lu;
use crate::{Real, Slope};
use nalgebra::{Complex, SVector};

/// Three vectors, one for each stage.
pub(super) type Stages<T, const N: usize> = [SVector<T, N>; 3];

/// `W` for the real and the complex eigenvalue at a step length.
#[derive(Clone, Debug)]
pub(super) struct Factors<T, const N: usize> {
    /// The step length.
    pub(super) h: T,
    /// `W` of the real eigenvalue.
    pub(super) real: Lu<T, N>,
    complex: Lu<Complex<T>, N>,
}

impl<T: Real, const N: usize> Factors<T, N> {
    /// `None` where a matrix is singular.
    pub(super) fn new(slope: &Slope<T, N>, h: T, coefficients: &Collocation<T>) -> Option<Self> {
        let zero = T::zero();
        let real = |value: T| {
            let factor = value * h;
            move |i: usize, j: usize| {
                let one = if i == j { T::one() } else { zero };
                one - slope.v[(i, j)] * factor - slope.q[(i, j)] * (factor * factor)
            }
        };
        let factor = coefficients.complex.value * h;
        let square = factor * factor;
        let complex = |i: usize, j: usize| {
            let one = if i == j { T::one() } else { zero };
            Complex::new(one, zero) - factor * slope.v[(i, j)] - square * slope.q[(i, j)]
        };
        let entry = real(coefficients.real.value);
        let matrix = core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)));
        let real = Lu::new(matrix)?;
        let matrix = core::array::from_fn(|i| core::array::from_fn(|j| complex(i, j)));
        let complex = Lu::new::<T>(matrix)?;
        Some(Self { h, real, complex })
    }

    /// The change of the stages' accelerations that removes what is left of their
    /// equations.
    pub(super) fn solve(&self, rest: &Stages<T, N>, coefficients: &Collocation<T>) -> Stages<T, N> {
        let Collocation { real, complex, .. } = coefficients;
        let zero = Complex::new(T::zero(), T::zero());
        let along = core::array::from_fn(|k| {
            (0..3).fold(T::zero(), |sum, i| sum + real.left[i] * rest[i][k])
        });
        let across = core::array::from_fn(|k| {
            (0..3).fold(zero, |sum, i| sum + complex.left[i] * rest[i][k])
        });
        let along = self.real.solve(&along);
        let across = self.complex.solve::<T>(&across);
        // The third eigenvector is the conjugate of the second.
        let two = T::from_f64(2.0);
        core::array::from_fn(|i| {
            SVector::from_fn(|k, _| {
                real.right[i] * along[k] + (complex.right[i] * across[k]).re * two
            })
        })
    }
}
