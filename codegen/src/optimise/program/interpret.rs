//! Runs a program on `f64`: what passes and emitted code are checked against.

use super::{Operation, Program, Slot};
use crate::model::Symbol;

/// The outputs of a program; an input takes the value given for its symbol, or
/// its law where that is `None`.
pub fn interpret(program: &Program, values: &dyn Fn(Symbol) -> Option<f64>) -> Vec<(Slot, f64)> {
    let mut known: Vec<f64> = Vec::with_capacity(program.len());
    for (_, operation) in program.operations() {
        let value = step(operation, &known, values);
        known.push(value);
    }
    program
        .outputs
        .iter()
        .map(|(slot, value)| (*slot, known[value.index()]))
        .collect()
}

fn step(operation: &Operation, known: &[f64], values: &dyn Fn(Symbol) -> Option<f64>) -> f64 {
    let of = |value: &super::Value| known[value.index()];
    match operation {
        Operation::Number(value) => value.to_f64(),
        Operation::Pi => std::f64::consts::PI,
        Operation::Symbol(symbol) => values(*symbol).unwrap_or(f64::NAN),
        Operation::Input(i, law) => values(Symbol::Input(*i)).unwrap_or(of(law)),
        Operation::Sum(terms) => {
            terms.iter().fold(
                0.0,
                |sum, (minus, x)| if *minus { sum - of(x) } else { sum + of(x) },
            )
        }
        Operation::Product(factors) => factors.iter().map(of).product(),
        Operation::Quotient(x, y) => of(x) / of(y),
        Operation::Function(function, x) => function.apply(of(x)),
        Operation::Function2(function, x, y) => function.apply(of(x), of(y)),
        Operation::Select(comparison, [a, b, then, otherwise]) => {
            of(if comparison.holds(of(a), of(b)) {
                then
            } else {
                otherwise
            })
        }
    }
}
