//! Long functions with loops.
//!
//! In:  a program, and the loops that are in it.
//! Out: statements, with loops among them. What one turn computes and another turn, or a step
//! outside of the loop, reads is an entry of an array over the turns.
//!
//! Compilers take no time for a short loop, and processors run it faster than a straight line that
//! does not fit into their first cache.

use super::column::Columns;
use super::function::{Place, Symbols, Words};
use super::index::{Index, Target, turn};
use super::numbers::{Tabulated, WithTable};
use super::statements::Statements;
use super::step::{Angles, Reference, Step, Steps};
use super::turns::{Block, Found, Loop, Stride, distance};
use crate::expr::Number;
use crate::model::Symbol;
use crate::optimise::{Program, Slot};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use rustc_hash::FxHashSet;
use std::collections::BTreeSet;

/// Loops pay where at most so many of four steps are left, and a table of numbers where at most so
/// many of those are left that are left without it.
const OF_FOUR: usize = 3;
/// The fewest places that a value is written to in a loop.
const WRITES_MIN: usize = 8;
/// The most steps that may be left: compilers take too long for more.
const LEFT_MAX: usize = 10_000;

/// A table is tried where more steps are left: finding out takes as long as finding the loops.
const LEFT_MANY: usize = 500;

/// A program with loops.
pub(super) struct Loops<'a> {
    symbols: WithTable<'a>,
    steps: Steps,
    found: Found,
}

impl<'a> Loops<'a> {
    /// A program with its loops, if they make it much shorter.
    pub fn of(program: &Program, words: Words<'a>) -> Option<Self> {
        let plain = Self::with(program, words.clone(), Vec::new());
        let left = plain.found.left();
        let tabulated = match left > LEFT_MANY {
            true => Tabulated::of(program, words.clone()),
            false => None,
        };
        let tabulated =
            tabulated.map(|Tabulated { program, numbers }| Self::with(&program, words, numbers));
        let shorter = |other: &Self| 4 * other.found.left() <= OF_FOUR * left;
        let best = tabulated.filter(shorter).unwrap_or(plain);
        let (left, all) = (best.found.left(), best.steps.list.len());
        (4 * left <= OF_FOUR * all && left <= LEFT_MAX).then_some(best)
    }

    fn with(program: &Program, mut words: Words<'a>, numbers: Vec<Number>) -> Self {
        let symbols = WithTable::of(words.symbols, numbers, &mut words.names);
        let words = Words {
            symbols: &symbols,
            ..words
        };
        let steps = Steps::of(program, words);
        let found = Found::of(&steps);
        Self {
            symbols,
            steps,
            found,
        }
    }

    /// The statements of the function.
    pub fn statements(self, place: Place) -> TokenStream {
        let Self {
            symbols,
            mut steps,
            mut found,
        } = self;
        let blocks = std::mem::take(&mut found.blocks);
        let mut names = std::mem::take(&mut steps.names);
        let columns = Columns::of(&blocks, &steps, found, &mut names);
        let mut writer = Writer {
            symbols: &symbols,
            place,
            columns,
            definitions: &steps.definitions,
            statements: Statements::default(),
            known: FxHashSet::default(),
        };
        writer.statements.push(symbols.table());
        if let Some(angles) = steps.angles {
            writer.angles(angles);
        }
        writer.arrays();
        let fixed = fixed(&blocks, &steps.list);
        writer.statements.push(symbols.prelude(&fixed));
        let mut list = steps.list.into_iter();
        for block in blocks {
            match block {
                Block::Straight(range) => list
                    .by_ref()
                    .take(range.len())
                    .for_each(|step| writer.straight(step)),
                Block::Loop(repeated) => {
                    let mut turns = list.by_ref().take(repeated.all().len());
                    let first = turns.by_ref().take(repeated.first.len()).collect();
                    turns.for_each(drop);
                    writer.repeated(first, &repeated);
                }
            }
        }
        writer.statements.into_tokens()
    }
}

