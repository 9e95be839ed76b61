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
        let interval = self.interval(x);
        let (half, period) = (1 << bit, 2 << bit);
        let below = (interval + half) / period;
        let at = |count: usize| {
            let place = (count * period + half).checked_sub(1)?;
            Some((*self.places.get(place)?, count.is_multiple_of(2)))
        };
        let before = below.checked_sub(1).and_then(at);
        match (before, at(below)) {
            (Some(before), Some(after)) if x - before.0 <= after.0 - x => before,
            (before, after) => after.or(before).unwrap_or((x, true)),
        }
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
            Entry::Side(bit) => {
                let (place, set_above) = self.table.change(bit, x);
                if set_above { x - place } else { place - x }
            }
            Entry::Turn(bit) => match self.table.change(bit, x) {
                (_, true) => 1.0,
                (_, false) => -1.0,
            },
        }
    }

    /// Its derivative; none if that is zero.
    pub fn slope(self) -> Option<Self> {
        let degree = if self.table.smooth { 3 } else { 1 };
        let entry = match self.entry {
            Entry::Derivative(order) if order < degree => Entry::Derivative(order + 1),
            Entry::Side(bit) => Entry::Turn(bit),
            Entry::Derivative(_) | Entry::Turn(_) => return None,
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
