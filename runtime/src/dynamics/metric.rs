//! The metric of the kinetic energy, in which all lengths and angles are taken.
//!
//! In:  `M` (`N × N`), and `A`, `p₁`, `p₂` where `M` alone is not definite.
//! Out: its Cholesky factor `U`; `p₁` to go with it.
//!
//! A mass matrix may be semi-definite (Euler parameters, coordinates without
//! inertia) as long as `M` and `A` have no common null direction. `M + AᵀWA` with
//! `p₁ + AᵀWp₂` has the same solutions and is definite; the weights `W` are made
//! of diagonals, so that neither part drowns the other. Where the mechanism names the rows
//! that are needed, only those take part: emitted code does the same.
//!
//! Nor is `M` alone a good metric where a row connects masses that differ by many
//! orders of magnitude: what the lightest contributes to `A M⁻¹ Aᵀ` drowns the rest,
//! and rows look dependent that are not. With weights of the heaviest masses,
//! `M + AᵀWA` brings all contributions to one size.

use super::Rows;
use crate::linalg::{Cholesky, NotDefinite, diagonal};
use crate::{Counters, Real, Structure};
use nalgebra::{SMatrix, SVector};

/// Part of the largest inertia of a coordinate that it has in addition in the metric of a chart:
/// with all of it, driven cranks without mass end in errors at tight tolerances; without, they
/// and points without mass are missed or lost where they are in line.
const IN_ADDITION: f64 = 0.05;

/// Which constraint rows take part in the metric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Takes {
    None,
    /// The rows that the mechanism names.
    Named,
    All,
}

/// What takes part in the metric.
#[derive(Clone, Debug)]
pub(crate) struct Parts {
    /// Which constraints take part. Once all had to, all always do: the metric must not change back
    /// and forth along a motion.
    takes: Takes,
    /// The rows that the mechanism names.
    named: &'static [usize],
    /// Whether the mechanism says that the metric with these rows is singular at some positions.
    degenerates: bool,
    /// Whether the factor belongs to the mass matrix of this binding.
    current: bool,
}

impl Parts {
    /// Lets all constraints take part from now on.
    pub(crate) fn augment(&mut self) {
        self.takes = Takes::All;
    }

    /// Whether the metric is `M` alone.
    pub(crate) fn is_mass_matrix(&self) -> bool {
        self.takes == Takes::None
    }

    /// Whether a constraint row takes part.
    fn take(&self, row: usize) -> bool {
        match self.takes {
            Takes::None => false,
            Takes::Named => self.named.contains(&row),
            Takes::All => true,
        }
    }

    /// Adds `AᵀWA` of the rows that take part to `M`.
    fn add_to<T: Real>(&self, sum: &mut [T], jacobian: &[T], weights: &[T]) {
        let r = weights.len();
        let n = jacobian.len() / r;
        for (row, weight) in weights.iter().enumerate() {
            if !self.take(row) {
                continue;
            }
            let columns = || jacobian.chunks_exact(r);
            for (sums, levers) in sum.chunks_exact_mut(n).zip(columns()) {
                let share = *weight * levers[row];
                for (sum, levers) in sums.iter_mut().zip(columns()) {
                    *sum += share * levers[row];
                }
            }
        }
    }
}

/// Takes note of how much inertia coordinates have, if it is more than before.
fn observe<T: Real>(inertia: &mut [T], mass: &[T]) {
    let diagonal = mass.iter().step_by(inertia.len() + 1);
    for (inertia, mass) in inertia.iter_mut().zip(diagonal) {
        if *mass > *inertia && mass.is_finite() {
            *inertia = *mass;
        }
    }
}

/// [`Metric::hides_dependence`].
fn hides_dependence<T: Real>(parts: &Parts, inertia: &[T]) -> bool {
    parts.degenerates || parts.takes != Takes::None && inertia.contains(&T::zero())
}

