//! Long functions in parts.
//!
//! In:  a program, and the signature of the function that runs it.
//! Out: functions that run a part of it each, and the calls of all of them, one after the
//!      other. What one part computes and later ones read is kept in an array, whose places
//!      are used again as soon as nobody reads them any more.
//!
//! What a compiler needs for a straight line grows faster than the line: vectorising, keeping
//! values in registers and scheduling look at all of a block, again and again.

use super::function::{Place, Symbols, Words};
use super::name::ident;
use super::step::{Angles, Step, Steps};
use super::subject::argument;
use crate::model::Symbol;
use crate::optimise::Program;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use rustc_hash::{FxHashMap, FxHashSet};

/// The most operations of a function without loops that is one straight line, unless another
/// number is asked for. Parts run longer, since they go through memory: an acceleration of a row
/// of 80 parallelograms would take 1.8 times as many instructions in parts.
pub(super) const STRAIGHT_LINE: usize = 20_000;
/// The most statements of a part; where shorter lines are asked for, a quarter of their operations.
/// With such parts, the passes of a compiler that look at all of a block take half as long for a
/// row of 320 as with parts of 2,000 statements, and as many instructions run.
const STATEMENTS: usize = 250;

/// A function that was taken apart.
pub(super) struct Parts {
    /// Its statements: the calls.
    pub calls: TokenStream,
    /// The functions that run a part each.
    pub functions: TokenStream,
}

