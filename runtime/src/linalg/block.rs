//! The block that near-dependent rows leave when all others are eliminated.
//!
//! In:  its entries.
//! Out: about its smallest singular value; how many eigenvalues changed their sign.

use super::workspace::Workspace;
use super::{add_scaled, pair};
use crate::Real;

/// Near-dependent rows up to which the compiler knows all loops over them.
const FEW: usize = 2;

/// A square matrix of the size of the near-dependent rows, row by row.
#[derive(Debug)]
pub(crate) struct Block<'a, T> {
    entries: &'a mut [T],
    size: usize,
}

impl<'a, T: Real> Block<'a, T> {
    /// A block of zeros.
    pub(crate) fn zeros(size: usize, workspace: &Workspace<'a, T>) -> Self {
        Self {
            entries: workspace.numbers(size * size),
            size,
        }
    }

    /// An empty block with room for one of this size.
    pub(crate) fn with_capacity(size: usize, workspace: &Workspace<'a, T>) -> Self {
        Self {
            entries: workspace.any(size * size),
            size: 0,
        }
    }

    /// A copy elsewhere.
    pub(crate) fn copy<'b>(&self, workspace: &Workspace<'b, T>) -> Block<'b, T> {
        let mut copy = Block::with_capacity(self.size, workspace);
        copy.set(self);
        copy
    }

    pub(crate) fn size(&self) -> usize {
        self.size
    }

    /// Becomes of another size that there is room for, with any entries.
    pub(super) fn resize(&mut self, size: usize) {
        self.size = size;
    }

    /// Becomes zero, of another size that there is room for.
    pub(crate) fn clear(&mut self, size: usize) {
        self.size = size;
        self.entries[..size * size].fill(T::zero());
    }

    pub(crate) fn row(&self, row: usize) -> &[T] {
        &self.entries[row * self.size..(row + 1) * self.size]
    }

    pub(crate) fn row_mut(&mut self, row: usize) -> &mut [T] {
        &mut self.entries[row * self.size..(row + 1) * self.size]
    }

    /// The first entry, zero if there is none.
    pub(crate) fn first(&self) -> T {
        self.all().first().copied().unwrap_or_default()
    }

    pub(crate) fn all(&self) -> &[T] {
        &self.entries[..self.size * self.size]
    }

    fn all_mut(&mut self) -> &mut [T] {
        &mut self.entries[..self.size * self.size]
    }

    /// Becomes the same as another, which there is room for.
    pub(crate) fn set(&mut self, other: &Block<'_, T>) {
        self.size = other.size;
        self.all_mut().copy_from_slice(other.all());
    }

    /// Becomes `a + factor · b`, two blocks of one size.
    pub(crate) fn set_sum(&mut self, a: &Block<'_, T>, factor: T, b: &Block<'_, T>) {
        self.size = a.size;
        let terms = a.all().iter().zip(b.all());
        for (entry, (a, b)) in self.all_mut().iter_mut().zip(terms) {
            *entry = factor.mul_add(*b, *a);
        }
    }

    /// Is multiplied by a factor.
    pub(crate) fn scale(&mut self, factor: T) {
        for entry in self.all_mut() {
            *entry *= factor;
        }
    }

    /// Becomes a sum of other blocks of one size, each times a factor.
    pub(crate) fn set_combination(&mut self, factors: &[T], blocks: &[Block<'_, T>]) {
        self.clear(blocks.first().map_or(0, |first| first.size));
        for (factor, block) in factors.iter().zip(blocks) {
            add_scaled(self.all_mut(), *factor, block.all());
        }
    }

    /// The smallest pivot of an elimination with complete pivoting: about the smallest
    /// singular value; one for an empty block. The elimination takes its place.
    ///
    /// Rows stay in their places and entries that are zero are skipped: loops in a row
    /// leave a block with a few entries in each row.
    pub(crate) fn smallest(&mut self, workspace: &Workspace<'_, T>) -> T {
        match self.size {
            0 => T::one(),
            // False for NaN, too.
            1 => match self.first().abs() > T::zero() {
                true => self.first().abs().min(T::one()),
                false => T::zero(),
            },
            FEW => smallest_pivot(FEW, self.entries, &mut [0; FEW], &mut [T::zero(); FEW]),
            size => workspace.scope(|workspace| {
                let (open, peaks) = (workspace.indices(size), workspace.any(size));
                smallest_pivot(size, self.entries, open, peaks)
            }),
        }
    }

    /// How many eigenvalues change their sign from another block to this one: the
    /// number of negative eigenvalues of the symmetric part of this block in bases in
    /// which the other one is the identity.
    pub(crate) fn sign_changes_from(
        &self,
        other: &Block<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> usize {
        let (here, there) = (self.all(), other.all());
        let mut small = [[T::zero(); FEW * FEW]; 2];
        for (copy, entries) in small.iter_mut().zip([here, there]) {
            for (copy, entry) in copy.iter_mut().zip(entries) {
                *copy = *entry;
            }
        }
        let [first, second] = &mut small;
        let mut pivots = [T::zero(); FEW];
        match self.size {
            0 => 0,
            1 => count_changes(1, [first, second], &mut pivots),
            FEW => count_changes(FEW, [first, second], &mut pivots),
            size => workspace.scope(|workspace| {
                let copies = [here, there].map(|entries| {
                    let copy = workspace.any(entries.len());
                    copy.copy_from_slice(entries);
                    copy
                });
                count_changes(size, copies, workspace.any(size))
            }),
        }
    }

    /// This block in bases in which another one is diagonal, and what it is there: its
    /// pivots in an elimination with complete pivoting, the largest first, none negative.
    pub(crate) fn in_bases_of<'b>(
        &self,
        other: &Block<'_, T>,
        workspace: &Workspace<'b, T>,
    ) -> (Block<'b, T>, &'b mut [T]) {
        let (here, there) = (self.copy(workspace), other.copy(workspace));
        let pivots = workspace.numbers(self.size);
        let blocks = [&mut *here.entries, &mut *there.entries];
        match self.size {
            1 => make_diagonal(1, blocks, pivots),
            FEW => make_diagonal(FEW, blocks, pivots),
            size => make_diagonal(size, blocks, pivots),
        }
        (here, pivots)
    }

    /// Its last rows and columns, so many.
    pub(crate) fn last<'b>(&self, count: usize, workspace: &Workspace<'b, T>) -> Block<'b, T> {
        let mut last = Block::zeros(count, workspace);
        let first = self.size - count;
        for row in 0..count {
            let entries = &self.row(first + row)[first..];
            last.row_mut(row).copy_from_slice(entries);
        }
        last
    }
}

