//! Outputs and inputs as numbers to record.
//!
//! In:  a mechanism.
//! Out: the methods of the interface that compute them: outputs of positions and
//!      velocities, and those of accelerations with the inputs.

use super::list::all_values;
use super::subject::{Subject, Written, argument};
use crate::optimise::Slot;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// `fn outputs`.
pub(super) fn outputs(subject: &Subject) -> TokenStream {
    let outputs = &subject.mechanism.outputs;
    let computed = &subject.programs.outputs;
    if outputs.iter().all(|output| !output.accelerated) {
        return all_values(subject, "outputs", outputs.len(), computed);
    }
    let n = subject.sizes().0;
    let places = places(subject, false);
    if places.is_empty() {
        return quote!(fn outputs(&self, _state: &State<T, #n>, _values: &mut [T]) {});
    }
    let written = subject.on_request(computed);
    let assigned = assigned(&quote!(values), "outputs", &places, &written);
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
pub(super) fn signals(subject: &Subject) -> TokenStream {
    let outputs = places(subject, true);
    let inputs: Vec<usize> = (0..subject.mechanism.inputs.len()).collect();
    if outputs.is_empty() && inputs.is_empty() {
        return TokenStream::new();
    }
    let computed = &subject.programs.signals;
    let written = subject.on_request(computed);
    let statements = &written.body.statements;
    let [(outputs, to_outputs), (inputs, to_inputs)] = [("outputs", &outputs), ("inputs", &inputs)]
        .map(|(array, places)| {
            let name = argument(array, !places.is_empty());
            let assigned = match places.is_empty() {
                true => TokenStream::new(),
                false => assigned(&quote!(#name), array, places, &written),
            };
            (name, assigned)
        });
    let Written {
        state,
        acceleration,
        cost,
        ..
    } = &written;
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
            #statements
            #to_outputs
            #to_inputs
        }
    }
}

/// The places of the outputs that are of accelerations, or of those that are not.
fn places(subject: &Subject, accelerated: bool) -> Vec<usize> {
    let outputs = subject.mechanism.outputs.iter().enumerate();
    outputs
        .filter(|(_, output)| output.accelerated == accelerated)
        .map(|(place, _)| place)
        .collect()
}

/// Statements that put values of an array into their places, as far as there is room.
pub(super) fn assigned(
    slice: &TokenStream,
    array: &'static str,
    places: &[usize],
    written: &Written,
) -> TokenStream {
    let value = |&place: &usize| written.body.output(Slot::of_vector(array, place));
    let computed = places.iter().map(value);
    let places = places.iter().copied().map(Literal::usize_unsuffixed);
    quote! {
        for (place, value) in [#((#places, #computed)),*] {
            if let Some(entry) = #slice.get_mut(place) {
                *entry = value;
            }
        }
    }
}
