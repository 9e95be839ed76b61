//! What a search for passages through singular configurations has found.
//!
//! In:  passages of the parts of a mechanism, in any order.
//! Out: [`Found`]: those of the whole, in the order of time.

use crate::Real;

/// Passages that are found in one search.
const ROOM: usize = 8;
/// Loops that become singular within this part of a step do so at once.
pub(super) const AT_ONCE: f64 = 1e-6;

/// A passage through a singular configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage<T> {
    /// When (s).
    pub t: T,
    /// The sine by which the weakest constraint is independent there: nearly zero.
    pub sine: T,
    /// How many constraint equations are independent there.
    pub rank: usize,
    /// How many are at regular configurations.
    pub regular: usize,
}

/// Passages of one step after some time: the first of them, in the order of time.
#[derive(Clone, Debug)]
pub(crate) struct Found<T> {
    list: [Option<Passage<T>>; ROOM],
    count: usize,
    after: T,
    /// Passages that are no farther apart happen at once.
    at_once: T,
    has_more: bool,
}

impl<T: Real> Found<T> {
    /// None yet of those after a time, in a step of this length.
    pub(super) fn new(after: T, length: T) -> Self {
        Self {
            list: [None; ROOM],
            count: 0,
            after,
            at_once: length * T::from_f64(AT_ONCE),
            has_more: false,
        }
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Passage<T>> {
        self.list.iter().flatten()
    }

    /// The time after which there are more passages than found room, if there are.
    pub(crate) fn rest_after(&self) -> Option<T> {
        let last = self.list.last()?.filter(|_| self.has_more)?;
        Some(last.t + self.at_once)
    }

    pub(super) fn push(&mut self, passage: Passage<T>) {
        if passage.t <= self.after {
            return;
        }
        let earlier = self.iter().take_while(|known| known.t <= passage.t);
        let place = earlier.count();
        self.has_more |= self.count == ROOM;
        if place < ROOM {
            self.count = ROOM.min(self.count + 1);
            self.list[place..self.count].rotate_right(1);
            self.list[place] = Some(passage);
        }
    }

    /// Adds the passages of one of several parts of a mechanism, whose constraints have this
    /// rank together.
    pub(super) fn add(&mut self, others: &Self, regular: usize) {
        for passage in others.iter() {
            let lost = passage.regular - passage.rank;
            let mut known = self.list.iter_mut().flatten();
            match known.find(|known| (known.t - passage.t).abs() <= self.at_once) {
                Some(known) => {
                    known.rank = known.rank.saturating_sub(lost);
                    known.sine = known.sine.min(passage.sine);
                }
                None => self.push(Passage {
                    rank: regular - lost,
                    regular,
                    ..*passage
                }),
            }
        }
        self.has_more |= others.has_more;
    }
}
