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

use crate::Real;
use crate::linalg::{column, independent_rows};
use crate::tolerance::{disproportionate, negligible};
use nalgebra::SMatrix;

/// Sizes, weights and choice of rows.
#[derive(Clone, Debug)]
pub(crate) struct Rows<T, const R: usize> {
    /// Squared reference sizes.
    size: [T; R],
    /// The largest ratio of squared sizes with and without coupling that counts.
    coupling: [T; R],
    /// Their inverses.
    inverse_size: [T; R],
    /// What rows are multiplied by to have size one.
    scale: [T; R],
    /// Weights `W` of the rows in an augmented metric; zero until known.
    weight: [T; R],
    /// Whether they are those of the heaviest masses.
    uneven: bool,
    holonomic: [bool; R],
    /// Whether they are independent at all positions, by their form.
    by_form: bool,
    active: [usize; R],
    active_count: usize,
    holonomic_count: usize,
    /// Rank of `A` at regular positions, as far as it is known.
    regular: usize,
    holonomic_regular: usize,
}

impl<T: Real, const R: usize> Rows<T, R> {
    /// Rows of which nothing is known but which of them restrict positions, and whether they
    /// are independent by their form.
    pub(crate) fn new(holonomic: impl Fn(usize) -> bool, by_form: bool) -> Self {
        Self {
            size: [T::zero(); R],
            coupling: [T::from_f64(f64::INFINITY); R],
            inverse_size: [T::one() / T::zero(); R],
            scale: [T::zero(); R],
            weight: [T::zero(); R],
            uneven: false,
            holonomic: column(holonomic),
            by_form,
            active: column(|row| row),
            active_count: 0,
            holonomic_count: 0,
            regular: 0,
            holonomic_regular: 0,
        }
    }

    /// Whether the rows are independent at all positions, by their form.
    #[inline]
    pub(crate) fn are_independent_by_form(&self) -> bool {
        self.by_form
    }

    /// Takes note of the squared size of a row, which is `Σ aⱼ²/mⱼⱼ` in the metric of each
    /// coordinate alone.
    #[inline]
    pub(crate) fn observe(&mut self, row: usize, size: T, alone: impl FnOnce() -> T) {
        if size > self.size[row] {
            let coupling = self.coupling[row];
            self.grow(
                row,
                match coupling.is_finite() {
                    true => size.min(coupling * alone()),
                    false => size,
                },
            );
        }
    }

    /// The squared size of a row beyond this many times that in the metric of each
    /// coordinate alone is due to a mass matrix that is nearly singular, and does not count.
    pub(crate) fn expect_coupling(&mut self, row: usize, coupling: T) {
        self.coupling[row] = coupling;
    }

    #[cold]
    fn grow(&mut self, row: usize, size: T) {
        if size.is_finite() && size > self.size[row] {
            self.size[row] = size;
            self.inverse_size[row] = T::one() / size;
            self.scale[row] = T::one() / size.sqrt();
        }
    }

    /// Squared reference size of a row.
    #[inline]
    pub(crate) fn size(&self, row: usize) -> T {
        self.size[row]
    }

    /// Its inverse; infinite for a row that was never anything but zero.
    #[inline]
    pub(crate) fn inverse_size(&self, row: usize) -> T {
        self.inverse_size[row]
    }

    /// What a row is multiplied by to have size one; zero for a row that was
    /// never anything but zero.
    #[inline]
    pub(crate) fn scale(&self, row: usize) -> T {
        self.scale[row]
    }

    /// Whether a row is among those that are meant.
    #[inline]
    pub(crate) fn takes_part(&self, row: usize, which: Which) -> bool {
        which == Which::All || self.holonomic[row]
    }

    /// Rank at regular positions.
    pub(crate) fn regular(&self, which: Which) -> usize {
        match which {
            Which::All => self.regular,
            Which::Holonomic => self.holonomic_regular,
        }
    }

    /// Whether all rows restrict positions.
    pub(crate) fn all_holonomic(&self) -> bool {
        self.holonomic.iter().all(|holonomic| *holonomic)
    }

    /// Whether any row restricts positions.
    pub(crate) fn any_holonomic(&self) -> bool {
        self.holonomic.iter().any(|holonomic| *holonomic)
    }

    /// How many rows are meant.
    pub(crate) fn count(&self, which: Which) -> usize {
        (0..R).filter(|&row| self.takes_part(row, which)).count()
    }

    /// A row of the active subset, by its place there; the first row if there is none.
    pub(crate) fn listed(&self, place: usize) -> usize {
        let list = self.active[..self.active_count].get(place);
        list.copied().unwrap_or_default()
    }

