//! Puts signs into numbers.
//!
//! In:  a program.
//! Out: the same, where `−(c x)` that is written is a product with the number `−c`, and what
//!      else reads `c x` takes the other sign where that is free: in sums, and in products.

use super::dead::ordered;
use super::program::{Operation, Program, Value};
use crate::expr::Number;
use rustc_hash::FxHashMap;

/// A program, and which of its values change their sign.
struct Signs<'a> {
    program: &'a Program,
    /// By value: who reads it.
    readers: Vec<Vec<Value>>,
    /// By value: how often it is read, outputs included.
    uses: Vec<usize>,
    /// By value: whether it is written as it is.
    written: Vec<bool>,
    /// By value: whether its sign changes.
    turned: Vec<bool>,
}

/// The program with fewer changes of sign; never costlier.
pub(super) fn into_numbers(program: &Program) -> Program {
    let mut signs = Signs::of(program);
    let outputs = program.outputs.iter();
    let mut left: Vec<Value> = outputs
        .filter_map(|(_, value)| program.opposite_of(*value))
        .collect();
    // One may make room for another, in a sum that has to begin with something.
    let mut before = left.len() + 1;
    while left.len() < before {
        before = left.len();
        left.retain(|product| !signs.turn(*product));
    }
    match signs.turned.contains(&true) {
        true => signs.applied(),
        false => program.clone(),
    }
}

impl Program {
    /// The product with a number whose opposite a value is.
    fn opposite_of(&self, value: Value) -> Option<Value> {
        let Operation::Sum(terms) = self.operation(value) else {
            return None;
        };
        match terms[..] {
            [(true, product)] => self.number_of(product).map(|_| product),
            _ => None,
        }
    }

    /// The number among the factors of a product, and where it stands.
    fn number_of(&self, value: Value) -> Option<(usize, Number)> {
        let Operation::Product(factors) = self.operation(value) else {
            return None;
        };
        let mut places = factors.iter().enumerate();
        places.find_map(|(place, factor)| match self.operation(*factor) {
            Operation::Number(number) => Some((place, *number)),
            _ => None,
        })
    }
}

impl<'a> Signs<'a> {
    fn of(program: &'a Program) -> Self {
        let mut readers = vec![Vec::new(); program.len()];
        for (value, operation) in program.operations() {
            operation.for_each_operand(&mut |operand| readers[operand.index()].push(value));
        }
        let mut written = vec![false; program.len()];
        for (_, value) in &program.outputs {
            written[value.index()] = true;
        }
        Self {
            program,
            readers,
            uses: program.uses(),
            written,
            turned: vec![false; program.len()],
        }
    }

    /// Changes the sign of a product with a number, and of the products that it makes change
    /// theirs, if nobody has to change it back; whether it did.
    fn turn(&mut self, product: Value) -> bool {
        let before = self.turned.clone();
        let turned = self.turn_all(product, &before).is_some();
        if !turned {
            self.turned = before;
        }
        turned
    }

    /// Changes these signs one after the other; `None` where one would have to be changed back,
    /// with those marked that were changed before.
    fn turn_all(&mut self, product: Value, before: &[bool]) -> Option<()> {
        let mut pending = vec![product];
        let mut sums = Vec::new();
        while let Some(value) = pending.pop() {
            if self.written[value.index()] || self.turned[value.index()] {
                return None;
            }
            self.turned[value.index()] = true;
            for reader in &self.readers[value.index()] {
                match self.program.operation(*reader) {
                    Operation::Sum(_) => sums.push(*reader),
                    // Its own number takes the sign.
                    Operation::Product(_) if self.program.number_of(*reader).is_some() => {}
                    Operation::Product(_) => pending.push(*reader),
                    _ => return None,
                }
            }
        }
        let free = sums.iter().all(|sum| self.stays_free(*sum, before));
        free.then_some(())
    }

    /// Whether a sum still begins with what is as good to begin with as it was before: with a
    /// term that is added, and that is no product which goes with the sum into one operation.
    fn stays_free(&self, sum: Value, before: &[bool]) -> bool {
        let Operation::Sum(terms) = self.program.operation(sum) else {
            return true;
        };
        // What only changes a sign goes.
        if terms.len() == 1 {
            return true;
        }
        let beginning = |turned: &[bool]| {
            let added = terms
                .iter()
                .filter(|(minus, x)| *minus == turned[x.index()]);
            let plain = |x: Value| {
                let is_product = matches!(self.program.operation(x), Operation::Product(_));
                !is_product || self.uses[x.index()] > 1
            };
            added.map(|(_, x)| 1 + u8::from(plain(*x))).max()
        };
        beginning(&self.turned) >= beginning(before)
    }

    /// The program with the signs changed.
    fn applied(&self) -> Program {
        let mut operations = self.program.list().to_vec();
        let mut instead: FxHashMap<Value, Value> = FxHashMap::default();
        for (value, operation) in self.program.operations() {
            match operation {
                Operation::Sum(terms) => match terms[..] {
                    [(true, x)] if self.turned[x.index()] => {
                        instead.insert(value, x);
                    }
                    _ => operations[value.index()] = Operation::Sum(self.terms(terms)),
                },
                Operation::Product(factors) => {
                    let turned = |x: &Value| self.turned[x.index()];
                    let inside = factors.iter().fold(false, |sign, x| sign ^ turned(x));
                    if inside == turned(&value) {
                        continue;
                    }
                    if let Some((place, number)) = self.program.number_of(value) {
                        let mut factors = factors.clone();
                        factors[place] = Value::at(operations.len());
                        operations.push(Operation::Number(-number));
                        operations[value.index()] = Operation::Product(factors);
                    }
                }
                _ => {}
            }
        }
        let instead = |value: Value| instead.get(&value).copied().unwrap_or(value);
        ordered(&operations, &self.program.outputs, &instead)
    }

    /// Terms with their signs changed.
    fn terms(&self, terms: &[(bool, Value)]) -> Vec<(bool, Value)> {
        let turned = |(minus, x): &(bool, Value)| (minus ^ self.turned[x.index()], *x);
        terms.iter().map(turned).collect()
    }
}
