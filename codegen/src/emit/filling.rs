//! Methods of the trait implementation that fill a buffer.
//!
//! In:  a program whose outputs are fields of the buffer.
//! Out: the method, and the functions that it calls where its statements would be too many.

use super::function::{Decided, Place};
use super::parts::{Parts, STRAIGHT_LINE};
use super::subject::{Called, Reads, Subject, Written, argument, doc_lines};
use super::symbol::SymbolNames;
use crate::optimise::{Optimised, Program, numbers_apart};
use proc_macro2::TokenStream;
use quote::quote;

/// What is known of a method before its program is written.
pub(super) struct Heading<'a> {
    pub name: &'a str,
    /// The type of its buffer.
    pub buffer: &'a str,
    pub docs: &'a str,
    pub cost: String,
    /// What the method does with its arguments before the program runs.
    pub before: TokenStream,
    /// Whether the method solves, and returns that it could.
    pub solves: bool,
    /// Whether the method is taken apart if it is long.
    pub divisible: bool,
}

/// A method of the trait, and the functions of the mechanism that it calls.
pub(super) struct Method {
    pub method: TokenStream,
    pub functions: TokenStream,
}

impl Method {
    /// The method that runs a program.
    pub fn of(subject: &Subject, heading: &Heading, program: &Program, place: Place) -> Self {
        let straight_line = subject.options.straight_line.unwrap_or(STRAIGHT_LINE);
        let decided = Decided::BySides;
        let loops = subject.loops(program, decided, Called::InSteps);
        let in_parts = heading.divisible && loops.is_none() && program.len() > straight_line;
        let all = in_parts || !heading.before.is_empty();
        let state = argument("state", all || SymbolNames::reads_state(program));
        let out = argument("out", all || Reads::of(program).out);
        let types = types(subject, heading.buffer);
        let [state_type, out_type] = &types;
        let name = argument(heading.name, true);
        let (statements, functions) = match loops {
            Some(loops) => (loops.statements(place), TokenStream::new()),
            None if in_parts => {
                let (words, function) = (subject.words(decided), (&name, &types));
                let parts = Parts::of(program, words, place, function, straight_line);
                (parts.calls, parts.functions)
            }
            None => {
                let body = subject.straight(program, place, decided);
                (body.statements, TokenStream::new())
            }
        };
        let (docs, cost) = (doc_lines(heading.docs), &heading.cost);
        let before = &heading.before;
        let inline = heading.solves.then(|| quote!(#[inline(always)]));
        let result = heading.solves.then(|| quote!(-> bool));
        let solved = heading.solves.then(|| quote!(true));
        let method = quote! {
            #(#[doc = #docs])*
            ///
            #[doc = #cost]
            #inline
            fn #name(&self, #state: &#state_type, #out: &mut #out_type) #result {
                #before
                #statements
                #solved
            }
        };
        Self { method, functions }
    }
}

/// What is done first with a buffer that another mechanism or none has filled: it is cleared, and
/// the outputs that are numbers are written. These are removed from the program.
pub(super) fn begin(subject: &Subject, program: &mut Program, place: Place) -> TokenStream {
    let (numbers, rest) = numbers_apart(program);
    *program = rest;
    let written = Optimised {
        program: numbers,
        ..Optimised::default()
    };
    let how = (Decided::ByState, Called::OnRequest);
    let Written { body, .. } = subject.optimised(&written, place, how);
    let statements = body.statements;
    quote!(out.clear(&STRUCTURE); #statements)
}

/// The types of the state and of the buffer.
pub(super) fn types(subject: &Subject, buffer: &str) -> [TokenStream; 2] {
    let (n, r) = subject.sizes();
    let buffer = argument(buffer, true);
    [quote!(State<T, #n>), quote!(#buffer<T, #n, #r>)]
}
