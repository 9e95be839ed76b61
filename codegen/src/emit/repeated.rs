//! A program that runs for one value of its arguments after the other.
//!
//! In:  a program, and which of its symbols change from one run to the next.
//! Out: the statements that are the same in all runs, and those that are not.

use super::function::{Place, Words, Writer};
use crate::model::Symbol;
use crate::optimise::{Operation, Program, Value};
use proc_macro2::TokenStream;
use std::collections::BTreeSet;

/// The two parts of a program.
pub(super) struct Repeated {
    /// What is computed before the first run.
    pub once: TokenStream,
    /// What is computed in each run, and where the results go.
    pub again: TokenStream,
}

impl Repeated {
    /// Writes a program.
    pub fn of(
        program: &Program,
        words: Words,
        place: Place,
        changes: &dyn Fn(&Symbol) -> bool,
    ) -> Self {
        let changing = changing(program, changes);
        let values = program.operations().map(|(value, _)| value);
        let (again, once): (Vec<Value>, Vec<Value>) =
            values.partition(|value| changing[value.index()]);
        let symbols = words.symbols;
        let mut writer = Writer::of(program, words);
        let bound = writer.place_angles();
        let rest = &writer.symbols_read() - &bound;
        let (last, first): (BTreeSet<Symbol>, BTreeSet<Symbol>) =
            rest.into_iter().partition(changes);
        writer.statements.push(symbols.prelude(&first));
        once.into_iter().for_each(|value| writer.place(value));
        let once = std::mem::take(&mut writer.statements).into_tokens();
        writer.statements.push(symbols.prelude(&last));
        let slots = program.slots();
        for value in again {
            writer.place(value);
            writer.assign(value, &slots[value.index()], place);
        }
        Self {
            once,
            again: writer.statements.into_tokens(),
        }
    }
}

/// Which values depend on the symbols that change.
fn changing(program: &Program, changes: &dyn Fn(&Symbol) -> bool) -> Vec<bool> {
    let mut changing = vec![false; program.len()];
    for (value, operation) in program.operations() {
        changing[value.index()] = match operation {
            Operation::Symbol(symbol) => changes(symbol),
            _ => operation
                .operands()
                .iter()
                .any(|operand| changing[operand.index()]),
        };
    }
    changing
}