/// The pivots of a factor, relative to the diagonal of the matrix; those of coordinates without
/// inertia as they are, for what rows give such a coordinate may all vanish at once.
fn pivot_ratios<T: Real>(factor: &[T], inertia: &[T]) -> impl Iterator<Item = T> {
    let n = inertia.len();
    let pivots = factor.iter().step_by(n + 1);
    let pairs = pivots.zip(diagonal(factor, n)).zip(inertia);
    pairs.map(|((root, diagonal), inertia)| match *inertia > T::zero() {
        true => *root * *root / diagonal,
        false => *root * *root,
    })
}

/// The factorised metric.
#[derive(Clone, Debug)]
pub(crate) struct Metric<T, const N: usize> {
    pub(crate) factor: Cholesky<T, N>,
    parts: Parts,
    /// The largest inertia that each coordinate had: that of an Euler parameter
    /// vanishes at some positions, which says nothing about its scale.
    inertia: [T; N],
    /// The largest of the [`pivot_ratios`] so far.
    ratios: [T; N],
}

/// What is known of the metric, over slices, to be changed.
pub(crate) struct MetricView<'a, T> {
    pub(crate) parts: &'a mut Parts,
    pub(crate) factor: &'a [T],
    /// The largest inertia that each coordinate had.
    pub(crate) inertia: &'a mut [T],
    ratios: &'a mut [T],
}

impl<T: Real> MetricView<'_, T> {
    /// Begins anew, with the named rows in it.
    pub(crate) fn begin(&mut self, structure: &'static Structure) {
        let named = structure.weighed;
        *self.parts = Parts {
            takes: match named {
                [] => Takes::None,
                _ => Takes::Named,
            },
            named,
            degenerates: structure.metric_degenerates,
            current: false,
        };
        self.inertia.fill(T::zero());
        self.ratios.fill(T::zero());
    }

    /// Takes note of how much inertia the coordinates have.
    pub(crate) fn observe(&mut self, mass: &[T]) {
        observe(self.inertia, mass);
    }

    /// Takes note of how large the pivots are where it is factorised, if they are to be known.
    pub(crate) fn observe_pivots(&mut self) {
        if !hides_dependence(self.parts, self.inertia) {
            return;
        }
        let ratios = pivot_ratios(self.factor, self.inertia);
        for (largest, ratio) in self.ratios.iter_mut().zip(ratios) {
            *largest = largest.max(ratio);
        }
    }
}

impl<T: Real, const N: usize> Default for Metric<T, N> {
    fn default() -> Self {
        Self {
            factor: Cholesky::default(),
            parts: Parts {
                takes: Takes::None,
                named: &[],
                degenerates: false,
                current: false,
            },
            inertia: [T::zero(); N],
            ratios: [T::zero(); N],
        }
    }
}

