//! Numbers that differ from one turn of a loop to the next.
//!
//! In:  a program in which forms come again but for their numbers.
//! Out: the program with entries of a table instead of these, and the symbols with that table.
//!
//! The weights of the bodies behind each joint of a chain, for example, are numbers of which no
//! two are equal.

use super::function::{Symbols, Words};
use super::index::Index;
use super::literal::{number, parts};
use super::name::{Names, ident};
use super::step::{Reference, Step, Steps};
use super::turns::{Block, Found, Loop};
use crate::expr::Number;
use crate::model::Symbol;
use crate::optimise::{Operation, Program, Value};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// A program that reads some of its numbers from a table.
pub(super) struct Tabulated {
    pub program: Program,
    /// The table.
    pub numbers: Vec<Number>,
}

/// Where a number is read: by which operation, as which of its operands.
type Use = (Value, usize);

impl Tabulated {
    /// The program with a table of the numbers that differ between turns of loops; `None` where
    /// none do.
    pub fn of(program: &Program, words: Words) -> Option<Self> {
        let steps = Steps::alike_but_for_numbers(program, words);
        let mut table = Table::default();
        for block in Found::of(&steps).blocks {
            if let Block::Loop(repeated) = block {
                table.take(program, &steps, &repeated);
            }
        }
        (!table.numbers.is_empty()).then(|| Self {
            program: table.written_into(program),
            numbers: table.numbers,
        })
    }
}

/// A table that is being filled.
#[derive(Default)]
struct Table {
    numbers: Vec<Number>,
    places: FxHashMap<Use, usize>,
}

impl Table {
    /// Takes the numbers that differ between the turns of a loop, those of one place one after the
    /// other.
    fn take(&mut self, program: &Program, steps: &Steps, repeated: &Loop) {
        let length = repeated.first.len();
        let uses = |turn: usize| {
            let first = repeated.first.start + turn * length;
            uses(&steps.list[first..first + length])
        };
        let turns: Vec<Vec<Use>> = (0..repeated.turns).map(uses).collect();
        for place in 0..turns[0].len() {
            let of_turns = turns.iter().map(|uses| uses[place]);
            let read: Vec<(Use, Number)> = of_turns
                .filter_map(|used| Some((used, read(program, used)?)))
                .collect();
            let differ = read.iter().any(|(_, value)| *value != read[0].1);
            for (used, value) in read.into_iter().filter(|_| differ) {
                self.places.insert(used, self.numbers.len());
                self.numbers.push(value);
            }
        }
    }

    /// The program with entries of the table instead of the numbers that were taken.
    fn written_into(&self, program: &Program) -> Program {
        let mut written = Program::default();
        let mut values: Vec<Value> = Vec::with_capacity(program.len());
        for (value, operation) in program.operations() {
            let mut operand = 0;
            let operation = operation.with_operands(&mut |read| {
                let place = self.places.get(&(value, operand));
                operand += 1;
                match place.and_then(|place| u32::try_from(*place).ok()) {
                    Some(place) => written.push(Operation::Symbol(Symbol::Tabulated(place))),
                    None => values[read.index()],
                }
            });
            values.push(written.push(operation));
        }
        let outputs = program.outputs.iter();
        written.outputs = outputs
            .map(|(slot, value)| (*slot, values[value.index()]))
            .collect();
        written
    }
}

/// Where some steps read numbers.
fn uses(steps: &[Step]) -> Vec<Use> {
    let references = steps.iter().flat_map(|step| &step.references);
    references
        .filter_map(|reference| match reference {
            Reference::Number(value, operand) => Some((*value, *operand)),
            Reference::Value(_) | Reference::Entry(_) | Reference::Written(_) => None,
        })
        .collect()
}

/// The number that an operation reads.
fn read(program: &Program, (value, operand): Use) -> Option<Number> {
    let operands = program.operation(value).operands();
    match program.operation(*operands.get(operand)?) {
        Operation::Number(number) => Some(*number),
        _ => None,
    }
}

/// Symbols, entries of a table among them.
pub(super) struct WithTable<'a> {
    symbols: &'a dyn Symbols,
    numbers: Vec<Number>,
    /// The local variables of the entries.
    locals: Vec<Ident>,
}

impl<'a> WithTable<'a> {
    /// Symbols with a table, whose entries get names.
    pub fn of(symbols: &'a dyn Symbols, numbers: Vec<Number>, names: &mut Names) -> Self {
        let locals = numbers.iter().map(|_| names.unique("number")).collect();
        Self {
            symbols,
            numbers,
            locals,
        }
    }

    /// The table, nothing where it is empty.
    pub fn table(&self) -> TokenStream {
        if self.numbers.is_empty() {
            return TokenStream::new();
        }
        let (name, count) = (table(), Literal::usize_unsuffixed(self.numbers.len()));
        let rows = self.numbers.iter().map(|value| {
            let (high, low) = parts(*value);
            quote!([#high, #low])
        });
        quote!(static #name: [[f64; 2]; #count] = [#(#rows),*];)
    }
}

/// The static that holds a table of numbers.
fn table() -> Ident {
    ident("NUMBERS")
}

impl Symbols for WithTable<'_> {
    fn prelude(&self, used: &BTreeSet<Symbol>) -> TokenStream {
        let mut statements = self.symbols.prelude(used);
        for symbol in used {
            if let Symbol::Tabulated(place) = symbol {
                let (local, value) = (self.local(*symbol), self.numbers[*place as usize]);
                let value = number(value);
                statements.extend(quote!(let #local = #value;));
            }
        }
        statements
    }

    fn all_coordinates(&self, count: usize) -> Option<TokenStream> {
        self.symbols.all_coordinates(count)
    }

    fn entry(&self, symbol: Symbol, index: Index) -> Option<TokenStream> {
        match symbol {
            Symbol::Tabulated(_) => {
                let table = table();
                Some(quote!(T::constant(#table[#index][0], #table[#index][1])))
            }
            _ => self.symbols.entry(symbol, index),
        }
    }

    fn local(&self, symbol: Symbol) -> Ident {
        match symbol {
            Symbol::Tabulated(place) => self.locals[place as usize].clone(),
            _ => self.symbols.local(symbol),
        }
    }

    fn input(&self, index: u32, law: TokenStream) -> TokenStream {
        self.symbols.input(index, law)
    }
}
