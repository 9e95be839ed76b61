//! Leaves out what no output reads, and puts the rest in order of first use.

use super::program::{Operation, Program, Slot, Value};
use rustc_hash::FxHashMap;

/// The program with only those operations that an output needs.
pub(super) fn without_dead(program: &Program) -> Program {
    let operations: Vec<Operation> = program.operations().map(|(_, o)| o.clone()).collect();
    ordered(&operations, &program.outputs)
}

/// A program of operations in any order that has one: each operation directly
/// after its operands, in the order in which the outputs ask for them.
pub(super) fn ordered(operations: &[Operation], outputs: &[(Slot, Value)]) -> Program {
    let mut program = Program::default();
    let mut place: FxHashMap<Value, Value> = FxHashMap::default();
    for (slot, root) in outputs {
        let mut pending = vec![(*root, false)];
        while let Some((value, ready)) = pending.pop() {
            if place.contains_key(&value) {
                continue;
            }
            let operation = &operations[value.index()];
            if ready {
                let moved = program.push(renamed(operation, &|operand| place[&operand]));
                place.insert(value, moved);
            } else {
                pending.push((value, true));
                pending.extend(operation.operands().into_iter().rev().map(|x| (x, false)));
            }
        }
        program.outputs.push((*slot, place[root]));
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