    /// Whether all rows are independent at regular positions.
    #[inline]
    pub(crate) fn all_independent(&self) -> bool {
        self.regular == R
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

    /// Takes note that this many rows are independent.
    #[inline(never)]
    pub(crate) fn observe_rank(&mut self, rank: usize, which: Which) {
        match which {
            Which::All => self.regular = rank,
            Which::Holonomic => self.holonomic_regular = rank,
        }
        if self.regular == R {
            // Holonomic rows come first.
            self.active_count = 0;
            for holonomic in [true, false] {
                for row in 0..R {
                    if self.holonomic[row] == holonomic {
                        self.active[self.active_count] = row;
                        self.active_count += 1;
                    }
                }
            }
            self.count_holonomic();
        }
    }

    /// Chooses the active subset from `vectors`, the rows in the metric and scaled
    /// to size one, at a regular position. Holonomic rows come first, so that the
    /// first of the active rows span the holonomic ones.
    #[inline(never)]
    pub(crate) fn choose<const N: usize>(&mut self, mut vectors: SMatrix<T, N, R>) {
        let holonomic = self.holonomic;
        let mut chosen = [0; R];
        let first = |row: usize| holonomic[row];
        let count = independent_rows(
            &mut vectors,
            self.regular,
            &first,
            negligible(),
            &mut chosen,
        );
        // In a singular configuration there are too few; those of before serve on.
        if count == self.regular {
            (self.active, self.active_count) = (chosen, count);
            self.count_holonomic();
        }
    }

    fn count_holonomic(&mut self) {
        let active = &self.active[..self.active_count];
        self.holonomic_count = active.iter().filter(|&&row| self.holonomic[row]).count();
        self.holonomic_regular = self.holonomic_regular.max(self.holonomic_count);
    }

    /// The weights of the rows in an augmented metric.
    pub(crate) fn weights(&self) -> [T; R] {
        self.weight
    }

    /// The weight of a row in an augmented metric.
    #[inline]
    pub(crate) fn weight(&self, row: usize) -> T {
        self.weight[row]
    }

    /// Gives rows the weights of the heaviest masses, if the masses differ so much that
    /// rows look dependent which are not. From the squares of the entries of `A` and the
    /// inertia of the coordinates.
    #[inline(never)]
    pub(crate) fn weigh_unevenly<const N: usize>(
        &mut self,
        levers: &SMatrix<T, R, N>,
        inertia: &[T; N],
    ) -> bool {
        let share = |row: usize, j: usize| levers[(row, j)] / inertia[j];
        let most = |row: usize| (0..N).fold(T::zero(), |most: T, j| most.max(share(row, j)));
        let largest: [T; R] = column(most);
        let mut least = T::one();
        for j in 0..N {
            // Next to others a lever may be short, so the row counts in which it matters.
            let shares = (0..R).filter(|row| largest[*row] > T::zero());
            let best = shares.fold(T::zero(), |best: T, row| {
                best.max(share(row, j) / largest[row])
            });
            // A lever that is round-off says nothing.
            if best > T::EPSILON * T::EPSILON {
                least = least.min(best);
            }
        }
        self.uneven = least < disproportionate::<T>() * disproportionate();
        if self.uneven {
            let least = least.max(T::EPSILON.sqrt());
            self.weight = column(|row| match largest[row] > T::zero() {
                true => disproportionate::<T>() / (least * largest[row]),
                false => T::zero(),
            });
        }
        self.uneven
    }

    /// Forgets the weights of the heaviest masses.
    pub(crate) fn weigh_evenly(&mut self) {
        self.uneven = false;
        self.weight = [T::zero(); R];
    }

    /// Takes note of weights: `1 / Σ aⱼ²/mⱼⱼ` over the coordinates with inertia, so
    /// that the row weighs as much as the masses it connects. Where a row vanishes
    /// the weight stays what it was.
    #[inline(never)]
    pub(crate) fn weigh<const N: usize>(&mut self, inertia: &[T; N], jacobian: &SMatrix<T, R, N>) {
        if self.uneven {
            return;
        }
        for row in 0..R {
            let (mut with, mut without, mut heaviest) = (T::zero(), T::zero(), T::zero());
            for j in 0..N {
                let square = jacobian[(row, j)] * jacobian[(row, j)];
                without += square;
                heaviest = heaviest.max(inertia[j]);
                if inertia[j] > T::zero() {
                    with += square / inertia[j];
                }
            }
            let weight = if with > T::zero() {
                T::one() / with
            } else if heaviest > T::zero() {
                heaviest / without
            } else {
                T::one() / without
            };
            let known = self.weight[row] > T::zero();
            if weight.is_finite() && !(known && self.weight[row] < weight) {
                self.weight[row] = weight;
            }
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