/// The smallest pivot of a block of several rows, with room for a list and a vector.
#[inline(always)]
fn smallest_pivot<T: Real>(
    size: usize,
    entries: &mut [T],
    open: &mut [usize],
    peaks: &mut [T],
) -> T {
    let entries = &mut entries[..size * size];
    let mut smallest = T::one();
    for (row, entries) in entries.chunks_exact(size).enumerate() {
        (open[row], peaks[row]) = (row, peak_of(entries));
    }
    for left in (1..=size).rev() {
        let mut place = 0;
        for other in 0..left {
            if peaks[open[other]] > peaks[open[place]] {
                place = other;
            }
        }
        let row = open[place];
        // False for NaN, too.
        let is_left = peaks[row] > T::zero();
        if !is_left {
            return T::zero();
        }
        smallest = smallest.min(peaks[row]);
        open.copy_within(place + 1..left, place);
        let (column, _) = largest_of(&entries[row * size..(row + 1) * size]);
        for &other in &open[..left - 1] {
            if entries[other * size + column] == T::zero() {
                continue;
            }
            let [entries, pivot] = pair(entries, size, other, row);
            let share = entries[column] / pivot[column];
            add_scaled(entries, -share, pivot);
            entries[column] = T::zero();
            peaks[other] = peak_of(entries);
        }
    }
    smallest
}

/// How many eigenvalues change their sign from the second block to the first one, which are
/// used up.
#[inline(always)]
fn count_changes<T: Real>(size: usize, [here, there]: [&mut [T]; 2], pivots: &mut [T]) -> usize {
    make_diagonal(size, [here, there], pivots);
    let scales = &mut pivots[..size];
    if scales.contains(&T::zero()) {
        return 0;
    }
    scales.iter_mut().for_each(|x| *x = T::one() / x.sqrt());
    let symmetric = &mut there[..size * size];
    for i in 0..size {
        for j in 0..size {
            let sum = here[i * size + j] + here[j * size + i];
            symmetric[i * size + j] = sum * scales[i] * scales[j];
        }
    }
    count_negative(size, symmetric)
}

