//! What a program costs.

use super::{Operation, Program, Value};
use crate::expr::Function;
use std::collections::BTreeSet;
use std::fmt;

/// Numbers of operations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Additions and subtractions.
    pub sums: usize,
    /// Multiplications.
    pub products: usize,
    /// Divisions.
    pub quotients: usize,
    /// Angles whose sine and cosine are computed, together.
    pub angles: usize,
    /// Other functions.
    pub functions: usize,
}

impl Cost {
    /// All in one: a function counts as twenty elementary operations.
    pub fn weight(self) -> usize {
        self.sums + self.products + 4 * self.quotients + 20 * (self.angles + self.functions)
    }
}

/// Counts the operations of a program.
pub fn cost(program: &Program) -> Cost {
    let mut cost = Cost::default();
    let mut angles: BTreeSet<Value> = BTreeSet::new();
    for (_, operation) in program.operations() {
        match operation {
            Operation::Sum(terms) => cost.sums += terms.len() - usize::from(!terms[0].0),
            Operation::Product(factors) => cost.products += factors.len() - 1,
            Operation::Quotient(..) => cost.quotients += 1,
            Operation::Function(Function::Sin | Function::Cos, x) => {
                angles.insert(*x);
            }
            Operation::Function(..) | Operation::Function2(..) | Operation::Select(..) => {
                cost.functions += 1;
            }
            Operation::Number(_) | Operation::Pi | Operation::Symbol(_) | Operation::Input(..) => {}
        }
    }
    cost.angles = angles.len();
    cost
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [
            (self.products, "product"),
            (self.sums, "sum"),
            (self.quotients, "quotient"),
            (self.angles, "sine–cosine pair"),
            (self.functions, "other function"),
        ];
        let said: Vec<String> = parts
            .into_iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, name)| format!("{count} {name}{}", if count == 1 { "" } else { "s" }))
            .collect();
        f.write_str(if said.is_empty() { "no operations" } else { "" })?;
        f.write_str(&said.join(", "))
    }
}
