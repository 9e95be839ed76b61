//! The block that near-dependent rows leave when all others are eliminated.
//!
//! In:  its entries, in the first rows and columns of an array that has room for all.
//! Out: about its smallest singular value; how many eigenvalues changed their sign.

use super::add_scaled;
use crate::Real;

/// The block of near-dependent rows, in its first `size` rows and columns.
#[derive(Clone, Debug)]
pub(crate) struct Block<T, const R: usize> {
    pub(crate) entries: [[T; R]; R],
    pub(crate) size: usize,
}

impl<T: Real, const R: usize> Block<T, R> {
    pub(crate) fn zeros(size: usize) -> Self {
        Self {
            entries: [[T::zero(); R]; R],
            size,
        }
    }

    /// `self + factor · other`, two blocks of one size.
    pub(crate) fn plus(&self, factor: T, other: &Self) -> Self {
        let mut sum = Self::zeros(self.size);
        sum.set_sum(self, factor, other);
        sum
    }

    /// Becomes `a + factor · b`. A block has room for all rows, of which most are not used:
    /// those are left alone.
    pub(crate) fn set_sum(&mut self, a: &Self, factor: T, b: &Self) {
        self.size = a.size;
        let rows = self.entries[..a.size].iter_mut();
        for ((row, a), b) in rows.zip(&a.entries).zip(&b.entries) {
            for ((entry, a), b) in row[..self.size].iter_mut().zip(a).zip(b) {
                *entry = factor.mul_add(*b, *a);
            }
        }
    }

    /// Becomes a sum of other blocks of one size, each times a factor.
    pub(crate) fn set_combination(&mut self, factors: &[T], blocks: &[Self]) {
        self.size = blocks.first().map_or(0, |first| first.size);
        for i in 0..self.size {
            for j in 0..self.size {
                let terms = factors.iter().zip(blocks);
                self.entries[i][j] = terms.fold(T::zero(), |sum, (factor, block)| {
                    factor.mul_add(block.entries[i][j], sum)
                });
            }
        }
    }

    /// The smallest pivot of an elimination with complete pivoting: about the smallest
    /// singular value; one for an empty block. The elimination takes its place.
    ///
    /// Rows stay in their places and entries that are zero are skipped: loops in a row
    /// leave a block with a few entries in each row.
    pub(crate) fn smallest(&mut self) -> T {
        let size = self.size;
        let mut smallest = T::one();
        let mut done = [false; R];
        let mut peaks = [(0, T::zero()); R];
        for (peak, row) in peaks.iter_mut().zip(&self.entries[..size]) {
            *peak = largest_of(&row[..size]);
        }
        for _ in 0..size {
            let open = (0..size).filter(|row| !done[*row]);
            let next = open.fold((0, T::zero()), |best, row| match peaks[row].1 > best.1 {
                true => (row, peaks[row].1),
                false => best,
            });
            let (row, peak) = next;
            // False for NaN, too.
            let is_left = peak > T::zero();
            if !is_left {
                return T::zero();
            }
            smallest = smallest.min(peak);
            done[row] = true;
            let (column, pivot) = (peaks[row].0, self.entries[row]);
            for other in (0..size).filter(|other| !done[*other]) {
                let entries = &mut self.entries[other][..size];
                if entries[column] == T::zero() {
                    continue;
                }
                let share = entries[column] / pivot[column];
                for (entry, lost) in entries.iter_mut().zip(&pivot) {
                    *entry -= share * *lost;
                }
                entries[column] = T::zero();
                peaks[other] = largest_of(entries);
            }
        }
        smallest
    }

    /// How many eigenvalues change their sign from another block to this one: the
    /// number of negative eigenvalues of the symmetric part of this block in bases in
    /// which the other one is the identity.
    pub(crate) fn sign_changes_from(&self, other: &Self) -> usize {
        let (here, pivots) = self.in_bases_of(other);
        let size = here.size;
        if pivots[..size].contains(&T::zero()) {
            return 0;
        }
        let mut symmetric = Self::zeros(size);
        for i in 0..size {
            for j in 0..size {
                let sum = here.entries[i][j] + here.entries[j][i];
                symmetric.entries[i][j] = sum / (pivots[i] * pivots[j]).sqrt();
            }
        }
        symmetric.negative_eigenvalues()
    }

