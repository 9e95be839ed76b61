//! The linearised equations of motion: a method of the trait implementation.

use super::filling::begin;
use super::function::Decided;
use super::subject::{Called, Reads, Subject, Written, argument, entry_of_field};
use crate::optimise::LeftOut;
use proc_macro2::TokenStream;
use quote::quote;

/// Said of a mechanism whose linearisation is too long.
const LEFT_OUT: &str = " The linearised equations of motion would be too long and are left out: \
                        implicit integrators take differences.";

/// Said of a mechanism whose linearisation has numbers that no `f64` holds.
const INFINITE: &str = " The linearised equations of motion have numbers that are not finite and \
                        are left out: implicit integrators take differences.";

/// What the documentation of the module says of a linearisation that there is not.
pub(super) fn docs(subject: &Subject) -> Option<&'static str> {
    match subject.programs.linearised {
        Err(LeftOut::Expressions | LeftOut::Operations(_)) => Some(LEFT_OUT),
        Err(LeftOut::Infinite) => Some(INFINITE),
        Ok(_) => None,
    }
}

/// `fn linearised`; nothing where it would be too long.
pub(super) fn linearised(subject: &Subject) -> TokenStream {
    let Ok(computed) = &subject.programs.linearised else {
        return TokenStream::new();
    };
    let mut computed = computed.clone();
    let begin = begin(subject, &mut computed.program, &entry_of_field);
    let Written {
        body,
        state,
        acceleration,
        cost,
    } = subject.optimised(
        &computed,
        &entry_of_field,
        (Decided::BySides, Called::InSteps),
    );
    let reads = Reads::of(&computed.program);
    let multiplier = argument("multiplier", reads.multiplier);
    let statements = body.statements;
    let (n, r) = subject.sizes();
    quote! {
        /// The equations of motion linearised about a motion.
        ///
        /// | field | equation | shape |
        /// |---|---|---|
        /// | `force_by_position` | `∂(p₁ − M q̈ − Aᵀλ)/∂q` | `N × N` |
        /// | `force_by_velocity` | `∂p₁/∂q̇` | `N × N` |
        /// | `row_by_position` | `∂(p₂ − A q̈)/∂q` | `R × N` |
        /// | `row_by_velocity` | `∂p₂/∂q̇` | `R × N` |
        ///
        #[doc = #cost]
        fn linearised(
            &self,
            #state: &State<T, #n>,
            #acceleration: &SVector<T, #n>,
            #multiplier: &SVector<T, #r>,
            out: &mut Linearised<T, #n, #r>,
        ) -> bool {
            if !out.is_filled_by(&STRUCTURE) {
                #begin
            }
            #statements
            true
        }
    }
}