impl Parts {
    /// Writes a program. The function that is taken apart has a name, and takes a `state` and a
    /// buffer `out`.
    pub fn of(
        program: &Program,
        words: Words,
        place: Place,
        (name, [state_type, out_type]): (&Ident, &[TokenStream; 2]),
        straight_line: usize,
    ) -> Self {
        let symbols = words.symbols;
        let Steps {
            angles,
            list,
            definitions,
            ..
        } = Steps::of(program, words);
        let parts = parts(list, STATEMENTS.min(straight_line / 4));
        let kept = Kept::between(angles.as_ref(), &parts, &definitions);
        let angles = angles.map(|angles| PartBody::of_angles(angles, &kept));
        let others = parts.into_iter();
        let others = others.map(|part| PartBody::of_steps(part, symbols, place, &kept));
        let count = Literal::usize_unsuffixed(kept.count);
        let mut functions = TokenStream::new();
        let mut calls = quote!(let mut kept = [T::zero(); #count];);
        for (number, part) in angles.into_iter().chain(others).enumerate() {
            let name = ident(&format!("{name}_part_{number}"));
            let PartBody {
                body,
                arguments: [state, out, room],
            } = part;
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

/// Divides steps into parts with at most `most` statements each, unless one step has more.
fn parts(steps: Vec<Step>, most: usize) -> Vec<Vec<Step>> {
    let mut parts: Vec<Vec<Step>> = Vec::new();
    let mut statements = 0;
    for step in steps {
        statements += step.length();
        match parts.last_mut() {
            Some(part) if statements <= most => part.push(step),
            _ => {
                statements = step.length();
                parts.push(vec![step]);
            }
        }
    }
    parts
}

/// The values that one part computes and later ones read. No part writes places that are next to
/// one another: compilers would try to compute what is stored there side by side, in vain.
struct Kept<'a> {
    definitions: &'a [Ident],
    places: FxHashMap<usize, usize>,
    count: usize,
}

impl<'a> Kept<'a> {
    /// The call for the angles is the first part, if there is one.
    fn between(angles: Option<&Angles>, parts: &[Vec<Step>], definitions: &'a [Ident]) -> Self {
        let first = usize::from(angles.is_some());
        let numbered = || (first..).zip(parts);
        let mut last: FxHashMap<usize, usize> = FxHashMap::default();
        for (part, steps) in numbered() {
            let read = steps.iter().flat_map(Step::reads);
            last.extend(read.map(|number| (number, part)));
        }
        let pairs = angles.iter().flat_map(|angles| &angles.pairs);
        let of_angles: Vec<usize> = pairs.flatten().flatten().copied().collect();
        let of_angles = angles.map(|_| (0, of_angles));
        let defined = numbered().map(|(part, steps)| {
            let defined = steps.iter().flat_map(|step| step.defines.clone());
            (part, defined.collect())
        });
        let mut places = FxHashMap::default();
        // For the even places and for the odd ones: those that are free, and how many there are.
        let mut free = [Vec::new(), Vec::new()];
        let mut counts = [0, 0];
        let mut taken: Vec<(usize, usize)> = Vec::new();
        for (part, defined) in of_angles.into_iter().chain(defined) {
            // A place that this part still reads is written by none of its statements.
            let given = taken.extract_if(.., |(last, _)| *last < part);
            given.for_each(|(_, place)| free[place % 2].push(place));
            for number in defined {
                let last = last.get(&number).copied().unwrap_or(part);
                if last > part {
                    let side = part % 2;
                    let place = free[side].pop().unwrap_or_else(|| {
                        counts[side] += 1;
                        2 * counts[side] - 2 + side
                    });
                    places.insert(number, place);
                    taken.push((last, place));
                }
            }
        }
        let count = 2 * counts[0].max(counts[1]);
        Self {
            definitions,
            places,
            count,
        }
    }

    fn place(&self, number: usize) -> Option<TokenStream> {
        let place = Literal::usize_unsuffixed(*self.places.get(&number)?);
        Some(quote!(kept[#place]))
    }
}

/// The statements of a part, and what it looks at: `state`, `out` and `kept`.
struct PartBody {
    body: TokenStream,
    arguments: [Ident; 3],
}

impl PartBody {
    fn of_angles(angles: Angles, kept: &Kept) -> Self {
        let Angles {
            statements,
            array,
            pairs,
        } = angles;
        let statements = statements.into_tokens();
        let mut body = quote!(#statements let (sines, cosines) = T::sin_cos_all(&#array););
        for (row, pair) in pairs.iter().enumerate() {
            let row = Literal::usize_unsuffixed(row);
            for (number, array) in pair.iter().zip([quote!(sines), quote!(cosines)]) {
                let place = number.and_then(|number| kept.place(number));
                body.extend(place.map(|place| quote!(#place = #array[#row];)));
            }
        }
        let arguments = [("state", true), ("out", false), ("kept", true)];
        Self {
            body,
            arguments: arguments.map(|(name, read)| argument(name, read)),
        }
    }

    /// What a part reads is fetched where it is read first.
    fn of_steps(part: Vec<Step>, symbols: &dyn Symbols, place: Place, kept: &Kept) -> Self {
        let read = part.iter().flat_map(|step| &step.symbols).copied();
        let mut body = symbols.prelude(&read.collect());
        let arguments = arguments(&part, kept);
        let mut known: FxHashSet<usize> = FxHashSet::default();
        for step in part {
            for number in step.reads() {
                if known.insert(number) {
                    let (name, place) = (&kept.definitions[number], kept.place(number));
                    body.extend(place.map(|place| quote!(let #name = #place;)));
                }
            }
            body.extend(step.statements.into_tokens());
            for (slot, value) in step.writes {
                let place = place(&(&slot).into());
                body.extend(place.map(|place| quote!(#place = #value;)));
            }
            for number in step.defines {
                let (name, place) = (&kept.definitions[number], kept.place(number));
                body.extend(place.map(|place| quote!(#place = #name;)));
                known.insert(number);
            }
        }
        Self { body, arguments }
    }
}

/// The arguments of the function that runs a part.
fn arguments(part: &[Step], kept: &Kept) -> [Ident; 3] {
    let mut symbols = part.iter().flat_map(|step| &step.symbols);
    let state = symbols.clone().any(|symbol| symbol.is_of_state());
    let weighed = symbols.any(|symbol| matches!(symbol, Symbol::Weight(_)));
    let out = part
        .iter()
        .any(|step| step.sides || !step.writes.is_empty());
    let mut numbers = (part.iter()).flat_map(|step| step.reads().chain(step.defines.clone()));
    let room = numbers.any(|number| kept.places.contains_key(&number));
    [
        argument("state", state),
        argument("out", out || weighed),
        argument("kept", room),
    ]
}
