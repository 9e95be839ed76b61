//! Outputs and inputs as numbers to record.
//!
//! In:  a mechanism.
//! Out: the methods of the interface that compute them: outputs of positions and
//!      velocities, and those of accelerations with the inputs.

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
    let wanted = chosen(subject, false);
    if wanted.is_empty() {
        return quote!(fn outputs(&self, _state: &State<T, #n>, _values: &mut [T]) {});
    }
    let written = subject.body(&wanted, &|_| None);
    let assigned = assigned(&quote!(values), &wanted, &written);
    let Written {
        body, state, cost, ..
    } = written;
    let statements = &body.statements;
    quote! {
        #[doc = #cost]
        fn outputs(&self, #state: &State<T, #n>, values: &mut [T]) {
            #statements
            #assigned
        }
    }
}

/// `fn signals`; nothing where there are neither outputs of accelerations nor inputs.
pub(super) fn signals(subject: &mut Subject) -> TokenStream {
    let outputs = chosen(subject, true);
    let count = u32::try_from(subject.mechanism.inputs.len()).unwrap_or(u32::MAX);
    let symbol = |i| subject.mechanism.graph.symbol(Symbol::Input(i));
    let inputs: Vec<ExprId> = (0..count).map(symbol).collect();
    let inputs: Vec<_> = (0..).map(|row| slot("inputs", row)).zip(inputs).collect();
    if outputs.is_empty() && inputs.is_empty() {
        return TokenStream::new();
    }
    let wanted = [outputs.as_slice(), inputs.as_slice()].concat();
    let written = subject.body(&wanted, &|_| None);
    let statements = &written.body.statements;
    let both = [("outputs", &outputs), ("inputs", &inputs)].map(|(name, wanted)| {
        let name = super::linearised::argument(name, &any(wanted));
        let assigned = match wanted.is_empty() {
            true => TokenStream::new(),
            false => assigned(&quote!(#name), wanted, &written),
        };
        (name, assigned)
    });
    let [(outputs, to_outputs), (inputs, to_inputs)] = both;
    let body = quote!(#statements #to_outputs #to_inputs);
    let acceleration = super::linearised::argument("acceleration", &body);
    let Written { state, cost, .. } = &written;
    let n = subject.sizes().0;
    quote! {
        #[doc = #cost]
        fn signals(
            &self,
            #state: &State<T, #n>,
            #acceleration: &SVector<T, #n>,
            #outputs: &mut [T],
            #inputs: &mut [T],
        ) {
            #body
        }
    }
}

/// The words for an array that is asked for, so that its name is used.
fn any(wanted: &[(Slot, ExprId)]) -> TokenStream {
    match wanted.first() {
        Some((slot, _)) => {
            let name = proc_macro2::Ident::new(slot.array, proc_macro2::Span::call_site());
            quote!(#name)
        }
        None => TokenStream::new(),
    }
}

fn slot(array: &'static str, row: usize) -> Slot {
    Slot {
        array,
        row,
        column: 0,
    }
}

/// The outputs that are of accelerations, or those that are not.
fn chosen(subject: &Subject, accelerated: bool) -> Vec<(Slot, ExprId)> {
    let outputs = subject.mechanism.outputs.iter().enumerate();
    outputs
        .filter(|(_, output)| output.accelerated == accelerated)
        .map(|(row, output)| (slot("outputs", row), output.value))
        .collect()
}

/// Statements that put values into their places, as far as there is room.
pub(super) fn assigned(
    array: &TokenStream,
    wanted: &[(Slot, ExprId)],
    written: &Written,
) -> TokenStream {
    let places = wanted
        .iter()
        .map(|(slot, _)| Literal::usize_unsuffixed(slot.row));
    let computed = wanted.iter().map(|(slot, _)| written.body.output(*slot));
    quote! {
        for (place, value) in [#((#places, #computed)),*] {
            if let Some(entry) = #array.get_mut(place) {
                *entry = value;
            }
        }
    }
}
