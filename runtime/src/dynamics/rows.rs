//! What is known about the constraint equations as rows of `A`.
//!
//! In:  `A` at the states that were visited, in the metric of the kinetic energy.
//! Out: a reference size for each row, how many rows are independent at regular
//!      positions, and a subset that is.
//!
//! The reference size makes a rank decision free of units: a row of a planar loop
//! vanishes at a singular position, so comparing it with itself would show
//! nothing, and comparing it with other rows would compare metres with radians.
//! It is compared with the largest size it had so far.

use crate::linalg::{Workspace, independent_columns, lift_rows};
use crate::tolerance::{disproportionate, negligible, regular};
use crate::{Real, Structure};

/// Chooses the rows that are the most independent for a Jacobian, in the metric and of size one,
/// holonomic ones first, so that the first of the chosen rows span the holonomic ones; whether
/// there are as many whose distance from those before them is above a bound.
fn choose_most_independent<T: Real>(
    factor: &[T],
    jacobian: &[T],
    (sizes, holonomic): (&[T], &[bool]),
    (chosen, least): (&mut [usize], T),
    workspace: &Workspace<'_, T>,
) -> bool {
    let r = sizes.len();
    workspace.scope(|workspace| {
        let vectors = workspace.any(jacobian.len());
        let n = vectors.len() / r;
        lift_rows(factor, jacobian, sizes, 0..r, vectors);
        let first = |row: usize| holonomic[row];
        independent_columns(vectors, n, &first, least, chosen) == chosen.len()
    })
}

/// Sizes, weights and choice of rows.
#[derive(Clone, Debug)]
pub(crate) struct Rows<T, const R: usize> {
    /// Squared reference sizes.
    pub(crate) size: [T; R],
    /// Bound on the ratio of a row's squared sizes with and without the coupling of the
    /// coordinates by M; beyond it M is nearly singular, and the size is ignored.
    coupling: [T; R],
    /// The inverses of the squared reference sizes; infinite for a row that was never anything but
    /// zero, and one for a row that emitted code leaves out.
    pub(crate) inverse_size: [T; R],
    /// What rows are multiplied by to have size one; zero for a row that was never anything but
    /// zero.
    pub(crate) scale: [T; R],
    /// Weights `W` of the rows in an augmented metric; zero until known.
    pub(crate) weight: [T; R],
    /// Whether the weights are those of the heaviest masses.
    uneven: bool,
    /// Which rows restrict positions.
    pub(crate) holonomic: [bool; R],
    /// Whether the rows are independent at all positions, by their form.
    pub(crate) by_form: bool,
    /// The rows that emitted code leaves out.
    left_out: &'static [usize],
    active: [usize; R],
    active_count: usize,
    holonomic_count: usize,
    /// Rank of `A` at regular positions, as far as it is known.
    pub(crate) regular: usize,
}

impl<T: Real, const R: usize> Rows<T, R> {
    /// Rows of which nothing is known but what a structure says: which of them restrict
    /// positions, all of those that are not listed, whether they are independent by their form, and
    /// which of them emitted code leaves out.
    pub(crate) fn new(structure: &Structure) -> Self {
        let mut rows = Self {
            size: [T::zero(); R],
            coupling: [T::from_f64(f64::INFINITY); R],
            inverse_size: [T::one() / T::zero(); R],
            scale: [T::zero(); R],
            weight: [T::zero(); R],
            uneven: false,
            holonomic: [true; R],
            by_form: structure.independent,
            left_out: structure.redundant,
            active: [0; R],
            active_count: 0,
            holonomic_count: 0,
            regular: 0,
        };
        for (holonomic, constraint) in rows.holonomic.iter_mut().zip(structure.constraints) {
            *holonomic = constraint.holonomic;
        }
        // They may be zero wherever the constraints hold, and say nothing of dependence.
        for row in rows.left_out {
            rows.inverse_size[*row] = T::one();
        }
        rows
    }

    /// Takes note of the squared size of a row, which is `Σ aⱼ²/mⱼⱼ` in the metric of each
    /// coordinate alone.
    #[inline]
    pub(crate) fn observe(&mut self, row: usize, size: T, alone: impl FnOnce() -> T) {
        if size > self.size[row] {
            let alone = match self.coupling[row].is_finite() {
                true => alone(),
                false => T::zero(),
            };
            self.grow(row, size, alone);
        }
    }

    #[cold]
    #[inline(never)]
    fn grow(&mut self, row: usize, size: T, alone: T) {
        self.view().observe(row, size, alone);
    }

