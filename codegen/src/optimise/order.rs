//! The order of the outputs of a program.
//!
//! In:  a program.
//! Out: the same one, with outputs that read the same coordinates one after the other,
//!      and the operations in the order in which these ask for them. What one output
//!      has computed is then still at hand for the next, however many there are.
//!
//! Coordinates are put in a row so that those that meet in an output are near each
//! other (Cuthill & McKee 1969, "Reducing the bandwidth of sparse symmetric matrices").

use super::dead::ordered;
use super::program::{Operation, Program, Value};
use crate::expr::Symbol;
use rustc_hash::FxHashSet;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Indices of coordinates.
type Coordinates = BTreeSet<u32>;

/// The program in an order that keeps what belongs together together.
pub(super) fn arranged(program: &Program) -> Program {
    let read = coordinates_read(program);
    let of = |value: &Value| &read[value.index()];
    let sets: FxHashSet<&Coordinates> = program.outputs.iter().map(|(_, x)| of(x)).collect();
    let place = places(&sets);
    let last = |value: &Value| of(value).iter().map(|i| place[i]).max();
    let mut outputs = program.outputs.clone();
    outputs.sort_by_key(|(_, value)| last(value));
    let operations: Vec<Operation> = program.operations().map(|(_, o)| o.clone()).collect();
    ordered(&operations, &outputs)
}

/// The coordinates that each value depends on, themselves or by their velocities.
fn coordinates_read(program: &Program) -> Vec<Coordinates> {
    let mut read: Vec<Coordinates> = Vec::with_capacity(program.len());
    for (_, operation) in program.operations() {
        let mut own = Coordinates::new();
        if let Operation::Symbol(
            Symbol::Coordinate(i) | Symbol::Velocity(i) | Symbol::Acceleration(i),
        ) = operation
        {
            own.insert(*i);
        }
        for operand in operation.operands() {
            own.extend(&read[operand.index()]);
        }
        read.push(own);
    }
    read
}

/// The place of each coordinate in the row: breadth first along those that meet in a
/// set, from one that meets few.
fn places(sets: &FxHashSet<&Coordinates>) -> BTreeMap<u32, usize> {
    let mut met: BTreeMap<u32, Coordinates> = BTreeMap::new();
    for set in sets {
        for i in *set {
            met.entry(*i).or_default().extend(*set);
        }
    }
    let mut by_company: Vec<u32> = met.keys().copied().collect();
    by_company.sort_by_key(|i| met[i].len());
    let mut places: BTreeMap<u32, usize> = BTreeMap::new();
    let mut pending: VecDeque<u32> = VecDeque::new();
    for first in by_company {
        pending.push_back(first);
        while let Some(i) = pending.pop_front() {
            if places.contains_key(&i) {
                continue;
            }
            places.insert(i, places.len());
            let mut next: Vec<u32> = met[&i].iter().copied().collect();
            next.sort_by_key(|j| met[j].len());
            pending.extend(next);
        }
    }
    places
}
