//! The coordinates that the description declares, where some of them were eliminated.
//!
//! In:  a mechanism.
//! Out: their table for the structure, the method of the interface that computes them,
//!      and a line for the documentation.

use super::quantity::{constraint_row, quantity};
use super::subject::{Subject, Written};
use crate::optimise::Slot;
use proc_macro2::TokenStream;
use quote::quote;

/// The entries of `Structure::described`.
pub(super) fn table(subject: &Subject) -> Vec<TokenStream> {
    let declared = subject.mechanism.described.iter();
    let entry = |coordinate: &crate::model::Described| {
        let quantity = quantity(&coordinate.quantity);
        let given_by = match &coordinate.given_by {
            Some(row) => {
                let row = constraint_row(row);
                quote!(Some(#row))
            }
            None => quote!(None),
        };
        quote!(Declared { quantity: #quantity, given_by: #given_by })
    };
    declared.map(entry).collect()
}

/// `fn described`; nothing where all coordinates are in the state.
pub(super) fn described(subject: &Subject) -> TokenStream {
    let count = subject.mechanism.described.len();
    if count == 0 {
        return TokenStream::new();
    }
    let computed = &subject.programs.described;
    let Written {
        body,
        state,
        acceleration,
        cost,
    } = subject.on_request(computed);
    let statements = &body.statements;
    let computed = (0..count).map(|i| {
        let parts = [0, 1, 2, 3].map(|part| Slot::of_vector("described", 4 * i + part));
        let [position, velocity, acceleration, reaction] = parts.map(|part| body.output(part));
        quote!(Described {
            position: #position,
            velocity: #velocity,
            acceleration: #acceleration,
            reaction: #reaction,
        })
    });
    let n = subject.sizes().0;
    quote! {
        #[doc = #cost]
        fn described(
            &self,
            #state: &State<T, #n>,
            #acceleration: &SVector<T, #n>,
            values: &mut [Described<T>],
        ) {
            #statements
            let computed = [#(#computed),*];
            for (place, value) in values.iter_mut().zip(computed) {
                *place = value;
            }
        }
    }
}

/// What was eliminated, and what it is; nothing if nothing was.
pub(super) fn docs(subject: &Subject) -> Option<String> {
    let mechanism = subject.mechanism;
    let gone = mechanism.described.iter().filter(|c| c.given_by.is_some());
    let equations: Vec<String> = gone
        .map(|c| {
            let value = mechanism.graph.text(c.position, &|s| subject.text(s));
            format!("`{} = {value}`", c.quantity.name)
        })
        .collect();
    (!equations.is_empty()).then(|| format!(" Eliminated: {}.", equations.join(", ")))
}
