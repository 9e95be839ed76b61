//! A program as a list of steps, which can be told apart and compared.
//!
//! In:  a program.
//! Out: its [`Step`]s: the statements for one value each, what they read and define, and the
//!      form that they have in common with the statements for other values.

use super::function::{Words, Writer};
use super::name::Names;
use super::statements::Statements;
use crate::expr::{Function, Function2, Number, Test};
use crate::model::Symbol;
use crate::optimise::{Operation, Program, Slot, Value};
use proc_macro2::{Ident, TokenStream};
use rustc_hash::FxHashMap;
use std::mem::{Discriminant, discriminant};
use std::ops::Range;

/// What a step refers to, in the order in which it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reference {
    /// A value that has a name, by the number of its definition.
    Value(usize),
    /// An entry of an array.
    Entry(Symbol),
    /// A number, by the operation that reads it, and as which of its operands.
    Number(Value, usize),
    /// The entry that the step writes.
    Written(Slot),
}

/// The statements for a value.
pub(super) struct Step {
    pub statements: Statements,
    /// The entries that the value is written to, and the expression for it.
    pub writes: Vec<(Slot, TokenStream)>,
    /// Steps of one form differ in what they refer to, and in the names of what they define.
    pub form: usize,
    pub references: Vec<Reference>,
    /// Symbols that the step reads, those that are entries of arrays among them.
    pub symbols: Vec<Symbol>,
    /// The numbers of the definitions that the step makes.
    pub defines: Range<usize>,
    /// Whether the step looks at sides that are held in the buffer.
    pub sides: bool,
}

impl Step {
    /// The number of statements of the step.
    pub fn length(&self) -> usize {
        self.statements.len() + self.writes.len()
    }

    /// The numbers of the values that the step reads.
    pub fn reads(&self) -> impl Iterator<Item = usize> {
        self.references
            .iter()
            .filter_map(|reference| match reference {
                Reference::Value(number) => Some(*number),
                Reference::Entry(_) | Reference::Number(..) | Reference::Written(_) => None,
            })
    }
}

/// The call for the angles that are known from the start.
pub(super) struct Angles {
    /// What computes the array of them.
    pub statements: Statements,
    pub array: TokenStream,
    /// The numbers of the definitions of their sines and cosines, in their order.
    pub pairs: Vec<[Option<usize>; 2]>,
}

/// A program as a list of steps.
pub(super) struct Steps {
    pub angles: Option<Angles>,
    pub list: Vec<Step>,
    /// The names of all definitions, by their number.
    pub definitions: Vec<Ident>,
    /// The names that are taken.
    pub names: Names,
}

/// A piece of the form of a step.
#[derive(PartialEq, Eq, Hash)]
enum Mark {
    Named,
    Entry(Discriminant<Symbol>),
    Symbol(Symbol),
    Number(Number),
    AnyNumber,
    Pi,
    Input(u32),
    Sum(Vec<bool>),
    Term(bool),
    Product(usize),
    Quotient,
    Function(Function),
    Function2(Function2),
    Select(Test),
    /// For each of the names that could be defined, whether it is.
    Defines(Vec<bool>),
    Written(&'static str),
}

impl Steps {
    /// The steps of a program.
    pub fn of(program: &Program, words: Words) -> Self {
        Self::read_by(Reader::default(), program, words)
    }

    /// The same, where steps that differ in numbers are of one form, and refer to the numbers.
    pub fn alike_but_for_numbers(program: &Program, words: Words) -> Self {
        let reader = Reader {
            refers_to_numbers: true,
            ..Reader::default()
        };
        Self::read_by(reader, program, words)
    }

    fn read_by(mut reader: Reader, program: &Program, words: Words) -> Self {
        let mut writer = Writer::of(program, words);
        let angles = writer.angles_together(true).map(|together| {
            let pairs = together.pairs.into_iter();
            let pairs = pairs.map(|(sin, cos)| [sin, cos].map(|name| reader.define(name)));
            Angles {
                statements: std::mem::take(&mut writer.statements),
                array: together.array,
                pairs: pairs.collect(),
            }
        });
        let slots = program.slots();
        let mut list = Vec::new();
        for (value, _) in program.operations() {
            let slots = &slots[value.index()];
            for term in writer.long_sum(value).unwrap_or_default() {
                list.push(reader.term(&mut writer, value, term));
            }
            writer.place(value);
            let statements = std::mem::take(&mut writer.statements);
            if statements.len() > 0 || !slots.is_empty() {
                list.push(reader.step(&writer, value, statements, slots));
            }
        }
        Self {
            angles,
            list,
            definitions: reader.definitions,
            names: writer.names,
        }
    }
}

/// What has been read of a program.
#[derive(Default)]
struct Reader {
    definitions: Vec<Ident>,
    numbers: FxHashMap<Ident, usize>,
    forms: FxHashMap<Vec<Mark>, usize>,
    /// Whether numbers are referred to instead of being a part of the form.
    refers_to_numbers: bool,
}

impl Reader {
    /// The number of a definition; none if nobody reads it.
    fn define(&mut self, name: Ident) -> Option<usize> {
        if name == "_" {
            return None;
        }
        let number = self.definitions.len();
        self.numbers.insert(name.clone(), number);
        self.definitions.push(name);
        Some(number)
    }

