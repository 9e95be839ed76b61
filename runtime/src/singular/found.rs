//! What a search for passages through singular configurations has found.
//!
//! In:  passages of the parts of a mechanism, in any order.
//! Out: [`Found`]: those of the whole, in the order of time.

use crate::Real;
use crate::equations::At;
use crate::tolerance::resolvable;

/// Passages that are found in one search.
const ROOM: usize = 8;
/// Loops that become singular within this part of a step do so at once, whatever the tolerance.
const AT_ONCE: f64 = 1e-6;
/// The part of a step within which loops become singular at once, in tolerances: the inside of a
/// step is off by about one tolerance, relative to the range of the coordinates, of which a step is
/// a part.
const TOLERANCES: f64 = 10.0;
/// The same in round-off of the positions of a step, and in that of its times.
const ROUND_OFFS: f64 = 256.0;
const ROUND_OFFS_OF_TIME: f64 = 16.0;
/// By how much the inside of a step may be beyond a singular configuration that the motion only
/// touches: in tolerances, and in least errors of an interpolation where steps are fixed. By
/// experiment, with laws that turn there.
const BEYOND: f64 = 0.01;
const BEYOND_OF_FIXED: f64 = 10.0;

/// A passage through a singular configuration: of a run that comes from one side and goes on to
/// the other. One that ends or begins exactly there has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage<T> {
    /// When (s).
    pub t: T,
    /// The sine by which the weakest constraint is independent there: nearly zero.
    pub sine: T,
    /// How many constraint equations are independent there.
    pub rank: usize,
    /// How many are independent at regular configurations.
    pub regular: usize,
}

/// A step that is searched for passages.
#[derive(Clone, Copy)]
pub(crate) struct Searched<'a, T> {
    pub(crate) start: At<'a, T>,
    pub(crate) length: T,
    /// The time after which passages are sought.
    pub(crate) after: T,
    /// Accepted error of the step, relative, if there is one.
    pub(crate) tolerance: Option<T>,
    /// Constraints contain the time: a law may turn exactly in a singular configuration.
    pub(crate) rheonomic: bool,
    /// The positions of the step.
    pub(crate) at: &'a dyn Fn(T, &mut [T]),
    /// Where the search of the steps before was left open.
    pub(crate) open: Option<(T, &'a [T])>,
}

impl<T: Real> Searched<'_, T> {
    /// Passages that are no farther apart than this (s) happen at once.
    pub(super) fn at_once(&self) -> T {
        let known = self.tolerance.unwrap_or_default() * T::from_f64(TOLERANCES);
        let resolved = T::EPSILON * T::from_f64(ROUND_OFFS);
        let part = known.max(T::from_f64(AT_ONCE)).max(resolved);
        let end = (self.start.t + self.length).abs();
        let time = self.start.t.abs().max(end) * T::EPSILON * T::from_f64(ROUND_OFFS_OF_TIME);
        (self.length * part).max(time)
    }

    /// The sine up to which the inside of the step does not tell on which side of a singular
    /// configuration it is.
    pub(super) fn unseen(&self) -> T {
        match self.tolerance {
            _ if !self.rheonomic => T::zero(),
            Some(tolerance) => resolvable::<T>().max(tolerance * T::from_f64(BEYOND)),
            None => resolvable::<T>() * T::from_f64(BEYOND_OF_FIXED),
        }
    }

    /// The position at a time of the step, or on the way to it from where the search was left
    /// open.
    pub(super) fn position(&self, t: T, q: &mut [T]) {
        let Some((from, open)) = self.open.filter(|_| t < self.start.t) else {
            return (self.at)(t, q);
        };
        let part = (t - from) / (self.start.t - from);
        for ((q, from), to) in q.iter_mut().zip(open).zip(self.start.q) {
            *q = *from + (*to - *from) * part;
        }
    }
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
    /// The last time at which it could be told on which side of a singular configuration the
    /// motion is, if that is not the end of the step.
    pub(crate) open: Option<T>,
}

impl<T: Real> Found<T> {
    /// No passage found yet of those that are sought in a step.
    pub(super) fn new(step: &Searched<'_, T>) -> Self {
        Self {
            list: [None; ROOM],
            count: 0,
            after: step.after,
            at_once: step.at_once(),
            has_more: false,
            open: None,
        }
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Passage<T>> {
        self.list.iter().flatten()
    }

    /// The time after which to look for the passages that found no room, if there are any.
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

    /// Adds the passages of one of several parts of a mechanism, or of different loops, whose
    /// constraints have this rank together.
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
        self.open = match (self.open, others.open) {
            (Some(one), Some(other)) => Some(one.min(other)),
            (one, other) => one.or(other),
        };
    }
}
