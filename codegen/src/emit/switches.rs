//! What decides the forces along a motion by its sign.
//!
//! In:  a mechanism whose conditions hang on switching functions.
//! Out: the table of the conditions, and the method that computes their switching
//!      functions; nothing where there are none.

use super::linearised::argument;
use super::{Subject, Written};
use crate::expr::ExprId;
use crate::optimise::Slot;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// `static CONDITIONS`.
pub(super) fn table(subject: &Subject) -> TokenStream {
    let switches = &subject.mechanism.switches;
    if switches.is_empty() {
        return TokenStream::new();
    }
    let entries = switches.iter().map(|switch| {
        let (text, kinks) = (&switch.text, switch.kinks);
        let line = Literal::u32_unsuffixed(switch.span.start.line);
        quote!(Condition { text: #text, line: #line, kinks: #kinks })
    });
    quote!(static CONDITIONS: &[Condition] = &[#(#entries),*];)
}

/// `fn switches`.
pub(super) fn switches(subject: &mut Subject) -> TokenStream {
    let switches = &subject.mechanism.switches;
    if switches.is_empty() {
        return TokenStream::new();
    }
    let count = switches.len();
    let parts = switches.iter().flat_map(|s| [s.value, s.rate]);
    let parts: Vec<ExprId> = parts.collect();
    let slot = |row| Slot {
        array: "switches",
        row,
        column: 0,
    };
    let wanted: Vec<_> = (0..).map(slot).zip(parts).collect();
    let Written {
        body, state, cost, ..
    } = subject.body(&wanted, &|_| None);
    let statements = &body.statements;
    let computed: Vec<TokenStream> = (0..count)
        .map(|i| {
            let [value, rate] = [0, 1].map(|part| body.output(slot(2 * i + part)));
            quote!(Switch { value: #value, rate: #rate })
        })
        .collect();
    let acceleration = argument("acceleration", &quote!(#statements #(#computed)*));
    let n = subject.sizes().0;
    quote! {
        /// What decides the conditions of the forces by its sign, and its rate.
        ///
        #[doc = #cost]
        fn switches(
            &self,
            #state: &State<T, #n>,
            #acceleration: &SVector<T, #n>,
            values: &mut [Switch<T>],
        ) -> &'static [Condition] {
            #statements
            let computed = [#(#computed),*];
            for (place, value) in values.iter_mut().zip(computed) {
                *place = value;
            }
            CONDITIONS
        }
    }
}