    fn step(
        &mut self,
        writer: &Writer,
        value: Value,
        statements: Statements,
        slots: &[Slot],
    ) -> Step {
        let mut found = Found::default();
        let first = self.definitions.len();
        match self.number(writer, value) {
            // It was computed by an earlier step, and is written here.
            Some(number) => found.refer(Mark::Named, Reference::Value(number)),
            None => {
                self.look(writer, value, &mut found);
                let defined = writer.defined_with(value);
                let defined = defined.into_iter().map(|name| self.define(name).is_some());
                found.marks.push(Mark::Defines(defined.collect()));
            }
        }
        let tokens = &writer.piece(value).tokens;
        for slot in slots {
            found.refer(Mark::Written(slot.array), Reference::Written(*slot));
        }
        let writes = slots.iter().map(|slot| (*slot, tokens.clone()));
        self.made(found, first, statements, writes.collect())
    }

    /// The step that adds a term to those before it.
    fn term(&mut self, writer: &mut Writer, value: Value, (minus, term): (bool, Value)) -> Step {
        let mut found = Found::default();
        let first = self.definitions.len();
        found.marks.push(Mark::Term(minus));
        if let Some(before) = self.number(writer, value) {
            found.refer(Mark::Named, Reference::Value(before));
        }
        self.read(writer, term, &mut found);
        let name = writer.add_term(value, (minus, term));
        self.define(name);
        let statements = std::mem::take(&mut writer.statements);
        self.made(found, first, statements, Vec::new())
    }

    /// A step of which everything is known.
    fn made(
        &mut self,
        found: Found,
        first: usize,
        statements: Statements,
        writes: Vec<(Slot, TokenStream)>,
    ) -> Step {
        let forms = self.forms.len();
        Step {
            statements,
            writes,
            form: *self.forms.entry(found.marks).or_insert(forms),
            references: found.references,
            symbols: found.symbols,
            defines: first..self.definitions.len(),
            sides: found.sides,
        }
    }

    /// The number of a value that has a name already.
    fn number(&self, writer: &Writer, value: Value) -> Option<usize> {
        let name = writer.piece(value).name.as_ref()?;
        self.numbers.get(name).copied()
    }

    /// Looks at an operation, and at the operations that are written into its expression.
    fn look(&self, writer: &Writer, value: Value, found: &mut Found) {
        let operation = writer.program.operation(value);
        found.mark(operation);
        for (place, operand) in operation.operands().into_iter().enumerate() {
            match writer.program.operation(operand) {
                Operation::Number(_) if self.refers_to_numbers => {
                    found.refer(Mark::AnyNumber, Reference::Number(value, place));
                }
                _ => self.read(writer, operand, found),
            }
        }
    }

    /// Refers to a value that has a name, and looks at what is written where it is read.
    fn read(&self, writer: &Writer, value: Value, found: &mut Found) {
        match self.number(writer, value) {
            Some(number) => found.refer(Mark::Named, Reference::Value(number)),
            None => self.look(writer, value, found),
        }
    }
}

impl Writer<'_> {
    /// The names that the statements for a value define.
    fn defined_with(&self, value: Value) -> Vec<Ident> {
        match self.program.operation(value) {
            Operation::Function(Function::Sin | Function::Cos, x) => {
                let pair = self.angles.get(x).cloned();
                pair.map_or(Vec::new(), |(sin, cos)| vec![sin, cos])
            }
            _ => self.piece(value).name.iter().cloned().collect(),
        }
    }
}

/// What a step is made of.
#[derive(Default)]
struct Found {
    marks: Vec<Mark>,
    references: Vec<Reference>,
    symbols: Vec<Symbol>,
    sides: bool,
}

impl Found {
    fn refer(&mut self, mark: Mark, reference: Reference) {
        self.marks.push(mark);
        self.references.push(reference);
    }

    fn mark(&mut self, operation: &Operation) {
        let mark = match operation {
            Operation::Symbol(symbol) => {
                self.symbols.push(*symbol);
                if symbol.entry().is_some() {
                    let mark = Mark::Entry(discriminant(symbol));
                    return self.refer(mark, Reference::Entry(*symbol));
                }
                Mark::Symbol(*symbol)
            }
            Operation::Number(number) => Mark::Number(*number),
            Operation::Pi => Mark::Pi,
            Operation::Input(index, _) => Mark::Input(*index),
            Operation::Sum(terms) => Mark::Sum(terms.iter().map(|(minus, _)| *minus).collect()),
            Operation::Product(factors) => Mark::Product(factors.len()),
            Operation::Quotient(..) => Mark::Quotient,
            Operation::Function(function, _) => {
                self.sides |= matches!(function, Function::Table(lookup) if lookup.held.is_some());
                Mark::Function(*function)
            }
            Operation::Function2(function, ..) => Mark::Function2(*function),
            Operation::Select(test, _) => {
                self.sides |= test.held.is_some();
                Mark::Select(*test)
            }
        };
        self.marks.push(mark);
    }
}