    /// This block in bases in which another one is diagonal, and what it is there: its
    /// pivots in an elimination with complete pivoting, the largest first, none negative.
    pub(crate) fn in_bases_of(&self, other: &Self) -> (Self, [T; R]) {
        let (mut here, mut there) = (self.clone(), other.clone());
        here.size = self.size.min(other.size);
        let mut pivots = [T::zero(); R];
        for step in 0..here.size {
            let Some((row, column)) = there.largest(step) else {
                break;
            };
            there.swap(step, row, column);
            here.swap(step, row, column);
            let size = here.size;
            let pivot = there.entries[step];
            let above = here.entries[step];
            for later in step + 1..size {
                let share = -there.entries[later][step] / pivot[step];
                if share == T::zero() {
                    continue;
                }
                add_scaled(&mut here.entries[later][..size], share, &above[..size]);
                add_scaled(&mut there.entries[later][..size], share, &pivot[..size]);
            }
            for row in &mut here.entries[..size] {
                let share = row[step] / pivot[step];
                for (entry, pivot) in row[step + 1..size].iter_mut().zip(&pivot[step + 1..]) {
                    *entry -= share * *pivot;
                }
                if pivot[step] < T::zero() {
                    row[step] = -row[step];
                }
            }
            pivots[step] = pivot[step].abs();
        }
        (here, pivots)
    }

    /// Its last rows and columns, so many.
    pub(crate) fn last(&self, count: usize) -> Self {
        let mut last = Self::zeros(count);
        let first = self.size - count;
        for (target, row) in last.entries.iter_mut().zip(&self.entries[first..self.size]) {
            target[..count].copy_from_slice(&row[first..self.size]);
        }
        last
    }

    /// By Sylvester's law of inertia, from symmetric elimination with the largest
    /// diagonal entry first. A product of blocks that are nearly multiples of each
    /// other has no diagonal that vanishes before the rest does.
    fn negative_eigenvalues(mut self) -> usize {
        let mut count = 0;
        for step in 0..self.size {
            let diagonal = |k: &usize| self.entries[*k][*k].abs();
            let larger = |best: usize, k: usize| {
                if diagonal(&k) > diagonal(&best) {
                    k
                } else {
                    best
                }
            };
            let next = (step..self.size).fold(step, larger);
            self.swap(step, next, next);
            let pivot = self.entries[step][step];
            if pivot == T::zero() {
                break;
            }
            count += usize::from(pivot < T::zero());
            self.eliminate(step);
        }
        count
    }

    /// Where the largest entry of what is left is, if it is not zero.
    fn largest(&self, step: usize) -> Option<(usize, usize)> {
        let mut most = T::zero();
        let mut place = None;
        for row in step..self.size {
            for column in step..self.size {
                let size = self.entries[row][column].abs();
                if size > most {
                    most = size;
                    place = Some((row, column));
                }
            }
        }
        place
    }

    fn swap(&mut self, step: usize, row: usize, column: usize) {
        self.entries.swap(step, row);
        for entries in &mut self.entries[..self.size] {
            entries.swap(step, column);
        }
    }

    fn eliminate(&mut self, step: usize) {
        let pivot = self.entries[step];
        for row in &mut self.entries[step + 1..self.size] {
            let share = -row[step] / pivot[step];
            add_scaled(row, share, &pivot);
        }
    }
}

/// Where the largest of some entries is, and its size.
pub(crate) fn largest_of<T: Real>(entries: &[T]) -> (usize, T) {
    let entries = entries.iter().enumerate();
    entries.fold((0, -T::one()), |best, (column, entry)| {
        if entry.abs() > best.1 {
            (column, entry.abs())
        } else {
            best
        }
    })
}
