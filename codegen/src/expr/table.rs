//! Functions through many given points, which code holds as data.
//!
//! In:  places and the polynomials between them.
//! Out: values, derivatives, and what tells between which places an argument is.
//!
//! Interval `k` begins at place `k − 1`; the first has no beginning, the last no end. An
//! interval is told by the bits of its number in Gray's code, of which one changes from
//! each interval to the next: so each bit is the sign of a switching function, and a run
//! that holds them holds the interval. `bricard_runtime::Table` computes the same.

use std::cmp::Ordering;
use std::hash::{Hash, Hasher};

/// A function that is a polynomial between any two places.
#[derive(Debug)]
pub struct Table {
    /// Its number in its mechanism.
    pub index: u32,
    /// Where one polynomial ends and the next begins, in rising order.
    pub places: Vec<f64>,
    /// `c₀ + c₁ d + c₂ d² + c₃ d³` in each interval, with the distance `d` from the place
    /// where it begins; from the first place before that.
    pub pieces: Vec<[f64; 4]>,
    /// Whether its first two derivatives are continuous.
    pub smooth: bool,
}

impl Table {
    /// Bits that tell an interval.
    pub fn bits(&self) -> u32 {
        usize::BITS - self.places.len().leading_zeros()
    }

    fn interval(&self, x: f64) -> usize {
        self.places.partition_point(|place| *place <= x)
    }

    fn derivative(&self, order: u8, x: f64) -> f64 {
        let interval = self.interval(x);
        let d = x - self.places[interval.saturating_sub(1)];
        let [c0, c1, c2, c3] = self.pieces[interval];
        match order {
            0 => c0 + d * (c1 + d * (c2 + d * c3)),
            1 => c1 + d * (2.0 * c2 + d * 3.0 * c3),
            2 => 2.0 * c2 + d * 6.0 * c3,
            _ => 6.0 * c3,
        }
    }

    /// The nearest place at which a bit changes, and whether the bit is set above it.
    fn change(&self, bit: u32, x: f64) -> (f64, bool) {
        let (half, period) = (1 << bit, 2 << bit);
        let below = (self.interval(x) + half) / period;
        self.nearest(x, below, (half - 1, period))
    }

    /// The nearest of the places from `first` on in distances of `period`, so many of which
    /// are below, and whether it is the first of them, the third, and so on.
    fn nearest(&self, x: f64, below: usize, (first, period): (usize, usize)) -> (f64, bool) {
        let at = |count: usize| {
            let place = self.places.get(count * period + first)?;
            Some((*place, count.is_multiple_of(2)))
        };
        let before = below.checked_sub(1).and_then(at);
        match (before, at(below)) {
            (Some(before), Some(after)) if x - before.0 <= after.0 - x => before,
            (before, after) => after.or(before).unwrap_or((x, true)),
        }
    }

    /// The nearest place, and whether it is the first one, the third, and so on.
    fn knot(&self, x: f64) -> (f64, bool) {
        self.nearest(x, self.interval(x), (0, 1))
    }

    /// The distance from the nearest place, positive above it or below it.
    fn distance((place, positive_above): (f64, bool), x: f64) -> f64 {
        if positive_above { x - place } else { place - x }
    }

    /// The derivative of that.
    fn slope((_, positive_above): (f64, bool)) -> f64 {
        if positive_above { 1.0 } else { -1.0 }
    }
}

/// What is looked up in a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Entry {
    /// The function itself, or its derivative of an order.
    Derivative(u8),
    /// The switching function of a bit: the distance from the nearest place where it
    /// changes, with the sign of the bit.
    Side(u32),
    /// The derivative of that.
    Turn(u32),
    /// The distance from the nearest place: above the first one positive, above the second
    /// one negative, and so on.
    Knot,
    /// The derivative of that.
    Passing,
}

/// Something in a table, as a function of one number.
#[derive(Clone, Copy, Debug)]
pub struct Lookup {
    /// The table.
    pub table: &'static Table,
    /// What of it.
    pub entry: Entry,
    /// The first of the switching functions that a run may hold.
    pub held: Option<u32>,
}

impl Lookup {
    /// The function of a table.
    pub fn of(table: &'static Table) -> Self {
        Self {
            table,
            entry: Entry::Derivative(0),
            held: None,
        }
    }

    /// Its value.
    pub fn apply(self, x: f64) -> f64 {
        match self.entry {
            Entry::Derivative(order) => self.table.derivative(order, x),
            Entry::Side(bit) => Table::distance(self.table.change(bit, x), x),
            Entry::Turn(bit) => Table::slope(self.table.change(bit, x)),
            Entry::Knot => Table::distance(self.table.knot(x), x),
            Entry::Passing => Table::slope(self.table.knot(x)),
        }
    }

    /// Its derivative; none if that is zero.
    pub fn slope(self) -> Option<Self> {
        let degree = if self.table.smooth { 3 } else { 1 };
        let entry = match self.entry {
            Entry::Derivative(order) if order < degree => Entry::Derivative(order + 1),
            Entry::Side(bit) => Entry::Turn(bit),
            Entry::Knot => Entry::Passing,
            Entry::Derivative(_) | Entry::Turn(_) | Entry::Passing => return None,
        };
        Some(Self { entry, ..self })
    }

    /// Whether a run has to hold the interval.
    pub fn jumps(self) -> bool {
        !self.table.smooth && self.held.is_none() && matches!(self.entry, Entry::Derivative(_))
    }

    /// Whether it has a derivative everywhere.
    pub fn is_differentiable(self) -> bool {
        self.table.smooth
    }

    /// The name it has in a description.
    pub fn name(self) -> &'static str {
        if self.table.smooth { "spline" } else { "table" }
    }

    fn key(&self) -> (u32, Entry, Option<u32>) {
        (self.table.index, self.entry, self.held)
    }
}

impl PartialEq for Lookup {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Eq for Lookup {}

impl Hash for Lookup {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.key().hash(state);
    }
}

impl PartialOrd for Lookup {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Lookup {
    fn cmp(&self, other: &Self) -> Ordering {
        self.key().cmp(&other.key())
    }
}
