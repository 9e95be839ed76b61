//! Solves with velocities that bodies share as unknowns of their own.
//!
//! In:  a program for `mass` and `force` of these and of the coordinates, in this order, and
//!      for `links`, what these are made of.
//! Out: a program for the accelerations of the coordinates.
//!
//! The sweep goes from the last body back. A shared velocity is replaced by what it is made
//! of, which adds the inertia of its body, and of those behind it, to that of the bodies
//! before it. A coordinate that is part of no shared velocity any more is eliminated. These
//! are the sweeps of the articulated-body algorithm (Featherstone, Rigid Body Dynamics
//! Algorithms (2008), section 7.3), found without knowing what a body is.
//!
//! Only coordinates are divided by, and what they are divided by are the pivots of `M`
//! itself: there is such a program wherever `M` is definite, whether or not the mass matrix
//! of all unknowns is. Their sizes, the diagonal of `M`, come of the same replacements without
//! eliminating anything: the inertia of composite bodies.

use super::algebra::{Algebra, Entry, Signed, Sparse};
use super::{OPERATIONS_MAX, Solved, Way};
use crate::expr::{Arithmetic, Number, Symmetric};
use crate::optimise::dead::ordered;
use crate::optimise::program::{Program, Slot, Value};

/// The accelerations of `n` coordinates, beside which `count` velocities are shared.
pub(in crate::optimise) fn with_shared(
    program: &Program,
    (n, count): (usize, usize),
) -> Option<Solved> {
    let (mut algebra, mut entries) = Algebra::behind(program, OPERATIONS_MAX);
    let mut take = |array| entries.remove(array).unwrap_or_default();
    let (mass, force) = (take("mass"), take("force"));
    let order = Order::of(&take("links"), n, count);
    let diagonal = algebra.diagonal(&mass, &order)?;
    let steps = algebra.steps(&mass, &order)?;
    let driving = (0..count + n).map(|i| force.get(&(i, 0)).copied());
    let acceleration = algebra.swept(&steps, driving.collect());
    let mut outputs: Vec<(Slot, Value)> = Vec::new();
    let mut write = |array, row, entry| {
        let slot = Slot::of_vector(array, row);
        outputs.extend(algebra.unsigned(entry).map(|value| (slot, value)));
    };
    for (row, entry) in acceleration[count..].iter().enumerate() {
        write("acceleration", row, *entry);
    }
    for step in &steps {
        if let &Step::Eliminated { place, pivot, .. } = step
            && diagonal[place] != Some(pivot)
        {
            write("mass_pivots", place - count, Some(pivot));
            write("mass_diagonal", place - count, diagonal[place]);
        }
    }
    Some(Solved {
        program: ordered(algebra.program.list(), &outputs, &|value| value),
        way: Way::Shared,
    })
}

/// What shared velocities are made of, and the order of the steps.
struct Order {
    /// By shared velocity: the places of its parts, which come before it or are velocities of
    /// coordinates, and their coefficients.
    parts: Vec<Vec<(usize, Signed)>>,
    /// Places: shared velocities from the last back, and each coordinate as soon as no shared
    /// velocity that is left is made of it.
    places: Vec<usize>,
}

impl Order {
    fn of(links: &Sparse, n: usize, count: usize) -> Self {
        let mut parts = vec![Vec::new(); count];
        let mut first = vec![None; count + n];
        for (&(row, place), &entry) in links {
            parts[row].push((place, entry));
            first[place].get_or_insert(row);
        }
        let first = &first;
        let ready = |row| (count..count + n).filter(move |place| first[*place] == row);
        let mut places: Vec<usize> = ready(None).collect();
        for row in (0..count).rev() {
            places.push(row);
            places.extend(ready(Some(row)));
        }
        Self { parts, places }
    }
}

/// A step of an elimination.
enum Step<'a> {
    /// A shared velocity was replaced by its parts.
    Replaced {
        place: usize,
        parts: &'a [(usize, Signed)],
    },
    /// A coordinate was eliminated.
    Eliminated {
        place: usize,
        pivot: Signed,
        inverse: Signed,
        /// Its column, divided by the pivot.
        column: Vec<(usize, Signed)>,
    },
}