/// By elimination with complete pivoting finds bases in which the second block is diagonal,
/// and what the first one is there; its pivots are the absolute diagonal.
#[inline(always)]
fn make_diagonal<T: Real>(size: usize, [here, there]: [&mut [T]; 2], pivots: &mut [T]) {
    let (here, there) = (&mut here[..size * size], &mut there[..size * size]);
    // The largest entries of the rows that are left, in the place of their pivots.
    for (peak, row) in pivots.iter_mut().zip(there.chunks_exact(size)) {
        *peak = peak_of(row);
    }
    for step in 0..size {
        let (ahead, most) = largest_of(&pivots[step..size]);
        if most == T::zero() {
            break;
        }
        let row = step + ahead;
        pivots.swap(step, row);
        let (ahead, _) = largest_of(&there[row * size + step..(row + 1) * size]);
        swap(there, size, step, (row, step + ahead));
        swap(here, size, step, (row, step + ahead));
        let pivot = there[step * size + step];
        pivots[step] = pivot.abs();
        for later in step + 1..size {
            if there[later * size + step] == T::zero() {
                continue;
            }
            let share = -there[later * size + step] / pivot;
            for entries in [&mut *here, &mut *there] {
                let (above, rows) = entries.split_at_mut(later * size);
                add_scaled(&mut rows[..size], share, &above[step * size..][..size]);
            }
            pivots[later] = peak_of(&there[later * size + step + 1..(later + 1) * size]);
        }
        for row in here.chunks_exact_mut(size) {
            if row[step] != T::zero() {
                let above = &there[step * size + step + 1..(step + 1) * size];
                let share = -row[step] / pivot;
                add_scaled(&mut row[step + 1..], share, above);
                row[step] *= pivot.sign();
            }
        }
    }
}

/// How many eigenvalues of a symmetric block are negative: by Sylvester's law of inertia, from
/// symmetric elimination with the largest diagonal entry first. A product of blocks that are
/// nearly multiples of each other has no diagonal that vanishes before the rest does.
#[inline(always)]
fn count_negative<T: Real>(size: usize, entries: &mut [T]) -> usize {
    let entries = &mut entries[..size * size];
    let mut count = 0;
    for step in 0..size {
        let diagonal = |k: usize| entries[k * size + k].abs();
        let mut next = step;
        for k in step + 1..size {
            if diagonal(k) > diagonal(next) {
                next = k;
            }
        }
        swap(entries, size, step, (next, next));
        let pivot = entries[step * size + step];
        if pivot == T::zero() {
            break;
        }
        count += usize::from(pivot < T::zero());
        let (done, rest) = entries.split_at_mut((step + 1) * size);
        for row in rest.chunks_exact_mut(size) {
            if row[step] != T::zero() {
                add_scaled(row, -row[step] / pivot, &done[step * size..]);
            }
        }
    }
    count
}

/// Makes a row and a column those of a step.
#[inline(always)]
fn swap<T: Real>(entries: &mut [T], size: usize, step: usize, (row, column): (usize, usize)) {
    if row != step {
        let [row, other] = pair(entries, size, row, step);
        row.swap_with_slice(other);
    }
    if column != step {
        for row in entries.chunks_exact_mut(size) {
            row.swap(step, column);
        }
    }
}

/// Where the largest of some entries is, and its size.
pub(crate) fn largest_of<T: Real>(entries: &[T]) -> (usize, T) {
    let mut best = (0, -T::one());
    for (column, entry) in entries.iter().enumerate() {
        if entry.abs() > best.1 {
            best = (column, entry.abs());
        }
    }
    best
}

/// Numbers that are compared side by side.
const LANES: usize = 4;

/// The size of the largest of some entries.
pub(crate) fn peak_of<T: Real>(entries: &[T]) -> T {
    let mut peaks = [T::zero(); LANES];
    let (chunks, rest) = entries.as_chunks::<LANES>();
    for chunk in chunks {
        for lane in 0..LANES {
            peaks[lane] = larger(chunk[lane].abs(), peaks[lane]);
        }
    }
    let rest = rest.iter().map(|entry| entry.abs());
    rest.chain(peaks)
        .fold(T::zero(), |most, size| larger(size, most))
}

/// The first of two sizes if it is larger, else the second.
fn larger<T: Real>(size: T, most: T) -> T {
    if size > most { size } else { most }
}