impl<T: Real, const N: usize> Metric<T, N> {
    /// What is known, over slices.
    pub(crate) fn view(&mut self) -> MetricView<'_, T> {
        MetricView {
            parts: &mut self.parts,
            factor: self.factor.as_slice(),
            inertia: &mut self.inertia,
            ratios: &mut self.ratios,
        }
    }

    /// Whether the metric is the one that emitted code uses.
    pub(crate) fn is_emitted(&self) -> bool {
        self.parts.takes != Takes::All
    }

    /// Forgets a constant mass matrix, whose parameters may have changed.
    pub(crate) fn forget(&mut self) {
        self.parts.current = false;
    }

    /// Factorises the metric; once only if `constant` says that `M` never changes.
    pub(crate) fn factorise<const R: usize>(
        &mut self,
        mass: &SMatrix<T, N, N>,
        jacobian: &SMatrix<T, R, N>,
        rows: &mut Rows<T, R>,
        constant: bool,
        counters: &mut Counters,
    ) -> Result<(), NotDefinite> {
        if constant && self.parts.current && self.parts.takes == Takes::None {
            return Ok(());
        }
        counters.mass_factorisations += 1;
        if self.parts.takes == Takes::None {
            match self.factor.factorise(mass) {
                Ok(()) => {
                    self.parts.current = true;
                    return Ok(());
                }
                // Rows are of no help where they hold nothing.
                Err(error) if R == 0 || self.parts.degenerates => return Err(error),
                Err(_) => self.parts.augment(),
            }
        }
        observe(&mut self.inertia, mass.as_slice());
        rows.weigh(&self.inertia, jacobian.as_slice());
        let result = self.factor.factorise(&self.sum(mass, jacobian, rows));
        if result.is_ok() || self.parts.takes != Takes::Named {
            return result;
        }
        self.parts.augment();
        let result = self.factor.factorise(&self.sum(mass, jacobian, rows));
        if result.is_err() {
            // No rows help here, and the named ones suffice elsewhere.
            self.parts.takes = Takes::Named;
        }
        result
    }

    /// Whether constraints may become dependent without a row that shows it: where some
    /// coordinates have no inertia but what constraints give them, it is the metric that
    /// degenerates.
    pub(crate) fn hides_dependence(&self) -> bool {
        hides_dependence(&self.parts, &self.inertia)
    }

    /// The factor of the metric of a chart, if that is another one: where the metric degenerates as
    /// constraints become dependent, a part of the largest inertia that each coordinate had is
    /// added to it. Lengths in it change as little across a singular configuration as the sheet
    /// does.
    pub(crate) fn of_chart<const R: usize>(
        &self,
        mass: &SMatrix<T, N, N>,
        jacobian: &SMatrix<T, R, N>,
        rows: &Rows<T, R>,
    ) -> Result<Option<Cholesky<T, N>>, NotDefinite> {
        if !self.hides_dependence() {
            return Ok(None);
        }
        let mut sum = self.sum(mass, jacobian, rows);
        for (k, (inertia, pivot)) in self.inertia.iter().zip(&self.ratios).enumerate() {
            let most = match *inertia > T::zero() {
                true => *inertia,
                false => *pivot,
            };
            sum[(k, k)] += most * T::from_f64(IN_ADDITION);
        }
        let mut factor = Cholesky::default();
        factor.factorise(&sum)?;
        Ok(Some(factor))
    }

    /// The smallest pivot of the metric, relative to the diagonal and to the largest such ratio so
    /// far: of the order of the squared sine of constraints that become dependent.
    pub(crate) fn smallest_pivot(&self) -> T {
        let pairs = pivot_ratios(self.factor.as_slice(), &self.inertia).zip(&self.ratios);
        pairs.fold(T::one(), |least, (ratio, largest)| {
            least.min(ratio / *largest)
        })
    }

    /// `M + AᵀWA` of the rows that take part.
    #[inline(never)]
    fn sum<const R: usize>(
        &self,
        mass: &SMatrix<T, N, N>,
        jacobian: &SMatrix<T, R, N>,
        rows: &Rows<T, R>,
    ) -> SMatrix<T, N, N> {
        let mut sum = *mass;
        self.parts
            .add_to(sum.as_mut_slice(), jacobian.as_slice(), &rows.weight);
        sum
    }

    /// A force `p₁`, or `p₁ + AᵀWp₂` where the constraints take part in the metric.
    #[inline]
    pub(crate) fn force<const R: usize>(
        &self,
        force: &SVector<T, N>,
        jacobian: &SMatrix<T, R, N>,
        bias: &SVector<T, R>,
        rows: &Rows<T, R>,
    ) -> [T; N] {
        let mut force = force.data.0[0];
        if self.parts.takes != Takes::None {
            for row in (0..R).filter(|row| self.parts.take(*row)) {
                let share = rows.weight[row] * bias[row];
                for (j, entry) in force.iter_mut().enumerate() {
                    *entry += share * jacobian[(row, j)];
                }
            }
        }
        force
    }

    /// `U⁻¹aᵀ` for one row `a` of a matrix: its components in coordinates in which
    /// the kinetic energy is half the square of the velocity.
    #[inline]
    pub(crate) fn lift<const R: usize>(&self, matrix: &SMatrix<T, R, N>, row: usize) -> [T; N] {
        let mut lifted = [T::zero(); N];
        for (j, entry) in lifted.iter_mut().enumerate() {
            *entry = matrix[(row, j)];
        }
        self.factor.forward(&mut lifted);
        lifted
    }
}
