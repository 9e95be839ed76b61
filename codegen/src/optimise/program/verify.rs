//! What every program satisfies; checked after each pass.
//!
//! - Operands come before their users.
//! - A sum has a term, and one positive term alone is no sum.
//! - A product has at least two factors.
//! - A number is finite, and no negative one is a term (signs belong to sums).
//! - Each slot is written once.
//! - Every operation is read.

use super::{Operation, Program, Value};
use std::collections::HashSet;

/// The first broken invariant, if any. A broken invariant is a bug of this crate,
/// never of a description.
pub fn verify(program: &Program) -> Result<(), String> {
    for (value, operation) in program.operations() {
        let mut late = false;
        operation.for_each_operand(&mut |operand| late |= operand >= value);
        if late {
            return Err(format!("{value:?} reads a later value: {operation:?}"));
        }
        let sound = match operation {
            Operation::Sum(terms) => {
                let all_positive = terms.iter().all(|(_, x)| !is_negative(program, *x));
                all_positive && !terms.is_empty() && (terms.len() > 1 || terms[0].0)
            }
            Operation::Product(factors) => factors.len() > 1,
            Operation::Number(number) => number.is_finite(),
            _ => true,
        };
        if !sound {
            return Err(format!("{value:?} is malformed: {operation:?}"));
        }
    }
    let mut written = HashSet::new();
    if let Some((slot, _)) = program
        .outputs
        .iter()
        .find(|(slot, _)| !written.insert(*slot))
    {
        return Err(format!("{slot:?} is written twice"));
    }
    match program.uses().iter().position(|uses| *uses == 0) {
        Some(unused) => Err(format!("operation {unused} is never read")),
        None => Ok(()),
    }
}

/// Whether a value is a negative number: a factor may be one, of a term the sum has the sign.
fn is_negative(program: &Program, value: Value) -> bool {
    match program.operation(value) {
        Operation::Number(number) => number.is_negative(),
        _ => false,
    }
}
