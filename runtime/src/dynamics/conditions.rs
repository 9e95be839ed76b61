//! What is known of the conditions of a motion from one attempt at a step to the next.
//!
//! In:  what [`super::switching`] finds.
//! Out: [`Conditions`]: the sides on which they are held, and those that are slid along.

use crate::{Condition, Real, Sides, State};

/// What an attempt at a step was shortened for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Aim<T> {
    /// The function that passes zero at its end.
    pub(super) index: usize,
    /// Where that end should be (s).
    pub(super) t: T,
    /// How often that was tried.
    pub(super) tries: u32,
}

/// The conditions of a motion.
#[derive(Clone, Debug)]
pub(crate) struct Conditions<T, const N: usize> {
    /// All there are.
    pub(super) list: &'static [Condition],
    /// The sides on which they are held.
    pub(super) sides: Sides,
    /// Those that the motion slides along, a bit for each.
    pub(super) sliding: u128,
    /// How much of the force above zero acts on a motion that slides, at the last state.
    pub(super) shares: [T; Sides::ROOM],
    /// Sides, and those slid along, with which the last step was made.
    pub(super) made: Option<(Sides, u128)>,
    /// The state that they are known for.
    pub(super) at: Option<State<T, N>>,
    pub(super) aim: Option<Aim<T>>,
    /// When a condition changed last (s).
    pub(super) turned: T,
    /// Changes in a row that hardly got any further.
    pub(super) turns: usize,
    /// When the changes that are counted together began (s), and how many there were.
    pub(super) burst: (T, usize),
    /// The longest attempt at the step at hand (s).
    pub(super) attempt: T,
}

impl<T: Real, const N: usize> Conditions<T, N> {
    /// Nothing is known.
    pub(super) fn new() -> Self {
        Self {
            list: &[],
            sides: Sides::FREE,
            sliding: 0,
            shares: [T::zero(); Sides::ROOM],
            made: None,
            at: None,
            aim: None,
            turned: T::zero(),
            turns: 0,
            burst: (T::zero(), 0),
            attempt: T::zero(),
        }
    }

    /// Forgets on which sides a motion was.
    pub(super) fn forget(&mut self, list: &'static [Condition]) {
        self.list = list;
        (self.at, self.made) = (None, None);
    }

    /// Holds the conditions as another motion did in its last step; where it has made
    /// none, the state decides.
    pub(super) fn adopt(&mut self, other: &Self) {
        self.made = other.made;
        self.shares = other.shares;
        if let Some((sides, sliding)) = self.made {
            (self.sides, self.sliding) = (sides, sliding);
        }
    }

    /// The sign of a function on the side where it is held.
    pub(super) fn side(&self, index: usize) -> T {
        match self.sides.above(index as u32, true) {
            true => T::one(),
            false => -T::one(),
        }
    }

    pub(super) fn slides(&self, index: usize) -> bool {
        self.sliding >> index & 1 == 1
    }
}
