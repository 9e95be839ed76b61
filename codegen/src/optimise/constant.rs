//! What a program writes once: the outputs that are numbers.
//!
//! In:  a program.
//! Out: a program of those outputs, and one of all others in the order in which they stood.

use super::dead::without_dead;
use super::program::{Operation, Program, Value};

/// Takes the outputs that are numbers out, into a program of their own: the numbers, and the
/// rest.
pub fn numbers_apart(program: &Program) -> (Program, Program) {
    let (mut numbers, mut rest) = (Program::default(), program.clone());
    rest.outputs.clear();
    for (slot, value) in &program.outputs {
        match copy_number(program, *value, &mut numbers) {
            Some(number) => numbers.outputs.push((*slot, number)),
            None => rest.outputs.push((*slot, *value)),
        }
    }
    (numbers, without_dead(&rest))
}

/// Writes a value into another program, if it is a number or one with its sign changed.
fn copy_number(program: &Program, value: Value, other: &mut Program) -> Option<Value> {
    match program.operation(value) {
        number @ Operation::Number(_) => Some(other.push(number.clone())),
        Operation::Sum(terms) => match terms[..] {
            [(negative, term)] => {
                let term = copy_number(program, term, other)?;
                Some(other.push(Operation::Sum(vec![(negative, term)])))
            }
            _ => None,
        },
        _ => None,
    }
}
