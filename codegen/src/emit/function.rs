//! A program to the body of a function.
//!
//! In:  a [`Program`] and names for its symbols.
//! Out: named values, assignments of those outputs that have a place, directly after
//!      what they need, and an expression for each of the others. A value that is read
//!      once is written where it is read, as long as the line stays short; the
//!      others get a name. Nothing is computed here.

use super::index::{Index, Target};
use super::literal;
use super::name::{Names, ident, table_name};
use super::statements::Statements;
use crate::expr::{Comparison, Entry, Function, Function2, Lookup, Side, Test};
use crate::model::Symbol;
use crate::optimise::{Operation, Program, Slot, Value};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// The most operands of an expression that is written where it is read.
pub(super) const OPERANDS_MAX: usize = 9;

/// The most terms or factors that are written in one expression; the rest has a name of its
/// own. Compilers go into nested expressions by recursion, and would run out of stack.
pub(super) const NESTED_MAX: usize = 32;

/// How tightly an emitted piece holds together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Binding {
    Sum,
    Product,
    Atom,
}

#[derive(Clone)]
pub(super) struct Piece {
    pub(super) tokens: TokenStream,
    pub(super) binding: Binding,
    pub(super) operands: usize,
    /// A product in two parts: each stands anywhere, the second only inside brackets.
    pub(super) factors: Option<(TokenStream, TokenStream)>,
    /// The local variable that holds it.
    pub(super) name: Option<Ident>,
}

impl Piece {
    pub(super) fn new(tokens: TokenStream, binding: Binding, operands: usize) -> Self {
        Self {
            tokens,
            binding,
            operands,
            factors: None,
            name: None,
        }
    }
}

/// What decides the conditions of a function.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Decided {
    /// The state.
    ByState,
    /// The sides in the buffer `out`, where they are held.
    BySides,
}

/// Where an output is assigned; `None` if whoever asks for the body does that.
pub(super) type Place<'a> = &'a dyn Fn(&Target) -> Option<TokenStream>;

/// The names of the symbols of a mechanism inside function bodies.
pub(super) trait Symbols {
    /// Statements that bring symbols into scope.
    fn prelude(&self, used: &BTreeSet<Symbol>) -> TokenStream;
    /// The array of all coordinates, if their number is `count`.
    fn all_coordinates(&self, count: usize) -> Option<TokenStream>;
    /// The entry of an array that a symbol is, at an index that may change from turn to turn;
    /// nothing if it is no such entry.
    fn entry(&self, symbol: Symbol, index: Index) -> Option<TokenStream>;
    /// The local variable that holds a symbol.
    fn local(&self, symbol: Symbol) -> Ident;
    /// The expression for an input that has a law.
    fn input(&self, index: u32, law: TokenStream) -> TokenStream;
}

/// In which words a function is written.
#[derive(Clone)]
pub(super) struct Words<'a> {
    pub symbols: &'a dyn Symbols,
    /// The names that are taken.
    pub names: Names,
    pub decided: Decided,
}

/// The body of a function.
pub(super) struct Body {
    /// The statements.
    pub statements: TokenStream,
    outputs: FxHashMap<Slot, TokenStream>,
}

impl Body {
    /// The expression for an output; zero where the program leaves it out.
    pub fn output(&self, slot: Slot) -> TokenStream {
        let written = self.outputs.get(&slot).cloned();
        written.unwrap_or_else(|| quote!(T::zero()))
    }

    /// A body of statements after which outputs have these expressions.
    pub fn new(statements: TokenStream, outputs: FxHashMap<Slot, TokenStream>) -> Self {
        Self {
            statements,
            outputs,
        }
    }

    /// Writes a program.
    pub fn of(program: &Program, words: Words, place: Place) -> Self {
        let mut writer = Writer::of(program, words);
        let bound = writer.place_angles();
        // Bound after the call for the angles, symbols need not be kept during it.
        let rest = &writer.symbols_read() - &bound;
        writer.statements.push(writer.symbols.prelude(&rest));
        let slots = program.slots();
        let mut outputs = FxHashMap::default();
        for (value, _) in program.operations() {
            writer.place(value);
            writer.assign(value, &slots[value.index()], place);
            for slot in &slots[value.index()] {
                outputs.insert(*slot, writer.piece(value).tokens.clone());
            }
        }
        Self::new(writer.statements.into_tokens(), outputs)
    }
}

pub(super) struct Writer<'a> {
    pub(super) program: &'a Program,
    pub(super) symbols: &'a dyn Symbols,
    decided: Decided,
    pub(super) names: Names,
    pub(super) uses: Vec<usize>,
    pub(super) pieces: Vec<Option<Piece>>,
    nothing: Piece,
    /// The names of the sines and cosines of angles, as far as these are computed already.
    pub(super) angles: FxHashMap<Value, (Ident, Ident)>,
    pub(super) statements: Statements,
}

