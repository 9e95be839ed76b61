//! Outputs and inputs as numbers to record.
//!
//! In:  a mechanism.
//! Out: the methods of the interface that compute outputs, those of accelerations apart,
//!      and inputs.

use super::interface::list;
use super::{Subject, Written};
use crate::expr::{ExprId, Symbol};
use crate::optimise::Slot;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// `fn outputs`.
pub(super) fn outputs(subject: &mut Subject) -> TokenStream {
    let outputs = &subject.mechanism.outputs;
    if outputs.iter().all(|output| !output.accelerated) {
        let values: Vec<ExprId> = outputs.iter().map(|output| output.value).collect();
        return list(subject, "outputs", &values);
    }
    let n = subject.sizes().0;
    let (
        places,
        Written {
            body, state, cost, ..
        },
        computed,
    ) = chosen(subject, false);
    if places.is_empty() {
        return quote!(fn outputs(&self, _state: &State<T, #n>, _values: &mut [T]) {});
    }
    let statements = &body.statements;
    quote! {
        #[doc = #cost]
        fn outputs(&self, #state: &State<T, #n>, values: &mut [T]) {
            #statements
            for (place, value) in [#((#places, #computed)),*] {
                if let Some(entry) = values.get_mut(place) {
                    *entry = value;
                }
            }
        }
    }
}

/// `fn accelerated`; nothing where there are no such outputs.
pub(super) fn accelerated(subject: &mut Subject) -> TokenStream {
    let n = subject.sizes().0;
    let (
        places,
        Written {
            body, state, cost, ..
        },
        computed,
    ) = chosen(subject, true);
    if places.is_empty() {
        return TokenStream::new();
    }
    let statements = &body.statements;
    let acceleration =
        super::linearised::argument("acceleration", &quote!(#statements #(#computed)*));
    quote! {
        #[doc = #cost]
        fn accelerated(
            &self,
            #state: &State<T, #n>,
            #acceleration: &SVector<T, #n>,
            values: &mut [T],
        ) {
            #statements
            for (place, value) in [#((#places, #computed)),*] {
                if let Some(entry) = values.get_mut(place) {
                    *entry = value;
                }
            }
        }
    }
}

/// The outputs that are of accelerations, or those that are not: their places, the body
/// that computes them, their values.
fn chosen(subject: &mut Subject, accelerated: bool) -> (Vec<Literal>, Written, Vec<TokenStream>) {
    let outputs = subject.mechanism.outputs.iter().enumerate();
    let chosen = outputs.filter(|(_, output)| output.accelerated == accelerated);
    let slot = |row| Slot {
        array: "outputs",
        row,
        column: 0,
    };
    let wanted: Vec<_> = chosen
        .map(|(row, output)| (slot(row), output.value))
        .collect();
    let written = subject.body(&wanted, &|_| None);
    let places = wanted
        .iter()
        .map(|(slot, _)| Literal::usize_unsuffixed(slot.row));
    let computed = wanted.iter().map(|(slot, _)| written.body.output(*slot));
    let (places, computed) = (places.collect(), computed.collect());
    (places, written, computed)
}

/// `fn inputs`; nothing where there are none.
pub(super) fn inputs(subject: &mut Subject) -> TokenStream {
    let count = u32::try_from(subject.mechanism.inputs.len()).unwrap_or(u32::MAX);
    if count == 0 {
        return TokenStream::new();
    }
    let symbol = |i| subject.mechanism.graph.symbol(Symbol::Input(i));
    let values: Vec<ExprId> = (0..count).map(symbol).collect();
    list(subject, "inputs", &values)
}
