//! Straight-line programs: what an emitted function computes, in order.
//!
//! A [`Program`] is single-assignment. Each [`Value`] is an index into its
//! operations; operands come before their users. It knows no mechanics: an
//! output is an entry of a named array. A program has a cost and a text, can be run
//! ([`interpret`]) and checked ([`verify`]).

mod count;
mod interpret;
mod text;
mod verify;

pub use count::{Cost, cost};
pub use interpret::interpret;
pub use verify::verify;

use crate::expr::{Function, Function2, Number, Test};
use crate::model::Symbol;
use rustc_hash::FxHashMap;
use std::collections::hash_map::Entry;

/// The result of an operation of a [`Program`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Value(u32);

impl Value {
    /// The value at a place of a program.
    pub(in crate::optimise) fn at(index: usize) -> Self {
        Value(u32::try_from(index).unwrap_or(u32::MAX))
    }

    /// Its place in the program.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// One operation.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// A number.
    Number(Number),
    /// π.
    Pi,
    /// A symbol other than an input.
    Symbol(Symbol),
    /// An input: held at a value from outside, or else its default law.
    Input(u32, Value),
    /// A sum of terms, each added or (`true`) subtracted. One subtracted term is a
    /// change of sign.
    Sum(Vec<(bool, Value)>),
    /// A product of two or more factors.
    Product(Vec<Value>),
    /// The first divided by the second.
    Quotient(Value, Value),
    /// A function of one argument.
    Function(Function, Value),
    /// A function of two arguments.
    Function2(Function2, Value, Value),
    /// `if left ⋈ right then … else …`.
    Select(Test, [Value; 4]),
}

impl Operation {
    /// The values it reads.
    pub fn operands(&self) -> Vec<Value> {
        let mut operands = Vec::new();
        self.for_each_operand(&mut |operand| operands.push(operand));
        operands
    }

    /// The same operation of other values, which are asked for in the order in which it reads them.
    pub fn with_operands(&self, other: &mut dyn FnMut(Value) -> Value) -> Self {
        match self {
            Operation::Number(_) | Operation::Pi | Operation::Symbol(_) => self.clone(),
            Operation::Sum(terms) => {
                let terms = terms.iter().map(|(minus, value)| (*minus, other(*value)));
                Operation::Sum(terms.collect())
            }
            Operation::Product(factors) => {
                Operation::Product(factors.iter().map(|factor| other(*factor)).collect())
            }
            Operation::Input(index, x) => Operation::Input(*index, other(*x)),
            Operation::Function(function, x) => Operation::Function(*function, other(*x)),
            Operation::Quotient(x, y) => Operation::Quotient(other(*x), other(*y)),
            Operation::Function2(function, x, y) => {
                Operation::Function2(*function, other(*x), other(*y))
            }
            Operation::Select(test, parts) => Operation::Select(*test, parts.map(other)),
        }
    }

    /// Shows the values it reads, in order.
    pub(in crate::optimise) fn for_each_operand(&self, show: &mut dyn FnMut(Value)) {
        match self {
            Operation::Number(_) | Operation::Pi | Operation::Symbol(_) => {}
            Operation::Sum(terms) => {
                for (_, value) in terms {
                    show(*value);
                }
            }
            Operation::Product(factors) => {
                for factor in factors {
                    show(*factor);
                }
            }
            Operation::Input(_, x) | Operation::Function(_, x) => show(*x),
            Operation::Quotient(x, y) | Operation::Function2(_, x, y) => {
                show(*x);
                show(*y);
            }
            Operation::Select(_, parts) => {
                for part in parts {
                    show(*part);
                }
            }
        }
    }
}

/// An entry of a named output array; `column` is zero for a vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Slot {
    /// The array.
    pub array: &'static str,
    /// The row.
    pub row: usize,
    /// The column.
    pub column: usize,
}

impl Slot {
    /// An entry of a vector.
    pub fn of_vector(array: &'static str, row: usize) -> Self {
        let column = 0;
        Self { array, row, column }
    }
}

/// A straight-line program.
#[derive(Clone, Debug, Default)]
pub struct Program {
    operations: Vec<Operation>,
    index: FxHashMap<Operation, Value>,
    /// What is written, in order.
    pub outputs: Vec<(Slot, Value)>,
}

impl Program {
    /// Adds an operation, or finds the equal one that is there already. Factors are
    /// put in order; so are terms, those that are added before those that are not.
    pub fn push(&mut self, mut operation: Operation) -> Value {
        match &mut operation {
            Operation::Product(factors) => factors.sort_unstable(),
            Operation::Sum(terms) => terms.sort_unstable(),
            _ => {}
        }
        match self.index.entry(operation) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(free) => {
                let value = Value::at(self.operations.len());
                self.operations.push(free.key().clone());
                *free.insert(value)
            }
        }
    }

    /// The result of an operation, if it is there.
    pub fn value(&self, operation: &Operation) -> Option<Value> {
        self.index.get(operation).copied()
    }

    /// The operation that a value is the result of.
    pub fn operation(&self, value: Value) -> &Operation {
        &self.operations[value.index()]
    }

    /// All operations in order.
    pub(in crate::optimise) fn list(&self) -> &[Operation] {
        &self.operations
    }

    /// All operations in order, with their values.
    pub fn operations(&self) -> impl Iterator<Item = (Value, &Operation)> {
        self.operations
            .iter()
            .enumerate()
            .map(|(i, operation)| (Value::at(i), operation))
    }

    /// The number of operations.
    pub fn len(&self) -> usize {
        self.operations.len()
    }

    /// Whether it computes nothing.
    pub fn is_empty(&self) -> bool {
        self.operations.is_empty()
    }

    /// Whether all numbers in it are finite.
    pub(in crate::optimise) fn has_finite_numbers(&self) -> bool {
        let is_finite = |operation: &Operation| match operation {
            Operation::Number(number) => number.is_finite(),
            _ => true,
        };
        self.operations.iter().all(is_finite)
    }

    /// Whether it reads a symbol of some kind.
    pub fn reads(&self, kind: impl Fn(&Symbol) -> bool) -> bool {
        let is_kind = |operation: &Operation| match operation {
            Operation::Symbol(symbol) => kind(symbol),
            _ => false,
        };
        self.operations.iter().any(is_kind)
    }

    /// Whether its outputs are the entries of one vector.
    pub fn is_list(&self) -> bool {
        let mut slots = self.outputs.iter().map(|(slot, _)| slot);
        let first = slots.next();
        first.is_some_and(|first| first.column == 0)
            && slots
                .all(|slot| Some(slot.array) == first.map(|first| first.array) && slot.column == 0)
    }

    /// By value: the entries that it is.
    pub fn slots(&self) -> Vec<Vec<Slot>> {
        let mut slots = vec![Vec::new(); self.len()];
        for (slot, value) in &self.outputs {
            slots[value.index()].push(*slot);
        }
        slots
    }

    /// How often each value is read, outputs included.
    pub fn uses(&self) -> Vec<usize> {
        let mut uses = vec![0; self.len()];
        for (_, operation) in self.operations() {
            operation.for_each_operand(&mut |operand| uses[operand.index()] += 1);
        }
        for (_, value) in &self.outputs {
            uses[value.index()] += 1;
        }
        uses
    }
}
