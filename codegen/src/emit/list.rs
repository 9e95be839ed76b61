//! Methods that write lists of values.

use super::function::Decided;
use super::name::ident;
use super::subject::{Called, Subject, Written};
use crate::optimise::{List, Optimised, Slot};
use proc_macro2::TokenStream;
use quote::quote;

/// A method that writes a list of values into a slice, as many as there is room for.
pub(super) fn list(subject: &Subject, name: &'static str, list: &List) -> TokenStream {
    all_values(subject, name, list.count, &list.computed)
}

/// A method that writes the first `count` entries of an array of the method's name into a slice, as
/// many as there is room for.
pub(super) fn all_values(
    subject: &Subject,
    name: &'static str,
    count: usize,
    computed: &Optimised,
) -> TokenStream {
    let n = subject.sizes().0;
    let method = ident(name);
    if count == 0 {
        return quote!(fn #method(&self, _state: &State<T, #n>, _values: &mut [T]) {});
    }
    let Written {
        body, state, cost, ..
    } = subject.body(computed, (Decided::ByState, Called::InSteps));
    let statements = &body.statements;
    let computed = (0..count).map(|row| body.output(Slot::of_vector(name, row)));
    quote! {
        #[doc = #cost]
        fn #method(&self, #state: &State<T, #n>, values: &mut [T]) {
            #statements
            let computed = [#(#computed),*];
            for (place, value) in values.iter_mut().zip(computed) {
                *place = value;
            }
        }
    }
}
