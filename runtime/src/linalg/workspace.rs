//! Memory for vectors and matrices whose sizes are data.
//!
//! In:  memory of fixed size, or from the heap, that its owner keeps.
//! Out: slices of it, all zeros unless anything will do, for as long as a scope lasts.
//!
//! What is written over slices is compiled once, whatever the sizes of mechanisms are.
//! Nothing is allocated here: slices are cut from the front of what is free, and all that a
//! scope has cut is free again when it ends.

use crate::Real;
use core::cell::Cell;

/// Pieces of memory that numbers are cut from.
const PIECES: usize = 4;

/// What is free of some memory.
pub(crate) struct Workspace<'a, T> {
    numbers: [Cell<&'a mut [T]>; PIECES],
    indices: Cell<&'a mut [usize]>,
}

impl<'a, T: Real> Workspace<'a, T> {
    /// Numbers are cut from the first piece of memory, and from the second where that is
    /// not enough.
    pub(crate) fn new(first: &'a mut [T], second: &'a mut [T], indices: &'a mut [usize]) -> Self {
        Self::of([first, second, &mut [], &mut []], indices)
    }

    /// A workspace of several pieces of memory. What is left of a piece when a matrix no longer
    /// fits is there for vectors.
    pub(crate) fn of(numbers: [&'a mut [T]; PIECES], indices: &'a mut [usize]) -> Self {
        Self {
            numbers: numbers.map(Cell::new),
            indices: Cell::new(indices),
        }
    }

    /// So many zeros.
    pub(crate) fn numbers(&self, count: usize) -> &'a mut [T] {
        let taken = self.any(count);
        taken.fill(T::zero());
        taken
    }

    /// Whether there is room for so many numbers in one piece.
    pub(crate) fn has_room(&self, count: usize) -> bool {
        self.numbers.iter().any(|piece| {
            let free = piece.take();
            let room = free.len() >= count;
            piece.set(free);
            room
        })
    }

    /// So many numbers, for what is written before it is read.
    pub(crate) fn any(&self, count: usize) -> &'a mut [T] {
        let [first, others @ ..] = &self.numbers;
        let others = || others.iter().find_map(|piece| cut(piece, count));
        let taken = cut(first, count).or_else(others);
        debug_assert!(taken.is_some(), "no room for {count} numbers");
        taken.unwrap_or_default()
    }

    /// So many indices, all of them zero.
    pub(crate) fn indices(&self, count: usize) -> &'a mut [usize] {
        let taken = cut(&self.indices, count);
        debug_assert!(taken.is_some(), "no room for {count} indices");
        let taken = taken.unwrap_or_default();
        taken.fill(0);
        taken
    }

    /// Takes all that is free.
    pub(crate) fn all(&self) -> Free<'a, T> {
        Free {
            numbers: self.numbers.each_ref().map(Cell::take),
            indices: self.indices.take(),
        }
    }

    /// Does something with what is free, all of which is free again afterwards.
    pub(crate) fn scope<V>(&self, work: impl FnOnce(&Workspace<'_, T>) -> V) -> V {
        let mut numbers = self.numbers.each_ref().map(Cell::take);
        let indices = self.indices.take();
        let lent = numbers.each_mut().map(|piece| &mut **piece);
        let done = work(&Workspace::of(lent, indices));
        for (piece, taken) in self.numbers.iter().zip(numbers) {
            piece.set(taken);
        }
        self.indices.set(indices);
        done
    }
}

/// All that was free of some memory. What it lends has a lifetime that can be named, that of a
/// [`Workspace::scope`] can't: a struct that holds parts of a workspace beside other borrows needs
/// one.
pub(crate) struct Free<'a, T> {
    numbers: [&'a mut [T]; PIECES],
    indices: &'a mut [usize],
}

impl<T: Real> Free<'_, T> {
    pub(crate) fn workspace(&mut self) -> Workspace<'_, T> {
        let lent = self.numbers.each_mut().map(|piece| &mut **piece);
        Workspace::of(lent, self.indices)
    }
}

/// Cuts off so many entries, if there are that many.
fn cut<'a, E>(free: &Cell<&'a mut [E]>, count: usize) -> Option<&'a mut [E]> {
    let all = free.take();
    if all.len() < count {
        free.set(all);
        return None;
    }
    let (taken, rest) = all.split_at_mut(count);
    free.set(rest);
    Some(taken)
}
