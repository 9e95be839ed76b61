//! Leaves out what no output reads, and puts the rest in order of first use.

use super::program::{Operation, Program, Slot, Value};

/// The program with only those operations that an output needs.
pub(super) fn without_dead(program: &Program) -> Program {
    ordered(program.list(), &program.outputs, &|value| value)
}

/// Makes a program of operations that stand in any order: each comes directly after its
/// operands, in the order in which the outputs need them. A value is read by way of `instead`,
/// which may put another in its place.
pub(super) fn ordered(
    operations: &[Operation],
    outputs: &[(Slot, Value)],
    instead: &dyn Fn(Value) -> Value,
) -> Program {
    let mut program = Program::default();
    let mut places: Vec<Option<Value>> = vec![None; operations.len()];
    // What is read is placed before what reads it.
    let place = |places: &[Option<Value>], x: Value| places[x.index()].unwrap_or(x);
    let mut pending: Vec<(Value, bool)> = Vec::new();
    for (slot, root) in outputs {
        let root = instead(*root);
        pending.push((root, false));
        while let Some((value, ready)) = pending.pop() {
            if places[value.index()].is_some() {
                continue;
            }
            let operation = &operations[value.index()];
            if ready {
                let renamed = renamed(operation, &|x| place(&places, instead(x)));
                places[value.index()] = Some(program.push(renamed));
            } else {
                pending.push((value, true));
                let from = pending.len();
                operation.for_each_operand(&mut |x| pending.push((instead(x), false)));
                pending[from..].reverse();
            }
        }
        program.outputs.push((*slot, place(&places, root)));
    }
    program
}

/// The operation with other operands.
fn renamed(operation: &Operation, place: &dyn Fn(Value) -> Value) -> Operation {
    match operation {
        Operation::Number(_) | Operation::Pi | Operation::Symbol(_) => operation.clone(),
        Operation::Input(i, law) => Operation::Input(*i, place(*law)),
        Operation::Sum(terms) => {
            Operation::Sum(terms.iter().map(|(minus, x)| (*minus, place(*x))).collect())
        }
        Operation::Product(factors) => {
            Operation::Product(factors.iter().map(|x| place(*x)).collect())
        }
        Operation::Quotient(x, y) => Operation::Quotient(place(*x), place(*y)),
        Operation::Function(function, x) => Operation::Function(*function, place(*x)),
        Operation::Function2(function, x, y) => {
            Operation::Function2(*function, place(*x), place(*y))
        }
        Operation::Select(comparison, parts) => Operation::Select(*comparison, parts.map(place)),
    }
}
