//! The statements of a function.
//!
//! In:  values that get a name, and other statements, in their order.
//! Out: `let NAME = VALUE;` for each name; in long functions names are declared many at a
//!      time, and assigned where their values are known.
//!
//! For the debugger rustc describes the scope of each `let` as a part of the one before, by
//! recursion, and runs out of stack over some thousands of them.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

/// The most names that a function declares one by one.
const ONE_BY_ONE_MAX: usize = 1000;
/// How many a longer one declares at a time.
const AT_A_TIME: usize = 64;

enum Statement {
    Named(Ident, TokenStream),
    Other(TokenStream),
}

#[derive(Default)]
pub(super) struct Statements(Vec<Statement>);

impl Statements {
    /// Gives a value a name.
    pub(super) fn name(&mut self, name: Ident, value: TokenStream) {
        self.0.push(Statement::Named(name, value));
    }

    pub(super) fn push(&mut self, statement: TokenStream) {
        self.0.push(Statement::Other(statement));
    }

    /// Puts others behind these.
    pub(super) fn append(&mut self, others: Self) {
        self.0.extend(others.0);
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    pub(super) fn into_tokens(self) -> TokenStream {
        let name = |statement: &Statement| match statement {
            Statement::Named(name, _) => Some(name.clone()),
            Statement::Other(_) => None,
        };
        let names: Vec<Ident> = self.0.iter().filter_map(name).collect();
        let together = names.len() > ONE_BY_ONE_MAX;
        let mut parts = names.chunks(AT_A_TIME);
        let mut declared = 0;
        let mut tokens = TokenStream::new();
        for statement in self.0 {
            tokens.extend(match statement {
                Statement::Other(statement) => statement,
                Statement::Named(name, value) if !together => quote!(let #name = #value;),
                Statement::Named(name, value) if declared == 0 => {
                    let part = parts.next().unwrap_or_default();
                    declared = part.len() - 1;
                    let count = Literal::usize_unsuffixed(part.len());
                    quote!(let [#(#part),*]: [T; #count]; #name = #value;)
                }
                Statement::Named(name, value) => {
                    declared -= 1;
                    quote!(#name = #value;)
                }
            });
        }
        tokens
    }
}
