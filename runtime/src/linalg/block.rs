//! The block that near-dependent rows leave when all others are eliminated.
//!
//! In:  its entries.
//! Out: about its smallest singular value; what another one is in bases in which it is diagonal.
//!
//! Not here: how many eigenvalues changed their sign ([`super::sylvester`]).

use super::workspace::Workspace;
use super::{add_scaled, pair};
use crate::Real;
use core::ops::Range;

/// Rows from which on it pays to look for zeros.
pub(super) const LONG: usize = 16;
/// Near-dependent rows up to which the compiler knows all loops over them.
pub(super) const FEW: usize = 2;
/// A pivot of at least this part of the largest one is as good, if its row is sparser.
const COMPARABLE: f64 = 0.5;

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
    /// singular value; infinite for an empty block. The elimination takes its place.
    ///
    /// Rows stay in their places and entries that are zero are skipped: loops in a row
    /// leave a block with a few entries in each row.
    pub(crate) fn smallest(&mut self, workspace: &Workspace<'_, T>) -> T {
        match self.size {
            0 => T::from_f64(f64::INFINITY),
            // A comparison with NaN is false, so that an entry that is NaN counts as zero.
            1 => match self.first().abs() > T::zero() {
                true => self.first().abs(),
                false => T::zero(),
            },
            FEW => smallest_pivot(FEW, self.entries, &mut [0; FEW], &mut [T::zero(); FEW]),
            size => workspace.scope(|workspace| {
                let (open, peaks) = (workspace.indices(size), workspace.any(size));
                smallest_pivot(size, self.entries, open, peaks)
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
            1 => make_diagonal(1, blocks, pivots, Next::Largest),
            FEW => make_diagonal(FEW, blocks, pivots, Next::Largest),
            size => make_diagonal(size, blocks, pivots, Next::Largest),
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
    let mut smallest = T::from_f64(f64::INFINITY);
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
        // A comparison with NaN is false, so that a peak that is NaN counts as zero.
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

/// Which row of those that are left an elimination takes next.
pub(super) enum Next<'a> {
    /// The one with the largest entry.
    Largest,
    /// The one with the fewest entries of those whose largest entry is [`COMPARABLE`] to the
    /// largest one; with room for the numbers of entries.
    Sparsest(&'a mut [usize]),
}

impl Next<'_> {
    /// Takes note of what a row has from a column on.
    #[inline(always)]
    fn see<T: Real>(&mut self, row: usize, entries: &[T]) {
        if let Self::Sparsest(counts) = self {
            counts[row] = entries.iter().filter(|entry| **entry != T::zero()).count();
        }
    }

    /// The row that comes in a step, and its largest entry.
    #[inline(always)]
    fn choose<T: Real>(&mut self, peaks: &[T], step: usize) -> (usize, T) {
        let (ahead, most) = largest_of(&peaks[step..]);
        let Self::Sparsest(counts) = self else {
            return (step + ahead, most);
        };
        let least = most * T::from_f64(COMPARABLE);
        let mut next = step + ahead;
        for row in step..peaks.len() {
            if peaks[row] >= least && counts[row] < counts[next] {
                next = row;
            }
        }
        counts.swap(step, next);
        (next, peaks[next])
    }
}

/// By elimination finds bases in which the second block is diagonal, and what the first one is
/// there; its pivots are the absolute diagonal.
///
/// Where only a few entries are not zero, the loops go from the first of them to the last.
#[inline(always)]
pub(super) fn make_diagonal<T: Real>(
    size: usize,
    [here, there]: [&mut [T]; 2],
    pivots: &mut [T],
    mut next: Next<'_>,
) {
    if size == 0 {
        return;
    }
    let (here, there) = (&mut here[..size * size], &mut there[..size * size]);
    let pivots = &mut pivots[..size];
    // The largest entries of the rows that are left, in the place of their pivots.
    for (row, (peak, entries)) in pivots.iter_mut().zip(there.chunks_exact(size)).enumerate() {
        *peak = peak_of(entries);
        next.see(row, entries);
    }
    for step in 0..size {
        let (row, most) = next.choose(pivots, step);
        if most == T::zero() {
            break;
        }
        pivots.swap(step, row);
        let (ahead, _) = largest_of(&there[row * size + step..(row + 1) * size]);
        swap(there, size, step, (row, step + ahead));
        swap(here, size, step, (row, step + ahead));
        let pivot = there[step * size + step];
        pivots[step] = pivot.abs();
        let reaches = [&*here, &*there].map(|block| reach_of(&block[step * size..][..size]));
        for later in step + 1..size {
            if there[later * size + step] == T::zero() {
                continue;
            }
            let share = -there[later * size + step] / pivot;
            for (entries, reach) in [&mut *here, &mut *there].into_iter().zip(&reaches) {
                let (above, rows) = entries.split_at_mut(later * size);
                let above = &above[step * size..][reach.clone()];
                add_scaled(&mut rows[reach.clone()], share, above);
            }
            let left = &there[later * size + step + 1..(later + 1) * size];
            pivots[later] = peak_of(left);
            next.see(later, left);
        }
        let above = &there[step * size + step + 1..(step + 1) * size];
        let reach = reach_of(above);
        for row in here.chunks_exact_mut(size) {
            if row[step] != T::zero() {
                let share = -row[step] / pivot;
                let row_left = &mut row[step + 1..][reach.clone()];
                add_scaled(row_left, share, &above[reach.clone()]);
                row[step] *= pivot.sign();
            }
        }
    }
}

/// From the first entry that is not zero to the last one; of a short vector, all.
#[inline(always)]
fn reach_of<T: Real>(vector: &[T]) -> Range<usize> {
    if vector.len() < LONG {
        return 0..vector.len();
    }
    let is_there = |entry: &T| *entry != T::zero();
    match vector.iter().position(is_there) {
        Some(first) => first..vector.iter().rposition(is_there).unwrap_or(first) + 1,
        None => 0..0,
    }
}

/// Makes a row and a column those of a step.
#[inline(always)]
pub(super) fn swap<T: Real>(
    entries: &mut [T],
    size: usize,
    step: usize,
    (row, column): (usize, usize),
) {
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
#[inline(always)]
pub(crate) fn largest_of<T: Real>(entries: &[T]) -> (usize, T) {
    if entries.len() >= LONG {
        return largest_of_many(entries);
    }
    let mut best = (0, -T::one());
    for (column, entry) in entries.iter().enumerate() {
        if entry.abs() > best.1 {
            best = (column, entry.abs());
        }
    }
    best
}

#[inline(never)]
fn largest_of_many<T: Real>(entries: &[T]) -> (usize, T) {
    let most = peak_of(entries);
    let place = entries.iter().position(|entry| entry.abs() == most);
    (place.unwrap_or(0), most)
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
