//! The mass matrix column by column.
//!
//! In:  the program of `M q̈`.
//! Out: a function that runs it for one unit acceleration after the other, for those that
//!      hand out `M`.

use super::function::Decided;
use super::index::Target;
use super::repeated::Repeated;
use super::subject::{Subject, argument, doc_lines};
use super::symbol::SymbolNames;
use crate::model::Symbol;
use crate::optimise::Optimised;
use proc_macro2::TokenStream;
use quote::quote;

/// What the mass matrix is, for those who read the generated code.
pub(super) const MASS: &str =
    "Mass matrix `M = ∂²T/∂q̇²`, `N × N`, symmetric; kg for two lengths, kg·m² for two
angles, kg·m for one of each.";

/// `mass_matrix`, and what it has in common with other functions.
pub(super) fn columns(subject: &Subject) -> Option<TokenStream> {
    let Optimised { program, cost, .. } = subject.programs.inertia.as_ref()?;
    let is_acceleration = |symbol: &Symbol| matches!(symbol, Symbol::Acceleration(_));
    let words = subject.words(Decided::ByState);
    let Repeated { once, again } = Repeated::of(program, words, &place, &is_acceleration);
    let state = argument("state", SymbolNames::reads_state(program));
    let docs = doc_lines(MASS);
    let cost = format!(" Costs {cost} for each column.");
    let n = subject.sizes().0;
    Some(quote! {
        #(#[doc = #docs])*
        pub fn mass_matrix(&self, state: &State<T, #n>) -> SMatrix<T, #n, #n> {
            let mut out = SMatrix::<T, #n, #n>::zeros();
            self.write_mass(state, &mut out);
            out
        }

        /// Writes the mass matrix: each column is what resists a unit acceleration, from body
        /// to body.
        ///
        #[doc = #cost]
        fn write_mass(&self, #state: &State<T, #n>, out: &mut SMatrix<T, #n, #n>) {
            #once
            for (index, values) in out.data.0.iter_mut().enumerate() {
                let mut acceleration = SVector::<T, #n>::zeros();
                if let Some(unit) = acceleration.data.0[0].get_mut(index) {
                    *unit = T::one();
                }
                #again
            }
            // Equal but for round-off.
            out.fill_upper_triangle_with_lower_triangle();
        }
    })
}

fn place(Target { row, .. }: &Target) -> Option<TokenStream> {
    Some(quote!(values[#row]))
}
