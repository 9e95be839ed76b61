//! Conditions of forces, and what holds them.
//!
//! Out: [`Sides`], which generated code asks instead of the state; [`Switch`],
//!      [`Switches`] and [`Condition`], which say what decides otherwise.
//!
//! Not here: when a condition changes ([`crate::dynamics`], `switching.rs`).

/// On which side of zero a run holds the switching functions that decide the conditions of
/// the forces, so that the forces are smooth over a step. Where nothing is held, the state
/// decides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sides {
    /// The functions that are held, a bit for each.
    held: u128,
    /// Those of them that are held above zero.
    above: u128,
}

impl Sides {
    /// Nothing is held.
    pub const FREE: Self = Self { held: 0, above: 0 };
    /// Functions that can be held.
    pub const ROOM: usize = 128;

    fn bit(index: u32) -> u128 {
        1_u128.checked_shl(index).unwrap_or(0)
    }

    /// Whether a function is above zero: on the side that is held, or else as `found` at the
    /// state.
    #[inline(always)]
    pub fn above(self, index: u32, found: bool) -> bool {
        match self.held & Self::bit(index) {
            0 => found,
            bit => self.above & bit != 0,
        }
    }

    /// Whether a function is below zero: on the side that is held, or else as `found` at the
    /// state.
    #[inline(always)]
    pub fn below(self, index: u32, found: bool) -> bool {
        !self.above(index, !found)
    }

    /// Which of some functions in a row are held above zero, a bit for each; none if not all
    /// of them are held.
    pub fn code(self, first: u32, count: u32) -> Option<u32> {
        let all = Self::bit(count).wrapping_sub(1);
        let [held, above] =
            [self.held, self.above].map(|sides| sides.checked_shr(first).unwrap_or_default() & all);
        (held == all).then_some(above as u32)
    }

    /// Holds a function above zero, or below it.
    pub fn hold(&mut self, index: u32, above: bool) {
        let bit = Self::bit(index);
        self.held |= bit;
        if above {
            self.above |= bit;
        } else {
            self.above &= !bit;
        }
    }
}

/// A function whose sign decides a condition.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Switch<T> {
    /// Its value.
    pub value: T,
    /// How fast it grows (1/s times its unit).
    pub rate: T,
}

/// Where switching functions are written, and with which conditions.
///
/// A switching function may have conditions of its own, such as `min(F, if x < 0 then a else b)`:
/// they are decided as those of the forces are, so that it is smooth over a step, too.
#[derive(Debug)]
pub struct Switches<'a, T> {
    /// The conditions that are held.
    pub sides: Sides,
    /// As many functions as there is room for.
    pub values: &'a mut [Switch<T>],
}

impl<'a, T> Switches<'a, T> {
    pub(crate) fn of(sides: Sides, values: &'a mut [Switch<T>]) -> Self {
        Self { sides, values }
    }
}

/// A condition of the forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Condition {
    /// As the description writes it.
    pub text: &'static str,
    /// The line of the statement.
    pub line: u32,
    /// What the forces do where it changes.
    pub discontinuity: Discontinuity,
    /// Whether the time alone decides it. It then changes as often as it does, whatever the
    /// motion is.
    pub of_time: bool,
}

/// What forces do where a condition of theirs changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Discontinuity {
    /// They may jump.
    Jump,
    /// They are continuous, but for the slope.
    Kink,
    /// They go on with another polynomial of a spline: nothing depends on the side, and the
    /// switching function counts distances between knots.
    Knot,
}

#[cfg(test)]
mod tests {
    use super::Sides;

    #[test]
    fn what_is_held_decides_and_what_is_not_held_follows_what_was_found() {
        let mut sides = Sides::FREE;
        sides.hold(3, true);
        sides.hold(127, false);
        for found in [true, false] {
            assert!(sides.above(3, found) && !sides.below(3, found));
            assert!(!sides.above(127, found) && sides.below(127, found));
            assert_eq!(sides.above(4, found), found);
            assert_eq!(sides.below(4, found), found);
            assert_eq!(sides.above(128, found), found, "beyond the room");
        }
        assert_eq!((sides.code(3, 1), sides.code(3, 2)), (Some(1), None));
        sides.hold(4, false);
        sides.hold(5, true);
        assert_eq!(sides.code(3, 3), Some(0b101));
        sides.hold(3, false);
        assert!(sides.below(3, false));
    }
}
