//! Functions through many given points.
//!
//! In:  places and the polynomials between them, as generated code holds them.
//! Out: values, derivatives, and the switching functions that say in which interval an
//!      argument is.
//!
//! An interval has a number, whose bits in Gray's code identify it: only one of them changes
//! from each interval to the next. Each bit is the side of a switching function on which a run
//! is: a run that holds those sides ([`Sides`]) holds the interval, and its polynomial goes on
//! beyond the ends, so that the step that ends there is smooth.

use crate::{Real, Sides};

/// A function that is a polynomial between any two places.
#[derive(Clone, Copy, Debug)]
pub struct Table {
    /// Where one polynomial ends and the next begins, in rising order.
    pub places: &'static [f64],
    /// `c₀ + c₁ d + c₂ d² + c₃ d³` in each interval, with the distance `d` from the place
    /// where it begins; from the first place before that.
    pub pieces: &'static [[f64; 4]],
}

impl Table {
    /// Bits that tell an interval.
    fn bits(&self) -> u32 {
        usize::BITS - self.places.len().leading_zeros()
    }

    /// The interval of an argument; one that is a place belongs to the interval it begins.
    fn interval<T: Real>(&self, x: T) -> usize {
        self.places
            .partition_point(|place| T::from_f64(*place) <= x)
    }

    fn place<T: Real>(&self, index: usize) -> T {
        T::from_f64(self.places.get(index).copied().unwrap_or_default())
    }

    /// The derivative of an order, the function itself for 0.
    pub fn value<T: Real>(&self, order: u8, x: T) -> T {
        self.within(self.interval(x), order, x)
    }

    /// The derivative of an order, on the interval that is held from the switching function `first`
    /// on, if one is.
    pub fn held<T: Real>(&self, order: u8, x: T, sides: Sides, first: u32) -> T {
        let interval = match sides.code(first, self.bits()) {
            Some(code) => decoded(code),
            None => self.interval(x),
        };
        self.within(interval.min(self.places.len()), order, x)
    }

    fn within<T: Real>(&self, interval: usize, order: u8, x: T) -> T {
        let d = x - self.place(interval.saturating_sub(1));
        let piece = self.pieces.get(interval).copied().unwrap_or_default();
        let [c0, c1, c2, c3] = piece.map(T::from_f64);
        let [two, three, six] = [2.0, 3.0, 6.0].map(T::from_f64);
        match order {
            0 => c0 + d * (c1 + d * (c2 + d * c3)),
            1 => c1 + d * (two * c2 + d * three * c3),
            2 => two * c2 + d * six * c3,
            _ => six * c3,
        }
    }

    /// The switching function of a bit: the distance from the nearest place where it
    /// changes, positive where the bit is set.
    pub fn side<T: Real>(&self, bit: u32, x: T) -> T {
        let (place, set_above) = self.change(bit, x);
        if set_above { x - place } else { place - x }
    }

    /// Its derivative.
    pub fn turn<T: Real>(&self, bit: u32, x: T) -> T {
        match self.change(bit, x) {
            (_, true) => T::one(),
            (_, false) => -T::one(),
        }
    }

    /// The distance from the nearest place: above the first one positive, above the second
    /// one negative, and so on.
    pub fn knot<T: Real>(&self, x: T) -> T {
        let (place, positive_above) = self.nearest(x, self.interval(x), (0, 1));
        if positive_above { x - place } else { place - x }
    }

    /// Its derivative.
    pub fn passing<T: Real>(&self, x: T) -> T {
        match self.nearest(x, self.interval(x), (0, 1)) {
            (_, true) => T::one(),
            (_, false) => -T::one(),
        }
    }

    /// The nearest place at which a bit changes, and whether the bit is set above it.
    fn change<T: Real>(&self, bit: u32, x: T) -> (T, bool) {
        let (half, period) = (1_usize << bit, 2_usize << bit);
        // The bit changes where an interval begins whose number is an odd multiple of `half`.
        let below = (self.interval(x) + half) / period;
        self.nearest(x, below, (half - 1, period))
    }

