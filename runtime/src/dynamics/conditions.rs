//! What is known of the conditions of a motion from one attempt at a step to the next.
//!
//! In:  what [`super::switching`] finds.
//! Out: [`Decided`]: the sides on which conditions are held, and those that are slid along;
//!      [`Conditions`]: the same with the state that it is known for.

use super::sliding::Slid;
use crate::{Condition, DynamicsError, Real, Sides, State, Switch};

/// What an attempt at a step was shortened for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Aim<T> {
    /// The function that passes zero at its end.
    pub(super) index: usize,
    /// Where that end should be (s).
    pub(super) t: T,
    /// How often it was tried to end a step there.
    pub(super) tries: u32,
}

/// The conditions of a motion.
#[derive(Clone, Debug)]
pub(crate) struct Conditions<T, const N: usize> {
    /// The state that the conditions are known for.
    pub(super) at: Option<State<T, N>>,
    pub(super) decided: Decided<T>,
}

/// What was decided about conditions.
#[derive(Clone, Debug)]
pub(crate) struct Decided<T> {
    /// All conditions of the mechanism.
    pub(super) list: &'static [Condition],
    /// The sides on which they are held.
    pub(super) sides: Sides,
    /// The conditions that the motion slides along, a bit for each.
    pub(super) sliding: u128,
    /// The conditions that the motion has left after sliding along them. It does not slide along
    /// zero to the last bit: where it leaves, the function may still be on the other side.
    pub(super) released: u128,
    /// Filippov's weights of the forces above zero, for a motion that slides, at the last
    /// state.
    pub(super) weights: [T; Sides::ROOM],
    /// The sides, and the conditions slid along, with which the last step was made.
    pub(super) made: Option<(Sides, u128)>,
    pub(super) aim: Option<Aim<T>>,
    /// When a condition changed last (s).
    pub(super) turned: T,
    /// Changes in a row between which the time hardly went on.
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
            at: None,
            decided: Decided::new(),
        }
    }

    /// Forgets on which sides a motion was.
    pub(super) fn forget(&mut self, list: &'static [Condition]) {
        self.decided.list = list;
        (self.at, self.decided.made) = (None, None);
    }
}

impl<T: Real> Decided<T> {
    fn new() -> Self {
        Self {
            list: &[],
            sides: Sides::FREE,
            sliding: 0,
            released: 0,
            weights: [T::zero(); Sides::ROOM],
            made: None,
            aim: None,
            turned: T::zero(),
            turns: 0,
            burst: (T::zero(), 0),
            attempt: T::zero(),
        }
    }

    /// Begins at a time with these values of the functions.
    pub(super) fn begin(&mut self, t: T, values: &[Switch<T>]) {
        for (index, switch) in (0..).zip(values) {
            // A function that is zero may be held on the wrong side: the first step will show it.
            self.sides.hold(index, switch.value >= T::zero());
        }
        (self.sliding, self.released, self.turns) = (0, 0, 0);
        (self.turned, self.attempt) = (t, T::zero());
        self.burst = (t, 0);
        self.aim = None;
    }

    /// Holds the conditions as another motion did in its last step; where it has made
    /// none, the state decides.
    pub(super) fn adopt(&mut self, other: &Self) {
        self.made = other.made;
        if let Some((sides, sliding)) = self.made {
            self.weights = other.weights;
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

    /// The conditions that the motion slides along at a time.
    #[inline(never)]
    pub(super) fn slid(&self, t: T) -> Result<Slid, DynamicsError<T>> {
        let mut slid = Slid::new(self.sides);
        for (index, condition) in self.list.iter().enumerate().take(Sides::ROOM) {
            if self.slides(index) && !slid.push(index) {
                return Err(DynamicsError::Sticks { t, condition });
            }
        }
        Ok(slid)
    }
}
