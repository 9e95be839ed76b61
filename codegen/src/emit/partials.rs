//! How forces, outputs and events change: a method for programs in other languages.
//!
//! In:  a mechanism, its programs.
//! Out: `impl Differentiated`.

use super::name::ident;
use super::outputs::assigned;
use super::subject::{Reads, Subject, Written, argument};
use crate::optimise::Program;
use proc_macro2::TokenStream;
use quote::quote;

/// `impl Differentiated`, where programs in other languages are served.
pub(super) fn derivatives(subject: &Subject) -> TokenStream {
    if !subject.options.c_interface {
        return TokenStream::new();
    }
    let partials = partials(subject);
    let (n, name) = (subject.sizes().0, subject.type_name());
    quote! {
        impl<T: Real> Differentiated<T, #n> for #name<T> {
            #partials
        }
    }
}

/// `fn partials`; nothing where it would be too long.
fn partials(subject: &Subject) -> TokenStream {
    let Some(computed) = &subject.programs.partials else {
        return TokenStream::new();
    };
    let reads = Reads::of(&computed.program);
    let out = argument("out", reads.out);
    let written = subject.on_request(computed);
    let assigned = ["force_by_input", "outputs", "events"].map(|array| {
        let places = places(&computed.program, array);
        let name = ident(array);
        match places.is_empty() {
            true => TokenStream::new(),
            false => assigned(&quote!(#out.#name), array, &places, &written),
        }
    });
    let Written {
        body,
        state,
        acceleration,
        cost,
    } = written;
    let statements = body.statements;
    let n = subject.sizes().0;
    quote! {
        /// How forces, outputs and events change.
        ///
        #[doc = #cost]
        fn partials(
            &self,
            #state: &State<T, #n>,
            #acceleration: &SVector<T, #n>,
            #out: &mut Partials<'_, T>,
        ) -> bool {
            #statements
            #(#assigned)*
            true
        }
    }
}

/// The entries of an array that can differ from zero.
fn places(program: &Program, array: &'static str) -> Vec<usize> {
    let slots = program.outputs.iter().map(|(slot, _)| slot);
    let mut places: Vec<usize> = slots
        .filter(|slot| slot.array == array)
        .map(|slot| slot.row)
        .collect();
    places.sort_unstable();
    places
}