impl<'a> Writer<'a> {
    pub(super) fn of(program: &'a Program, words: Words<'a>) -> Self {
        let Words {
            symbols,
            names,
            decided,
        } = words;
        Writer {
            program,
            symbols,
            decided,
            names,
            uses: program.uses(),
            pieces: vec![None; program.len()],
            nothing: atom(quote!(T::zero())),
            angles: FxHashMap::default(),
            statements: Statements::default(),
        }
    }

    /// Writes a value whose operands are written, unless it is written already.
    pub(super) fn place(&mut self, value: Value) {
        if self.pieces[value.index()].is_none() {
            let piece = self.written(value);
            self.pieces[value.index()] = Some(piece);
        }
    }

    /// Assigns a value to those outputs that have a place.
    pub(super) fn assign(&mut self, value: Value, outputs: &[Slot], place: Place) {
        for place in outputs.iter().filter_map(|slot| place(&slot.into())) {
            let tokens = &self.piece(value).tokens;
            let statement = quote!(#place = #tokens;);
            self.statements.push(statement);
        }
    }

    pub(super) fn piece(&self, value: Value) -> &Piece {
        // Operands come before their users, so the piece is there.
        self.pieces[value.index()].as_ref().unwrap_or(&self.nothing)
    }

    /// The symbols that the program reads.
    pub(super) fn symbols_read(&self) -> BTreeSet<Symbol> {
        let symbol = |(_, operation): (Value, &Operation)| match operation {
            Operation::Symbol(symbol) => Some(*symbol),
            _ => None,
        };
        self.program.operations().filter_map(symbol).collect()
    }

    fn written(&mut self, value: Value) -> Piece {
        let program = self.program;
        let operation = program.operation(value);
        let piece = match operation {
            Operation::Number(number) => return atom(literal::number(*number)),
            Operation::Pi => return atom(quote!(T::pi())),
            Operation::Symbol(symbol) => {
                let name = self.symbols.local(*symbol);
                return atom(quote!(#name));
            }
            Operation::Function(function @ (Function::Sin | Function::Cos), x) => {
                let (sin, cos) = self.sine_and_cosine(*x);
                let name = if *function == Function::Sin { sin } else { cos };
                return variable(name);
            }
            Operation::Input(index, law) => {
                let law = self.piece(*law).tokens.clone();
                atom(self.symbols.input(*index, law))
            }
            Operation::Sum(terms) => self.sum(terms),
            Operation::Product(factors) => self.product(factors),
            Operation::Quotient(x, y) => self.quotient(*x, *y),
            Operation::Function(function, x) => self.call(*function, *x),
            Operation::Function2(function, x, y) => self.call2(*function, *x, *y),
            Operation::Select(test, parts) => self.select(*test, parts),
        };
        let short = piece.operands <= OPERANDS_MAX;
        let input = matches!(operation, Operation::Input(..));
        if self.uses[value.index()] == 1 && short && !input {
            return piece;
        }
        self.named(&self.wish(operation), piece.tokens)
    }

    /// Gives an expression a name close to a wish.
    pub(super) fn named(&mut self, wish: &str, tokens: TokenStream) -> Piece {
        let name = self.names.unique(wish);
        self.statements.name(name.clone(), tokens);
        variable(name)
    }

    /// The name that a value would like: its factors if they are few and plain.
    fn wish(&self, operation: &Operation) -> String {
        let plain = |value: &Value| match self.program.operation(*value) {
            Operation::Symbol(symbol) => Some(self.symbols.local(*symbol).to_string()),
            Operation::Function(Function::Sin, x) => Some(self.angles.get(x)?.0.to_string()),
            Operation::Function(Function::Cos, x) => Some(self.angles.get(x)?.1.to_string()),
            _ => None,
        };
        match operation {
            Operation::Input(index, _) => self.symbols.local(Symbol::Input(*index)).to_string(),
            Operation::Product(factors) if factors.len() <= 3 => {
                let names: Option<Vec<String>> = factors.iter().map(plain).collect();
                names.map_or("product".into(), |names| names.join("_"))
            }
            Operation::Product(_) => "product".into(),
            Operation::Sum(_) => "sum".into(),
            Operation::Quotient(..) => "quotient".into(),
            Operation::Select(..) => "choice".into(),
            _ => "value".into(),
        }
    }

    pub(super) fn bound(&self, value: Value, context: Binding) -> TokenStream {
        let Piece {
            tokens, binding, ..
        } = self.piece(value);
        if *binding >= context {
            tokens.clone()
        } else {
            quote!((#tokens))
        }
    }

    fn operands(&self, values: impl IntoIterator<Item = Value>) -> usize {
        values
            .into_iter()
            .map(|value| self.piece(value).operands)
            .sum()
    }

    /// Numbers stand in front, as people write them.
    fn product(&mut self, factors: &[Value]) -> Piece {
        let is_number = |x: &Value| matches!(self.program.operation(*x), Operation::Number(_));
        let (mut ordered, others): (Vec<Value>, Vec<Value>) =
            factors.iter().copied().partition(is_number);
        ordered.extend(others);
        let mut pieces: Vec<TokenStream> = ordered
            .iter()
            .map(|value| self.bound(*value, Binding::Atom))
            .collect();
        let last = pieces.pop().unwrap_or_default();
        while pieces.len() > NESTED_MAX {
            let first = pieces.drain(..NESTED_MAX);
            let part = first.reduce(|part, factor| quote!(#part * #factor));
            let part = self.named("product", part.unwrap_or_default());
            pieces.insert(0, part.tokens);
        }
        let bare = ordered
            .last()
            .map(|value| self.piece(*value).tokens.clone());
        let in_front = match &pieces[..] {
            [only] => only.clone(),
            [first, rest @ ..] => quote!((#first #(* #rest)*)),
            [] => TokenStream::new(),
        };
        let operands = self.operands(factors.iter().copied());
        Piece {
            factors: bare.map(|bare| (in_front, bare)),
            ..Piece::new(quote!(#(#pieces *)* #last), Binding::Product, operands)
        }
    }

    fn quotient(&self, x: Value, y: Value) -> Piece {
        let (above, below) = (
            self.bound(x, Binding::Product),
            self.bound(y, Binding::Atom),
        );
        let operands = self.operands([x, y]);
        Piece::new(quote!(#above / #below), Binding::Product, operands)
    }

    fn call(&self, function: Function, x: Value) -> Piece {
        if let Function::Table(lookup) = function {
            return self.lookup(lookup, x);
        }
        let argument = self.bound(x, Binding::Atom);
        let name = ident(function.name());
        let tokens = quote!(#argument.#name());
        Piece::new(tokens, Binding::Atom, self.operands([x]))
    }

    fn lookup(&self, lookup: Lookup, x: Value) -> Piece {
        let (table, argument) = (table_name(lookup.table.index), &self.piece(x).tokens);
        let held = lookup.held.filter(|_| self.decided == Decided::BySides);
        let number = Literal::u32_unsuffixed;
        let tokens = match (lookup.entry, held.map(number)) {
            (Entry::Derivative(order), Some(first)) => {
                let order = Literal::u8_unsuffixed(order);
                quote!(#table.held(#order, #argument, out.sides, #first))
            }
            (Entry::Derivative(order), None) => {
                let order = Literal::u8_unsuffixed(order);
                quote!(#table.value(#order, #argument))
            }
            (Entry::Side(bit), _) => {
                let bit = number(bit);
                quote!(#table.side(#bit, #argument))
            }
            (Entry::Turn(bit), _) => {
                let bit = number(bit);
                quote!(#table.turn(#bit, #argument))
            }
            (Entry::Knot, _) => quote!(#table.knot(#argument)),
            (Entry::Passing, _) => quote!(#table.passing(#argument)),
        };
        Piece::new(tokens, Binding::Atom, self.operands([x]))
    }

    fn call2(&self, function: Function2, x: Value, y: Value) -> Piece {
        let first = &self.piece(x).tokens;
        let second = &self.piece(y).tokens;
        let name = match function {
            Function2::Pow => "powf",
            _ => function.name(),
        };
        let name = ident(name);
        // Two traits give numbers a `min` and a `max`; name the one that is meant.
        let tokens = quote!(Real::#name(#first, #second));
        Piece::new(tokens, Binding::Atom, self.operands([x, y]))
    }

    fn select(&self, test: Test, parts: &[Value; 4]) -> Piece {
        let [a, b] = [0, 1].map(|i| self.bound(parts[i], Binding::Sum));
        let [then, otherwise] = [2, 3].map(|i| &self.piece(parts[i]).tokens);
        let sign: TokenStream = match test.comparison {
            Comparison::Less => quote!(<),
            Comparison::LessEqual => quote!(<=),
            Comparison::Equal => quote!(==),
            Comparison::NotEqual => quote!(!=),
        };
        let held = test.held.filter(|_| self.decided == Decided::BySides);
        let condition = match held {
            None => quote!(#a #sign #b),
            Some(side) => {
                let (Side::Above(index) | Side::Below(index)) = side;
                let name = match side {
                    Side::Above(_) => "above",
                    Side::Below(_) => "below",
                };
                let (name, index) = (ident(name), Literal::u32_unsuffixed(index));
                quote!(out.sides.#name(#index, #a #sign #b))
            }
        };
        let tokens = quote!(if #condition { #then } else { #otherwise });
        // Named, since an `if` cannot stand at the start of a longer expression.
        Piece::new(tokens, Binding::Atom, OPERANDS_MAX + 1)
    }
}

fn atom(tokens: TokenStream) -> Piece {
    Piece::new(tokens, Binding::Atom, 1)
}

/// A local variable.
fn variable(name: Ident) -> Piece {
    Piece {
        name: Some(name.clone()),
        ..atom(quote!(#name))
    }
}

/// A name in a pattern; `_` is not an identifier to the parser.
pub(super) fn pattern(name: &Ident) -> TokenStream {
    if name == "_" {
        quote!(_)
    } else {
        quote!(#name)
    }
}