    /// Whether no row was never anything but zero.
    #[inline]
    pub(crate) fn all_have_sizes(&self) -> bool {
        self.size.iter().all(|size| *size > T::zero())
    }

    /// Whether all rows are independent at regular positions.
    #[inline]
    pub(crate) fn all_independent(&self) -> bool {
        self.regular == R
    }

    /// Whether the rows that emitted code solves with are as many as are independent at regular
    /// positions.
    #[inline]
    pub(crate) fn solves_all(&self) -> bool {
        self.regular + self.left_out.len() == R
    }

    /// An independent subset that spans all rows at regular positions, if one is
    /// known.
    #[inline]
    pub(crate) fn active(&self, which: Which) -> Option<([usize; R], usize)> {
        let count = match which {
            Which::All => self.active_count,
            Which::Holonomic => self.holonomic_count,
        };
        (self.active_count == self.regular && self.regular > 0).then_some((self.active, count))
    }

    /// An independent subset that spans all rows at regular positions, if one is known: of
    /// redundant rows, those that are the most independent for a Jacobian, where that can be told
    /// by the factor of the metric.
    pub(crate) fn most_independent(
        &self,
        factor: &[T],
        jacobian: &[T],
        workspace: &Workspace<'_, T>,
    ) -> Option<([usize; R], usize)> {
        let (known, count) = self.active(Which::All)?;
        let mut chosen = known;
        let others = !self.all_independent() && {
            let rows = (&self.scale[..], &self.holonomic[..]);
            let chosen = (&mut chosen[..count], regular());
            choose_most_independent(factor, jacobian, rows, chosen, workspace)
        };
        Some((if others { chosen } else { known }, count))
    }

    /// Takes note of the weights of rows in an augmented metric.
    pub(crate) fn weigh(&mut self, inertia: &[T], jacobian: &[T]) {
        if !self.uneven {
            weigh(&mut self.weight, inertia, jacobian);
        }
    }

    /// The rows over slices, to be changed.
    pub(crate) fn view(&mut self) -> RowsView<'_, T> {
        RowsView {
            size: &mut self.size,
            coupling: &mut self.coupling,
            inverse_size: &mut self.inverse_size,
            scale: &mut self.scale,
            left_out: self.left_out,
            weight: &mut self.weight,
            uneven: &mut self.uneven,
            holonomic: &self.holonomic,
            active: &mut self.active,
            active_count: &mut self.active_count,
            holonomic_count: &mut self.holonomic_count,
            regular: &mut self.regular,
        }
    }
}

/// [`Rows`] over slices, to be changed.
pub(crate) struct RowsView<'a, T> {
    size: &'a mut [T],
    coupling: &'a mut [T],
    inverse_size: &'a mut [T],
    scale: &'a mut [T],
    left_out: &'static [usize],
    weight: &'a mut [T],
    uneven: &'a mut bool,
    holonomic: &'a [bool],
    active: &'a mut [usize],
    active_count: &'a mut usize,
    holonomic_count: &'a mut usize,
    regular: &'a mut usize,
}

