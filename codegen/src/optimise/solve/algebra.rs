//! Arithmetic on signed values with structural zeros.
//!
//! An [`Entry`] is absent where it is zero by structure. Numbers are folded
//! exactly, and signs are carried beside the values so that they cost nothing.

use crate::expr::Number;
use crate::optimise::program::{Operation, Program, Value};
use std::collections::BTreeMap;

/// A value and whether it is subtracted.
pub(super) type Signed = (bool, Value);

/// A signed value; absent where it is zero by structure.
pub(super) type Entry = Option<Signed>;

/// What was divided by, and what it is to be compared with.
pub(super) type Pivot = (Signed, Signed);

/// A sparse matrix by row and column.
pub(super) type Sparse = BTreeMap<(usize, usize), Signed>;

/// Appends arithmetic to a program.
pub(super) struct Algebra {
    pub program: Program,
    /// The longest program that is worth while: of two ways the shorter one is taken.
    pub longest: usize,
}

impl Algebra {
    /// Arithmetic behind a program, and the arrays that it computes.
    pub fn behind(program: &Program, longest: usize) -> (Self, BTreeMap<&'static str, Sparse>) {
        let algebra = Self {
            program: program.clone(),
            longest,
        };
        let mut arrays: BTreeMap<&'static str, Sparse> = BTreeMap::new();
        for (slot, value) in &program.outputs {
            let entry = algebra.signed(*value);
            let array = arrays.entry(slot.array).or_default();
            array.insert((slot.row, slot.column), entry);
        }
        (algebra, arrays)
    }

    /// Whether there are more operations than are worth while.
    pub fn is_too_long(&self) -> bool {
        self.program.len() > self.longest
    }

    /// `Σ x_k y_k − less`.
    pub fn dot(&mut self, x: &[Entry], y: &[Entry], less: Entry) -> Entry {
        let pairs = x.iter().zip(y);
        let mut terms: Vec<Signed> = pairs.filter_map(|(x, y)| self.product(*x, *y)).collect();
        terms.extend(less.map(|(minus, value)| (!minus, value)));
        self.sum(terms)
    }

    /// `x − a·b`.
    pub fn minus_product(&mut self, x: Entry, a: Entry, b: Entry) -> Entry {
        let Some((minus, product)) = self.product(a, b) else {
            return x;
        };
        let terms = x.into_iter().chain([(!minus, product)]).collect();
        self.sum(terms)
    }

    pub fn product(&mut self, a: Entry, b: Entry) -> Entry {
        let ((minus_a, a), (minus_b, b)) = (a?, b?);
        let minus = minus_a != minus_b;
        let value = match (self.as_number(a), self.as_number(b)) {
            (Some(x), Some(y)) => self.number(x * y),
            (Some(x), _) if x.is_one() => b,
            (_, Some(y)) if y.is_one() => a,
            _ => self.program.push(Operation::Product(vec![a, b])),
        };
        Some((minus, value))
    }

    pub fn sum(&mut self, terms: Vec<Signed>) -> Entry {
        let mut number = Number::ZERO;
        let mut kept: Vec<Signed> = Vec::new();
        for (minus, value) in terms {
            match self.as_number(value) {
                Some(x) => number = number + if minus { -x } else { x },
                // Equal terms of opposite sign cancel exactly.
                None => match kept.iter().position(|term| *term == (!minus, value)) {
                    Some(opposite) => drop(kept.remove(opposite)),
                    None => kept.push((minus, value)),
                },
            }
        }
        if !number.is_zero() {
            let size = if number.is_negative() {
                -number
            } else {
                number
            };
            kept.push((number.is_negative(), self.number(size)));
        }
        match kept[..] {
            [] => None,
            [only] => Some(only),
            _ if kept.iter().all(|(minus, _)| *minus) => {
                let positive = kept.iter().map(|(_, value)| (false, *value)).collect();
                Some((true, self.program.push(Operation::Sum(positive))))
            }
            _ => Some((false, self.program.push(Operation::Sum(kept)))),
        }
    }

    pub fn inverse(&mut self, (minus, value): Signed) -> Signed {
        let exact = self.as_number(value).and_then(|x| x.powi(-1));
        let inverse = match exact {
            Some(x) => self.number(x),
            None => {
                let one = self.number(Number::ONE);
                self.program.push(Operation::Quotient(one, value))
            }
        };
        (minus, inverse)
    }

    pub fn number(&mut self, value: Number) -> Value {
        self.program.push(Operation::Number(value))
    }

    pub fn as_number(&self, value: Value) -> Option<Number> {
        match self.program.operation(value) {
            Operation::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// A value without a change of sign in front.
    pub fn signed(&self, value: Value) -> Signed {
        match self.program.operation(value) {
            Operation::Sum(terms) if terms.len() == 1 && terms[0].0 => (true, terms[0].1),
            _ => (false, value),
        }
    }

    pub fn unsigned(&mut self, entry: Entry) -> Option<Value> {
        let (minus, value) = entry?;
        Some(if minus {
            self.program.push(Operation::Sum(vec![(true, value)]))
        } else {
            value
        })
    }
}
