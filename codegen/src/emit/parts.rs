//! Long functions in parts.
//!
//! In:  a program, and the signature of the function that runs it.
//! Out: functions that run a part of it each, and the calls of all of them, one after the
//!      other. What one part computes and later ones read is kept in an array, whose places
//!      are used again as soon as nobody reads them any more.
//!
//! What a compiler needs for a straight line grows faster than the line: vectorising, keeping
//! values in registers and scheduling look at all of a block, again and again.

use super::function::{Decided, Place, Symbols, Writer};
use super::name::Names;
use super::statements::Statements;
use super::subject::argument;
use crate::expr::Function;
use crate::model::Symbol;
use crate::optimise::{Operation, Program, Value};
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeSet;

/// The most operations of a function that is one straight line, unless another number is asked
/// for: those of a row of 80 parallelograms are, of 160 are not. Parts run longer, since they go
/// through memory: an acceleration of a row of 80 costs 1.8 times as many instructions in parts.
pub(super) const STRAIGHT_LINE: usize = 20_000;
/// The most statements of a part; where shorter lines are asked for, a quarter of their operations.
/// What looks at all of a block takes a compiler half as long for a row of 320 as with parts of
/// 2,000 statements, and as many instructions run.
const STATEMENTS: usize = 250;

/// A function that was taken apart.
pub(super) struct Parts {
    /// Its statements: the calls.
    pub calls: TokenStream,
    /// The functions that run a part each.
    pub functions: TokenStream,
}

/// Some statements: those for one value, or the call for the angles.
#[derive(Default)]
struct Step {
    statements: Statements,
    symbols: BTreeSet<Symbol>,
    reads: Vec<Ident>,
    defines: Vec<Ident>,
    /// Whether it looks at the state, and at the buffer.
    state: bool,
    out: bool,
    /// Whether it brings its symbols into scope by itself, in a part of its own.
    alone: bool,
}