impl<T: Real> RowsView<'_, T> {
    /// Takes note of the squared size of a row, and of that in the metric of each coordinate
    /// alone.
    pub(crate) fn observe(&mut self, row: usize, size: T, alone: T) {
        let coupling = self.coupling[row];
        let size = match coupling.is_finite() {
            true => size.min(coupling * alone),
            false => size,
        };
        if size.is_finite() && size > self.size[row] {
            self.size[row] = size;
            if !self.left_out.contains(&row) {
                self.inverse_size[row] = T::one() / size;
            }
            self.scale[row] = T::one() / size.sqrt();
        }
    }

    /// The squared size of a row beyond this many times that in the metric of each
    /// coordinate alone is due to a mass matrix that is nearly singular, and does not count.
    pub(crate) fn expect_coupling(&mut self, row: usize, coupling: T) {
        self.coupling[row] = coupling;
    }

    /// Whether all rows are independent at regular positions.
    pub(crate) fn all_independent(&self) -> bool {
        *self.regular == self.holonomic.len()
    }

    /// An independent subset that spans all rows at regular positions, empty where none is
    /// known.
    pub(crate) fn active(&self) -> &[usize] {
        match *self.active_count == *self.regular {
            true => &self.active[..*self.active_count],
            false => &[],
        }
    }

    /// Takes note that all rows are independent.
    pub(crate) fn observe_all(&mut self) {
        self.observe_rank(self.holonomic.len());
    }

    /// Takes note that this many rows are independent.
    pub(crate) fn observe_rank(&mut self, rank: usize) {
        *self.regular = rank;
        if self.all_independent() {
            // Holonomic rows come first.
            *self.active_count = 0;
            for wanted in [true, false] {
                for (row, holonomic) in self.holonomic.iter().enumerate() {
                    if *holonomic == wanted {
                        self.active[*self.active_count] = row;
                        *self.active_count += 1;
                    }
                }
            }
            self.count_holonomic();
        }
    }

    /// Chooses the active subset for a Jacobian at a regular position.
    pub(crate) fn choose(&mut self, factor: &[T], jacobian: &[T], workspace: &Workspace<'_, T>) {
        workspace.scope(|workspace| {
            let count = *self.regular;
            let chosen = workspace.indices(count);
            let (rows, most) = ((&*self.scale, self.holonomic), (&mut *chosen, negligible()));
            // In a singular configuration there are too few: then the rows chosen before stay.
            if choose_most_independent(factor, jacobian, rows, most, workspace) {
                self.active[..count].copy_from_slice(chosen);
                *self.active_count = count;
                self.count_holonomic();
            }
        });
    }

    fn count_holonomic(&mut self) {
        let active = &self.active[..*self.active_count];
        *self.holonomic_count = active.iter().filter(|&&row| self.holonomic[row]).count();
    }

    /// Gives rows the weights of the heaviest masses, if the masses differ so much that rows look
    /// dependent which are not, as the squares of the entries of `A` and the inertia of the
    /// coordinates show; whether rows have these weights.
    pub(crate) fn weigh_unevenly(
        &mut self,
        levers: &[T],
        inertia: &[T],
        workspace: &Workspace<'_, T>,
    ) -> bool {
        workspace.scope(|workspace| {
            let r = self.weight.len();
            let largest = workspace.numbers(r);
            for (levers, inertia) in levers.chunks_exact(r).zip(inertia) {
                for (largest, lever) in largest.iter_mut().zip(levers) {
                    *largest = largest.max(*lever / *inertia);
                }
            }
            let mut least = T::one();
            for (levers, inertia) in levers.chunks_exact(r).zip(inertia) {
                // A short lever may hardly count in one row and matter in another: the latter
                // decides.
                let mut best = T::zero();
                for (largest, lever) in largest.iter().zip(levers) {
                    if *largest > T::zero() {
                        best = best.max(*lever / *inertia / *largest);
                    }
                }
                // An entry that is round-off tells nothing.
                if best > T::EPSILON * T::EPSILON {
                    least = least.min(best);
                }
            }
            self.weigh_down(largest, least);
        });
        *self.uneven
    }

    /// The weights of the heaviest masses, from the largest shares of the rows and the least
    /// part of one that matters.
    fn weigh_down(&mut self, largest: &[T], least: T) {
        *self.uneven = least < disproportionate::<T>() * disproportionate();
        if *self.uneven {
            let least = least.max(T::EPSILON.sqrt());
            for (weight, largest) in self.weight.iter_mut().zip(largest) {
                *weight = match *largest > T::zero() {
                    true => disproportionate::<T>() / (least * *largest),
                    false => T::zero(),
                };
            }
        }
    }

    /// Forgets the weights of the heaviest masses.
    pub(crate) fn weigh_evenly(&mut self) {
        *self.uneven = false;
        self.weight.fill(T::zero());
    }
}

/// Gives rows the weights `1 / Σ aⱼ²/mⱼⱼ`, so that the row weighs as much as the masses it
/// connects. Coordinates without inertia count as if they had the largest: where a row restricts
/// hardly anything else, it would weigh as much as one likes. Where a row vanishes the weight stays
/// what it was.
fn weigh<T: Real>(weights: &mut [T], inertia: &[T], jacobian: &[T]) {
    let r = weights.len();
    let heaviest = inertia.iter().fold(T::zero(), |most: T, m| most.max(*m));
    let heaviest = if heaviest > T::zero() {
        heaviest
    } else {
        T::one()
    };
    for (row, known) in weights.iter_mut().enumerate() {
        let mut sum = T::zero();
        for (levers, inertia) in jacobian.chunks_exact(r).zip(inertia) {
            let inertia = if *inertia > T::zero() {
                *inertia
            } else {
                heaviest
            };
            sum += levers[row] * levers[row] / inertia;
        }
        let weight = T::one() / sum;
        let lighter = *known > T::zero() && *known < weight;
        if weight.is_finite() && !lighter {
            *known = weight;
        }
    }
}

/// Which rows are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Which {
    /// All rows of `A`.
    All,
    /// The rows that restrict positions.
    Holonomic,
}
