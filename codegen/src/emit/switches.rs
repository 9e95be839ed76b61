//! What decides the forces along a motion by its sign.
//!
//! In:  a mechanism whose conditions depend on switching functions.
//! Out: the table of the conditions, and the method that computes their switching
//!      functions; nothing where there are none.

use super::function::Decided;
use super::subject::{Called, Subject, Written};
use crate::model::Discontinuity;
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
        let text = &switch.text;
        let discontinuity = match switch.discontinuity {
            Discontinuity::Jump => quote!(Discontinuity::Jump),
            Discontinuity::Kink => quote!(Discontinuity::Kink),
            Discontinuity::Knot => quote!(Discontinuity::Knot),
        };
        let line = Literal::u32_unsuffixed(switch.span.start.line);
        let of_time = switch.of_time;
        quote!(Condition {
            text: #text, line: #line, discontinuity: #discontinuity, of_time: #of_time,
        })
    });
    quote!(static CONDITIONS: &[Condition] = &[#(#entries),*];)
}

/// `fn switches`.
pub(super) fn switches(subject: &Subject) -> TokenStream {
    let count = subject.mechanism.switches.len();
    if count == 0 {
        return TokenStream::new();
    }
    let computed = &subject.programs.switches;
    let Written {
        body,
        state,
        acceleration,
        cost,
    } = subject.body(computed, (Decided::BySides, Called::InSteps));
    let statements = &body.statements;
    let computed = (0..count).map(|i| {
        let part = |part| body.output(Slot::of_vector("switches", 2 * i + part));
        let (value, rate) = (part(0), part(1));
        quote!(Switch { value: #value, rate: #rate })
    });
    let n = subject.sizes().0;
    quote! {
        /// What decides the conditions of the forces by its sign, and its rate, with the
        /// conditions in it held.
        ///
        #[doc = #cost]
        fn switches(
            &self,
            #state: &State<T, #n>,
            #acceleration: &SVector<T, #n>,
            out: &mut Switches<'_, T>,
        ) -> &'static [Condition] {
            #statements
            let computed = [#(#computed),*];
            for (place, value) in out.values.iter_mut().zip(computed) {
                *place = value;
            }
            CONDITIONS
        }
    }
}
