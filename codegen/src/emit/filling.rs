//! Methods of the trait implementation that fill a buffer.
//!
//! In:  a program whose outputs are fields of the buffer.
//! Out: the method, and the functions that it calls where its statements would be too many.

use super::function::{Body, Decided, Place};
use super::parts::Parts;
use super::subject::{Reads, Subject, argument, doc_lines};
use super::symbol::SymbolNames;
use crate::optimise::Program;
use proc_macro2::{Ident, TokenStream};
use quote::quote;

/// What is known of a method before its program is written.
pub(super) struct Heading<'a> {
    pub name: &'a str,
    /// The type of its buffer.
    pub buffer: &'a str,
    pub docs: &'a str,
    pub cost: String,
    /// Whether it does something else with its arguments.
    pub reads_all: bool,
}

/// A method that fills a buffer.
pub(super) struct Filling {
    pub statements: TokenStream,
    /// What they call.
    pub functions: TokenStream,
    /// Documentation, name and arguments.
    pub signature: TokenStream,
}

impl Filling {
    /// The method that runs a program.
    pub fn of(subject: &Subject, heading: &Heading, program: &Program, place: Place) -> Self {
        let (names, taken) = (&subject.names, subject.names.taken.clone());
        let in_parts = Parts::are_worth(program);
        let all = in_parts || heading.reads_all;
        let state = argument("state", all || SymbolNames::reads_state(program));
        let out = argument("out", all || Reads::of(program).out);
        let arguments = typed(subject, heading.buffer, state, out);
        let name = argument(heading.name, true);
        let (docs, cost) = (doc_lines(heading.docs), &heading.cost);
        let signature = quote! {
            #(#[doc = #docs])*
            #[doc = ""]
            #[doc = #cost]
            fn #name(&self, #arguments)
        };
        let (statements, functions) = if in_parts {
            let place = (place, Decided::BySides);
            let parts = Parts::of(program, names, taken, place, (&name, &arguments));
            (parts.calls, parts.functions)
        } else {
            let body = Body::of(program, names, taken, place, Decided::BySides);
            (body.statements, TokenStream::new())
        };
        Self {
            statements,
            functions,
            signature,
        }
    }
}

/// The state and the buffer, with their types.
fn typed(subject: &Subject, buffer: &str, state: Ident, out: Ident) -> TokenStream {
    let (n, r) = subject.sizes();
    let buffer = argument(buffer, true);
    quote!(#state: &State<T, #n>, #out: &mut #buffer<T, #n, #r>)
}