    /// The nearest of the places from `first` on in distances of `period`, so many of which
    /// are below, and whether it is the first of them, the third, and so on.
    fn nearest<T: Real>(&self, x: T, below: usize, (first, period): (usize, usize)) -> (T, bool) {
        let at = |count: usize| {
            let place = count * period + first;
            let there = place < self.places.len();
            there.then(|| (self.place::<T>(place), count.is_multiple_of(2)))
        };
        let before = below.checked_sub(1).and_then(at);
        match (before, at(below)) {
            (Some(before), Some(after)) if x - before.0 <= after.0 - x => before,
            (before, after) => after.or(before).unwrap_or((x, true)),
        }
    }
}

/// A number from its bits in Gray's code.
fn decoded(code: u32) -> usize {
    let mut number = code;
    for shift in [1, 2, 4, 8, 16] {
        number ^= number >> shift;
    }
    number as usize
}

#[cfg(test)]
mod tests {
    use super::{Table, decoded};
    use crate::Sides;

    const STEPS: Table = Table {
        places: &[0.0, 1.0, 3.0, 4.0, 7.0],
        pieces: &[
            [1.0, 0.0, 0.0, 0.0],
            [1.0, 1.0, 0.0, 0.0],
            [2.0, -1.0, 0.0, 0.0],
            [0.0, 4.0, 0.0, 0.0],
            [4.0, 0.0, 1.0, -0.5],
            [-0.5, 0.0, 0.0, 0.0],
        ],
    };

    /// The interval told by the signs of all bits.
    fn told(x: f64) -> usize {
        let set = |bit: u32| u32::from(STEPS.side(bit, x) > 0.0) << bit;
        decoded((0..STEPS.bits()).map(set).sum())
    }

    #[test]
    fn signs_of_the_switching_functions_tell_the_interval() {
        for (x, interval) in [
            (-5.0, 0),
            (0.5, 1),
            (1.1, 2),
            (2.9, 2),
            (3.5, 3),
            (6.9, 4),
            (9.0, 5),
        ] {
            assert_eq!(told(x), interval, "at {x}");
        }
    }

    #[test]
    fn distances_from_knots_change_their_sign_at_each_of_them() {
        for (x, distance) in [
            (-5.0, -5.0),
            (0.25, 0.25),
            (0.75, 0.25),
            (1.5, -0.5),
            (2.5, -0.5),
            (3.25, 0.25),
            (6.0, -1.0),
            (9.0, 2.0),
        ] {
            assert_eq!(STEPS.knot(x), distance, "at {x}");
            let rate: f64 = (STEPS.knot(x + 1e-3) - distance) / 1e-3;
            assert!((STEPS.passing(x) - rate).abs() < 1e-9, "at {x}");
        }
    }

    #[test]
    fn the_interval_that_is_held_goes_on_beyond_its_ends() {
        let mut sides = Sides::FREE;
        assert_eq!(STEPS.held(0, 3.5, sides, 7), 2.0);
        for bit in 0..STEPS.bits() {
            sides.hold(7 + bit, STEPS.side(bit, 1.5) > 0.0);
        }
        for x in [1.0, 3.5, 100.0] {
            assert_eq!(STEPS.held(0, x, sides, 7), 2.0 - (x - 1.0), "at {x}");
            assert_eq!(STEPS.held(1, x, sides, 7), -1.0, "at {x}");
        }
    }

    #[test]
    fn derivatives_are_those_of_the_pieces() {
        let x = 5.5;
        let d = 1.5;
        let expected = [
            4.0 + d * d - 0.5 * d * d * d,
            2.0 * d - 1.5 * d * d,
            2.0 - 3.0 * d,
            -3.0,
        ];
        for (order, expected) in (0..).zip(expected) {
            assert_eq!(STEPS.value(order, x), expected, "order {order}");
        }
    }
}