/// The symbols that are the same in all turns of all loops.
fn fixed(blocks: &[Block], steps: &[Step]) -> BTreeSet<Symbol> {
    let mut fixed = BTreeSet::new();
    for block in blocks {
        match block {
            Block::Straight(range) => {
                let steps = steps[range.clone()].iter();
                fixed.extend(steps.flat_map(|step| &step.symbols));
            }
            Block::Loop(repeated) => {
                let steps = &steps[repeated.first.clone()];
                let mut symbols: BTreeSet<Symbol> =
                    steps.iter().flat_map(|step| step.symbols.clone()).collect();
                let references = steps.iter().flat_map(|step| &step.references);
                for (reference, [row, _]) in references.zip(&repeated.strides) {
                    if let Reference::Entry(symbol) = reference
                        && *row != 0
                    {
                        symbols.remove(symbol);
                    }
                }
                fixed.extend(symbols);
            }
        }
    }
    fixed
}

/// A function that is being written.
struct Writer<'a> {
    symbols: &'a dyn Symbols,
    place: Place<'a>,
    columns: Columns,
    definitions: &'a [Ident],
    statements: Statements,
    /// The values that are in scope outside of all loops.
    known: FxHashSet<usize>,
}

impl Writer<'_> {
    /// Writes the call for the angles, whose results are two arrays.
    fn angles(&mut self, angles: Angles) {
        let Angles {
            statements, array, ..
        } = angles;
        self.statements.append(statements);
        let arrays = self.columns.of_angles();
        let [sines, cosines] = arrays.map(|name| name.map_or(quote!(_), |name| quote!(#name)));
        self.statements
            .push(quote!(let (#sines, #cosines) = T::sin_cos_all(&#array);));
    }

    /// Declares the other arrays.
    fn arrays(&mut self) {
        for (array, turns) in self.columns.arrays() {
            let turns = Literal::usize_unsuffixed(turns);
            self.statements
                .push(quote!(let mut #array = [T::zero(); #turns];));
        }
    }

    /// Writes a step outside of all loops.
    fn straight(&mut self, step: Step) {
        step.reads().for_each(|number| self.know(number));
        self.known.extend(step.defines.clone());
        let writes = self.writes_outside(&step);
        self.statements.append(step.statements);
        self.statements.push(writes);
        for number in step.defines {
            let left = self.columns.array_outside(number);
            let left = left.map(|(array, turn)| (array.clone(), Index::fixed(turn)));
            self.leave(number, left);
        }
    }

    /// Brings a value into scope outside of all loops.
    fn know(&mut self, number: usize) {
        if self.known.insert(number) {
            let value = self.entry(number, 0);
            let name = self.definitions[number].clone();
            value
                .into_iter()
                .for_each(|value| self.statements.name(name.clone(), value));
        }
    }

    /// The entry of its array that holds a value, `step` entries farther in each turn.
    fn entry(&self, number: usize, step: isize) -> Option<TokenStream> {
        let (array, first) = self.columns.array(number)?;
        let index = Index { first, step };
        Some(quote!(#array[#index]))
    }

    /// Stores a value in its array, if it has a place there.
    fn leave(&mut self, number: usize, place: Option<(Ident, Index)>) {
        let name = &self.definitions[number];
        if let Some((array, index)) = place {
            self.statements.push(quote!(#array[#index] = #name;));
        }
    }

    /// The assignments of a step outside of all loops: a value that goes to many places at even
    /// distances is assigned in a loop.
    fn writes_outside(&self, step: &Step) -> TokenStream {
        let mut rest = &step.writes[..];
        let mut written = TokenStream::new();
        while let Some((first, value)) = rest.first() {
            let (count, stride) = even_slots(rest);
            let in_loop = count >= WRITES_MIN;
            let (count, stride) = if in_loop {
                (count, stride)
            } else {
                (1, [0, 0])
            };
            rest = &rest[count..];
            let Some(place) = (self.place)(&target(first, stride)) else {
                continue;
            };
            let (turn, turns) = (turn(), Literal::usize_unsuffixed(count));
            written.extend(match in_loop {
                true => quote!(for #turn in 0..#turns { #place = #value; }),
                false => quote!(#place = #value;),
            });
        }
        written
    }

    /// What a step writes.
    fn writes(
        &self,
        step: &Step,
        references: impl Iterator<Item = (Reference, Stride)>,
    ) -> TokenStream {
        let written = references.filter_map(|(reference, stride)| match reference {
            Reference::Written(slot) => Some(target(&slot, stride)),
            Reference::Value(_) | Reference::Entry(_) | Reference::Number(..) => None,
        });
        let writes = written.zip(&step.writes);
        let assigned = writes.filter_map(|(target, (_, value))| {
            let place = (self.place)(&target)?;
            Some(quote!(#place = #value;))
        });
        assigned.collect()
    }

    /// Writes a loop, from the steps of its first iteration. What is the same in all iterations is
    /// brought into scope before.
    fn repeated(&mut self, steps: Vec<Step>, repeated: &Loop) {
        let references = steps.iter().flat_map(|step| step.references.clone());
        let references: Vec<(Reference, Stride)> =
            references.zip(repeated.strides.iter().copied()).collect();
        let mut here: FxHashSet<usize> =
            steps.iter().flat_map(|step| step.defines.clone()).collect();
        for (reference, [row, _]) in &references {
            if let Reference::Value(number) = reference
                && *row == 0
                && here.insert(*number)
            {
                self.know(*number);
            }
        }
        let outside = std::mem::take(&mut self.statements);
        self.turn(steps, &references, (here, repeated.step));
        let inside = std::mem::replace(&mut self.statements, outside).into_tokens();
        let (turn, turns) = (turn(), Literal::usize_unsuffixed(repeated.turns));
        self.statements
            .push(quote!(for #turn in 0..#turns { #inside }));
    }

    /// Writes the statements of an iteration. The values `here` are in scope; `far` is the distance
    /// in an array from one iteration to the next.
    fn turn(
        &mut self,
        steps: Vec<Step>,
        references: &[(Reference, Stride)],
        (mut here, far): (FxHashSet<usize>, isize),
    ) {
        let mut references = references.iter().copied();
        let mut bound = BTreeSet::new();
        for step in steps {
            let count = step.references.len();
            let own: Vec<(Reference, Stride)> = references.by_ref().take(count).collect();
            for (reference, [row, _]) in &own {
                match reference {
                    Reference::Value(number) if here.insert(*number) => {
                        let name = self.definitions[*number].clone();
                        let value = self.entry(*number, *row).unwrap_or_default();
                        self.statements.name(name, value);
                    }
                    Reference::Entry(symbol) if *row != 0 && bound.insert(*symbol) => {
                        let first = symbol.entry().unwrap_or_default();
                        let value = self.symbols.entry(*symbol, Index { first, step: *row });
                        let name = self.symbols.local(*symbol);
                        self.statements.name(name, value.unwrap_or_default());
                    }
                    _ => {}
                }
            }
            let writes = self.writes(&step, own.into_iter());
            self.statements.append(step.statements);
            self.statements.push(writes);
            for number in step.defines {
                let left = self.columns.array(number);
                let index = |first| Index { first, step: far };
                let left = left.map(|(array, turn)| (array.clone(), index(turn)));
                self.leave(number, left);
            }
        }
    }
}

/// How many of the first places are at even distances, and that distance.
fn even_slots(writes: &[(Slot, TokenStream)]) -> (usize, Stride) {
    let stride = |from: &Slot, to: &Slot| {
        let place = |slot: &Slot| [slot.row, slot.column];
        (from.array == to.array).then(|| distance(place(from), place(to)))
    };
    let strides = writes.windows(2).map(|pair| stride(&pair[0].0, &pair[1].0));
    let mut strides = strides.peekable();
    match strides.peek().copied().flatten() {
        None => (1, [0, 0]),
        Some(first) => {
            let even = strides.take_while(|stride| *stride == Some(first));
            (1 + even.count(), first)
        }
    }
}

fn target(slot: &Slot, [row, column]: Stride) -> Target {
    let index = |first, step| Index { first, step };
    Target {
        array: slot.array,
        row: index(slot.row, row),
        column: index(slot.column, column),
    }
}
