//! The linearised equations of motion: a method of the trait implementation.

use super::dynamics::matrix;
use super::function::{Body, Decided};
use super::{Subject, Written, entry_of_field};
use crate::derive::linearise;
use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use quote::quote;

/// The name of an argument, or that it is not read.
pub(super) fn argument(name: &str, statements: &TokenStream) -> Ident {
    let is_name = |token| matches!(token, TokenTree::Ident(ident) if ident == name);
    let read = statements.clone().into_iter().any(is_name);
    let name = if read {
        name.into()
    } else {
        format!("_{name}")
    };
    Ident::new(&name, Span::call_site())
}

/// The most operations of a linearisation: what rustc takes a few seconds for. Beyond
/// that implicit integrators take differences.
pub(super) const OPERATIONS_MAX: usize = 10_000;

/// `fn linearised`; nothing where it would be too long.
pub(super) fn linearised(subject: &mut Subject) -> TokenStream {
    let equations = subject.equations;
    let Some(derivatives) = linearise(subject.mechanism, equations) else {
        return TokenStream::new();
    };
    let mut wanted = matrix("force_by_position", &derivatives.force_by_position);
    wanted.extend(matrix("force_by_velocity", &derivatives.force_by_velocity));
    wanted.extend(matrix("row_by_position", &derivatives.row_by_position));
    wanted.extend(matrix("row_by_velocity", &derivatives.row_by_velocity));
    let program = subject.program(&wanted);
    if program.len() > OPERATIONS_MAX {
        return TokenStream::new();
    }
    let Written {
        body: Body { statements, .. },
        is_zero,
        state,
        cost,
        ..
    } = subject.beside_derived(
        &wanted,
        subject.written(&program, &entry_of_field, Decided::BySides),
    );
    let out = if is_zero { "_out" } else { "out" };
    let out = Ident::new(out, Span::call_site());
    let acceleration = argument("acceleration", &statements);
    let multiplier = argument("multiplier", &statements);
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
            #out: &mut Linearised<T, #n, #r>,
        ) -> bool {
            #statements
            true
        }
    }
}
