//! How forces, outputs and events change: a method for programs in other languages.
//!
//! In:  a mechanism.
//! Out: `fn partials` of the interface.

use super::linearised::{OPERATIONS_MAX, argument};
use super::outputs::assigned;
use super::{Subject, Written};
use crate::derive::{Matrix, differentiate};
use crate::expr::ExprId;
use crate::optimise::Slot;
use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;

/// The type that the method fills.
pub(super) const KIND: &str = "Partials";

/// `fn partials`; nothing where it would be too long.
pub(super) fn partials(subject: &mut Subject) -> TokenStream {
    let equations = subject.equations;
    let Some(derivatives) = differentiate(subject.mechanism, equations) else {
        return TokenStream::new();
    };
    let zero = subject.mechanism.graph.integer(0);
    let arrays = [
        ("force_by_input", &derivatives.force_by_input),
        ("outputs", &derivatives.outputs),
        ("events", &derivatives.events),
    ]
    .map(|(name, matrix)| (name, entries(name, matrix, zero)));
    let wanted = arrays
        .each_ref()
        .map(|(_, wanted)| wanted.as_slice())
        .concat();
    if subject.program(&wanted).len() > OPERATIONS_MAX {
        return TokenStream::new();
    }
    let written = subject.body(&wanted, &|_| None);
    let Written {
        body, state, cost, ..
    } = &written;
    let statements = &body.statements;
    let acceleration = argument("acceleration", statements);
    let out = Ident::new(
        if wanted.is_empty() { "_out" } else { "out" },
        Span::call_site(),
    );
    let filled = arrays.iter().filter(|(_, wanted)| !wanted.is_empty());
    let assigned = filled.map(|(name, wanted)| {
        let name = Ident::new(name, Span::call_site());
        assigned(&quote!(#out.#name), wanted, &written)
    });
    let kind = Ident::new(KIND, Span::call_site());
    let n = subject.sizes().0;
    quote! {
        /// How forces, outputs and events change.
        ///
        #[doc = #cost]
        fn partials(
            &self,
            #state: &State<T, #n>,
            #acceleration: &SVector<T, #n>,
            #out: &mut #kind<'_, T>,
        ) -> bool {
            #statements
            #(#assigned)*
            true
        }
    }
}

/// The entries of a matrix that can differ from zero, at their places row by row.
fn entries(array: &'static str, matrix: &Matrix, zero: ExprId) -> Vec<(Slot, ExprId)> {
    let entries = matrix.iter().flatten().enumerate();
    entries
        .filter(|(_, entry)| **entry != zero)
        .map(|(row, &entry)| {
            let slot = Slot {
                array,
                row,
                column: 0,
            };
            (slot, entry)
        })
        .collect()
}
