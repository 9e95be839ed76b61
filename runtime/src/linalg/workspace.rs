//! Memory for vectors and matrices whose sizes are data.
//!
//! In:  memory of fixed size, or from the heap, that its owner keeps.
//! Out: slices of it, all zeros, for as long as a scope lasts.
//!
//! What is written over slices is compiled once, whatever the sizes of mechanisms are.
//! Nothing is allocated here: slices are cut from the front of what is free, and all that a
//! scope has cut is free again when it ends.

use crate::Real;
use core::cell::Cell;

/// What is free of some memory.
pub(crate) struct Workspace<'a, T> {
    first: Cell<&'a mut [T]>,
    second: Cell<&'a mut [T]>,
    third: Cell<&'a mut [T]>,
    indices: Cell<&'a mut [usize]>,
}

impl<'a, T: Real> Workspace<'a, T> {
    /// Numbers are cut from the first piece of memory, and from the second where that is
    /// not enough.
    pub(crate) fn new(first: &'a mut [T], second: &'a mut [T], indices: &'a mut [usize]) -> Self {
        Self {
            first: Cell::new(first),
            second: Cell::new(second),
            third: Cell::default(),
            indices: Cell::new(indices),
        }
    }

    /// The same with a third piece, for what is in neither.
    pub(crate) fn and(self, third: &'a mut [T]) -> Self {
        self.third.set(third);
        self
    }

    /// So many zeros.
    pub(crate) fn numbers(&self, count: usize) -> &'a mut [T] {
        let pieces = [&self.first, &self.second, &self.third];
        let taken = pieces.into_iter().find_map(|piece| cut(piece, count));
        debug_assert!(taken.is_some(), "no room for {count} numbers");
        let taken = taken.unwrap_or_default();
        taken.fill(T::zero());
        taken
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
            numbers: [&self.first, &self.second, &self.third].map(Cell::take),
            indices: self.indices.take(),
        }
    }

    /// Does something with what is free, all of which is free again afterwards.
    pub(crate) fn scope<V>(&self, work: impl FnOnce(&Workspace<'_, T>) -> V) -> V {
        let (first, second) = (self.first.take(), self.second.take());
        let (third, indices) = (self.third.take(), self.indices.take());
        let done = work(&Workspace::new(first, second, indices).and(third));
        self.first.set(first);
        self.second.set(second);
        self.third.set(third);
        self.indices.set(indices);
        done
    }
}

/// All that was free of some memory: a workspace for those who hold borrows of their own.
pub(crate) struct Free<'a, T> {
    numbers: [&'a mut [T]; 3],
    indices: &'a mut [usize],
}

impl<T: Real> Free<'_, T> {
    pub(crate) fn workspace(&mut self) -> Workspace<'_, T> {
        let [first, second, third] = &mut self.numbers;
        Workspace::new(first, second, self.indices).and(third)
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