impl Arithmetic for Algebra {
    type Value = Signed;

    fn plus(&mut self, x: Entry, y: Entry) -> Entry {
        self.sum(x.into_iter().chain(y).collect())
    }

    fn plus_product(&mut self, x: Entry, a: Entry, b: Entry) -> Entry {
        self.minus_product(x, a.map(|(minus, value)| (!minus, value)), b)
    }
}

impl Algebra {
    /// The diagonal of `M`, by the places of coordinates; `None` where the program becomes
    /// too long.
    fn diagonal(&mut self, mass: &Sparse, order: &Order) -> Option<Vec<Entry>> {
        let mut rest = left_of(mass, order);
        let mut diagonal = vec![None; order.places.len()];
        for &place in &order.places {
            match order.parts.get(place) {
                Some(parts) => rest.replace(self, place, parts),
                None => (diagonal[place], _) = rest.take(place),
            }
            if self.is_too_long() {
                return None;
            }
        }
        Some(diagonal)
    }

    /// All steps of the elimination; `None` where a pivot is zero by structure or the program
    /// becomes too long.
    fn steps<'a>(&mut self, mass: &Sparse, order: &'a Order) -> Option<Vec<Step<'a>>> {
        let mut rest = left_of(mass, order);
        let mut steps = Vec::new();
        for &place in &order.places {
            steps.push(match order.parts.get(place) {
                Some(parts) => {
                    rest.replace(self, place, parts);
                    Step::Replaced { place, parts }
                }
                None => self.eliminated(&mut rest, place)?,
            });
            if self.is_too_long() {
                return None;
            }
        }
        Some(steps)
    }

    /// Eliminates a coordinate; `None` where its pivot is zero by structure.
    fn eliminated(&mut self, rest: &mut Symmetric<Signed>, place: usize) -> Option<Step<'static>> {
        let (pivot, beside) = rest.take(place);
        let pivot = pivot.filter(|pivot| !self.as_number(pivot.1).is_some_and(Number::is_zero))?;
        let inverse = self.inverse(pivot);
        let mut column: Vec<(usize, Signed)> = Vec::with_capacity(beside.len());
        for (&i, &entry) in &beside {
            let factor = self.product(Some(entry), Some(inverse));
            column.extend(factor.map(|factor| (i, factor)));
        }
        for (k, &(i, (minus, factor))) in column.iter().enumerate() {
            for (&j, &entry) in beside.iter().take(k + 1) {
                rest.add(self, (i, j), (Some((!minus, factor)), Some(entry)));
            }
        }
        Some(Step::Eliminated {
            place,
            pivot,
            inverse,
            column,
        })
    }

    /// The solution: what drives is carried along the steps, and accelerations back.
    fn swept(&mut self, steps: &[Step], mut x: Vec<Entry>) -> Vec<Entry> {
        for step in steps {
            match step {
                Step::Replaced { place, parts } => {
                    for &(i, g) in *parts {
                        x[i] = self.plus_product(x[i], Some(g), x[*place]);
                    }
                }
                Step::Eliminated { place, column, .. } => {
                    for &(i, factor) in column {
                        x[i] = self.minus_product(x[i], Some(factor), x[*place]);
                    }
                }
            }
        }
        for step in steps.iter().rev() {
            match step {
                Step::Replaced { place, parts } => {
                    let (g, u): (Vec<Entry>, Vec<Entry>) =
                        parts.iter().map(|&(i, g)| (Some(g), x[i])).unzip();
                    x[*place] = self.dot(&g, &u, None);
                }
                Step::Eliminated {
                    place,
                    inverse,
                    column,
                    ..
                } => {
                    let mut entry = self.product(x[*place], Some(*inverse));
                    for &(i, factor) in column {
                        entry = self.minus_product(entry, Some(factor), x[i]);
                    }
                    x[*place] = entry;
                }
            }
        }
        x
    }
}

/// A mass matrix, of which nothing is taken out yet.
fn left_of(mass: &Sparse, order: &Order) -> Symmetric<Signed> {
    let entries = mass.iter().map(|(place, entry)| (*place, *entry));
    Symmetric::of(entries, order.places.len())
}
