//! The order of the outputs of a program.
//!
//! In:  a program.
//! Out: the same one, with outputs that read the same coordinates one after the other,
//!      and the operations in the order in which these ask for them. What one output
//!      has computed is then still in registers for the next, however many there are.
//!
//! Coordinates are put in a row so that those that meet in an output are near each
//! other (Cuthill & McKee 1969, "Reducing the bandwidth of sparse symmetric matrices").

use super::dead::ordered;
use super::program::{Operation, Program, Value};
use crate::expr::Bits;
use crate::model::Symbol;
use rustc_hash::FxHashSet;
use std::collections::{BTreeMap, VecDeque};

/// The program in an order that keeps what belongs together together.
pub(super) fn arranged(program: &Program) -> Program {
    let read = coordinates_read(program);
    let of = |value: &Value| &read[value.index()];
    let sets: FxHashSet<&Bits> = program.outputs.iter().map(|(_, x)| of(x)).collect();
    let place = places(&sets);
    let last = |value: &Value| of(value).ascending().into_iter().map(|i| place[&i]).max();
    let mut outputs = program.outputs.clone();
    outputs.sort_by_cached_key(|(_, value)| last(value));
    ordered(program.list(), &outputs, &|value| value)
}

/// The coordinates that each value depends on, themselves or by their velocities.
fn coordinates_read(program: &Program) -> Vec<Bits> {
    let coordinate = |operation: &Operation| match operation {
        Operation::Symbol(
            Symbol::Coordinate(i) | Symbol::Velocity(i) | Symbol::Acceleration(i),
        ) => Some(*i as usize),
        _ => None,
    };
    let last = program.list().iter().filter_map(coordinate).max();
    let none = Bits::below(last.map_or(0, |last| last + 1));
    let mut read: Vec<Bits> = Vec::with_capacity(program.len());
    for operation in program.list() {
        let mut own = none.clone();
        if let Some(i) = coordinate(operation) {
            own.insert(i);
        }
        operation.for_each_operand(&mut |operand| own.extend(&read[operand.index()]));
        read.push(own);
    }
    read
}

/// The place of each coordinate in the row: breadth first along those that meet in a
/// set, from one that meets few.
fn places(sets: &FxHashSet<&Bits>) -> BTreeMap<usize, usize> {
    let mut met: BTreeMap<usize, Bits> = BTreeMap::new();
    for set in sets {
        for i in set.ascending() {
            met.entry(i).or_insert_with(|| (*set).clone()).extend(set);
        }
    }
    let mut by_company: Vec<usize> = met.keys().copied().collect();
    by_company.sort_by_key(|i| met[i].len());
    let mut places: BTreeMap<usize, usize> = BTreeMap::new();
    let mut pending: VecDeque<usize> = VecDeque::new();
    for first in by_company {
        pending.push_back(first);
        while let Some(i) = pending.pop_front() {
            if places.contains_key(&i) {
                continue;
            }
            places.insert(i, places.len());
            let mut next = met[&i].ascending();
            next.sort_by_key(|j| met[j].len());
            pending.extend(next);
        }
    }
    places
}
