//! What is known of the conditions of a motion from one attempt at a step to the next.
//!
//! In:  what [`super::switching`] finds.
//! Out: [`Decided`]: the sides on which conditions are held, and those that are slid along;
//!      [`Conditions`]: the same with the state that it is known for.

use super::sliding::Slid;
use crate::{Condition, DynamicsError, Real, Sides, State, Switch};

/// The round-off of a switching function, in units of that of its size.
const ROUND_OFF: f64 = 64.0;

/// The round-off of a switching function of a size.
pub(super) fn round_off_of<T: Real>(size: T) -> T {
    size * T::EPSILON * T::from_f64(ROUND_OFF)
}

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

/// Changes of conditions within the length of one attempt at a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Burst<T> {
    /// When the first was (s).
    pub(super) since: T,
    pub(super) count: usize,
    /// The longest attempt that was made meanwhile (s).
    pub(super) length: T,
}

impl<T: Real> Burst<T> {
    pub(super) fn since(t: T) -> Self {
        Self {
            since: t,
            count: 0,
            length: T::zero(),
        }
    }
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
    /// The largest sizes of the switching functions so far, and of their rates.
    pub(super) sizes: [Switch<T>; Sides::ROOM],
    pub(super) aim: Option<Aim<T>>,
    /// When a condition changed last (s).
    pub(super) turned: T,
    /// Changes in a row between which the time hardly went on.
    pub(super) turns: usize,
    /// The changes that are counted together.
    pub(super) burst: Burst<T>,
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
            sizes: [Switch::default(); Sides::ROOM],
            aim: None,
            turned: T::zero(),
            turns: 0,
            burst: Burst::since(T::zero()),
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
        self.burst = Burst::since(t);
        self.aim = None;
        self.sizes = [Switch::default(); Sides::ROOM];
    }

    /// What switching functions and their rates are off by in any case, since they are sums of
    /// terms as large as they have been.
    pub(super) fn round_off(&self, index: usize) -> Switch<T> {
        let Switch { value, rate } = self.sizes[index];
        Switch {
            value: round_off_of(value),
            rate: round_off_of(rate),
        }
    }

    /// How large a switching function was so far, or would become within a time: what begins at
    /// rest has no size yet.
    pub(super) fn known_size(&self, index: usize, time: T) -> T {
        let Switch { value, rate } = self.sizes[index];
        value.max(rate * time)
    }

    /// Takes note of how large a switching function is, or its rate.
    pub(super) fn take_note(&mut self, index: usize, Switch { value, rate }: Switch<T>) {
        let size = &mut self.sizes[index];
        (size.value, size.rate) = (size.value.max(value.abs()), size.rate.max(rate.abs()));
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