impl Parts {
    /// Writes a program; `names` are the names that are taken. The function that is taken
    /// apart has a name, and takes a `state` and a buffer `out`.
    pub fn of(
        program: &Program,
        symbols: &dyn Symbols,
        names: Names,
        (place, decided): (Place, Decided),
        (name, [state_type, out_type]): (&Ident, &[TokenStream; 2]),
        straight_line: usize,
    ) -> Self {
        let statements = STATEMENTS.min(straight_line / 4);
        let parts = parts(steps(program, symbols, names, place, decided), statements);
        let kept = Kept::between(&parts);
        let count = Literal::usize_unsuffixed(kept.count);
        let mut functions = TokenStream::new();
        let mut calls = quote!(let mut kept = [T::zero(); #count];);
        for (number, part) in parts.into_iter().enumerate() {
            let name = Ident::new(&format!("{name}_part_{number}"), Span::call_site());
            let state = argument("state", part.iter().any(|step| step.state));
            let out = argument("out", part.iter().any(|step| step.out));
            let room = argument("kept", part.iter().any(|step| kept.serves(step)));
            let body = body(part, symbols, &kept);
            functions.extend(quote! {
                #[inline(never)]
                fn #name(
                    &self,
                    #state: &#state_type,
                    #out: &mut #out_type,
                    #room: &mut [T; #count],
                ) {
                    #body
                }
            });
            calls.extend(quote!(self.#name(state, out, &mut kept);));
        }
        Self { calls, functions }
    }
}

/// The steps of a program; the first is the call for the angles.
fn steps(
    program: &Program,
    symbols: &dyn Symbols,
    names: Names,
    place: Place,
    decided: Decided,
) -> Vec<Step> {
    let mut writer = Writer::of(program, symbols, names, decided);
    writer.place_angles(true);
    let pairs = writer.angles.values();
    let mut defined: FxHashSet<Ident> = pairs.flat_map(named).collect();
    let mut steps = Vec::new();
    if writer.statements.len() > 0 {
        let mut defines: Vec<Ident> = defined.iter().cloned().collect();
        defines.sort();
        steps.push(Step {
            statements: std::mem::take(&mut writer.statements),
            defines,
            state: true,
            alone: true,
            ..Step::default()
        });
    }
    let slots = program.slots();
    for (value, operation) in program.operations() {
        writer.place(value);
        writer.assign(value, &slots[value.index()], place);
        if writer.statements.len() > 0 {
            let statements = std::mem::take(&mut writer.statements);
            let mut step = writer.step(value, operation, statements);
            let (new, known) = step
                .defines
                .drain(..)
                .partition(|name| defined.insert(name.clone()));
            step.defines = new;
            step.reads.extend::<Vec<Ident>>(known);
            step.out |= !slots[value.index()].is_empty();
            steps.push(step);
        }
    }
    steps
}

/// The names of a sine and a cosine, as far as they have one.
fn named((sin, cos): &(Ident, Ident)) -> Vec<Ident> {
    let mut names = vec![sin.clone(), cos.clone()];
    names.retain(|name| name != "_");
    names
}

impl Writer<'_> {
    /// What the statements for a value read and define.
    fn step(&self, value: Value, operation: &Operation, statements: Statements) -> Step {
        let mut step = Step {
            defines: self.piece(value).name.iter().cloned().collect(),
            statements,
            ..Step::default()
        };
        if let Operation::Function(Function::Sin | Function::Cos, x) = operation
            && let Some(pair) = self.angles.get(x)
        {
            step.defines = named(pair);
        }
        step.looks_at(operation);
        let mut pending = operation.operands();
        while let Some(value) = pending.pop() {
            if let Some(name) = &self.piece(value).name {
                step.reads.push(name.clone());
            } else {
                let operation = self.program.operation(value);
                step.looks_at(operation);
                pending.extend(operation.operands());
            }
        }
        step
    }
}

impl Step {
    /// Marks what an operation looks at by itself.
    fn looks_at(&mut self, operation: &Operation) {
        match operation {
            Operation::Symbol(symbol) => {
                self.symbols.insert(*symbol);
                self.state |= matches!(
                    symbol,
                    Symbol::Time | Symbol::Coordinate(_) | Symbol::Velocity(_)
                );
                self.out |= matches!(symbol, Symbol::Weight(_));
            }
            Operation::Select(test, _) => self.out |= test.held.is_some(),
            Operation::Function(Function::Table(lookup), _) => self.out |= lookup.held.is_some(),
            _ => {}
        }
    }
}

/// Steps, so many to a part that it has no more statements than it may.
fn parts(steps: Vec<Step>, most: usize) -> Vec<Vec<Step>> {
    let mut parts: Vec<Vec<Step>> = Vec::new();
    let mut statements = 0;
    for step in steps {
        statements += step.statements.len();
        match parts.last_mut() {
            Some(part) if statements <= most && !part[0].alone => part.push(step),
            _ => {
                statements = step.statements.len();
                parts.push(vec![step]);
            }
        }
    }
    parts
}

/// The values that one part computes and later ones read. No part writes places that are next to
/// one another: compilers would try to compute what is stored there side by side, in vain.
struct Kept {
    places: FxHashMap<Ident, usize>,
    count: usize,
}

impl Kept {
    fn between(parts: &[Vec<Step>]) -> Self {
        let mut last: FxHashMap<&Ident, usize> = FxHashMap::default();
        for (part, steps) in parts.iter().enumerate() {
            let read = steps.iter().flat_map(|step| &step.reads);
            last.extend(read.map(|name| (name, part)));
        }
        let mut places = FxHashMap::default();
        // Of the even places, and of the odd ones, those that are free, and how many there are.
        let mut free = [Vec::new(), Vec::new()];
        let mut counts = [0, 0];
        let mut taken: Vec<(usize, usize)> = Vec::new();
        for (part, steps) in parts.iter().enumerate() {
            // A place that this part still reads is written by none of its statements.
            let given = taken.extract_if(.., |(last, _)| *last < part);
            given.for_each(|(_, place)| free[place % 2].push(place));
            for name in steps.iter().flat_map(|step| &step.defines) {
                let last = last.get(name).copied().unwrap_or(part);
                if last > part && !places.contains_key(name) {
                    let side = part % 2;
                    let place = free[side].pop().unwrap_or_else(|| {
                        counts[side] += 1;
                        2 * counts[side] - 2 + side
                    });
                    places.insert(name.clone(), place);
                    taken.push((last, place));
                }
            }
        }
        let count = 2 * counts[0].max(counts[1]);
        Self { places, count }
    }

    /// Whether a step reads or defines what is kept.
    fn serves(&self, step: &Step) -> bool {
        let mut names = step.reads.iter().chain(&step.defines);
        names.any(|name| self.places.contains_key(name))
    }

    fn place(&self, name: &Ident) -> Option<TokenStream> {
        let place = Literal::usize_unsuffixed(*self.places.get(name)?);
        Some(quote!(kept[#place]))
    }
}

/// The statements of a part. What it reads is fetched where it is read first.
fn body(part: Vec<Step>, symbols: &dyn Symbols, kept: &Kept) -> TokenStream {
    let read = part.iter().flat_map(|step| &step.symbols).copied();
    let mut tokens = symbols.prelude(&read.collect());
    let mut known: FxHashSet<Ident> = FxHashSet::default();
    for step in part {
        for name in step.reads {
            let place = kept.place(&name);
            if known.insert(name.clone()) {
                tokens.extend(place.map(|place| quote!(let #name = #place;)));
            }
        }
        tokens.extend(step.statements.into_tokens());
        for name in step.defines {
            let place = kept.place(&name);
            tokens.extend(place.map(|place| quote!(#place = #name;)));
            known.insert(name);
        }
    }
    tokens
}
