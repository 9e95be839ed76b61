//! Equations of the `start` block that are no values of coordinates.

use super::structure::constraint_row;
use super::{Subject, interface::list};
use crate::derive::StartRows;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// The method of `impl Mechanism` that meets them; nothing if there are none.
pub(super) fn begin(subject: &Subject) -> TokenStream {
    let all = &subject.mechanism.start_equations;
    if all.is_empty() {
        return TokenStream::new();
    }
    let ((n, _), (_, r)) = (subject.sizes(), subject.counts());
    let positions = all.iter().filter(|row| row.holonomic).count();
    let [r, p, v] = [r, r + positions, r + all.len() - positions].map(Literal::usize_unsuffixed);
    quote! {
        fn begin(&self, start: &mut Start<T, #n>, t: T) -> Result<(), StartFault<T, #n>> {
            let structures = [&WITH_START_POSITIONS, &WITH_START_VELOCITIES];
            meet::<T, Self, #n, #r, #p, #v>(self, structures, start, t)
        }
    }
}

/// The implementation of `StartEquations`, and the texts of the rows.
pub(super) fn equations(subject: &mut Subject) -> TokenStream {
    let all = subject.mechanism.start_equations.clone();
    if all.is_empty() {
        return TokenStream::new();
    }
    let rows = |holonomic: bool| {
        let own = subject.mechanism.constraints.iter();
        let further = all.iter().filter(move |row| row.holonomic == holonomic);
        let rows: Vec<TokenStream> = own.chain(further).map(constraint_row).collect();
        quote!(Structure { constraints: &[#(#rows),*], ..STRUCTURE })
    };
    let (positions, velocities) = (rows(true), rows(false));
    let (n, name) = (subject.sizes().0, subject.type_name());
    let equations = subject.equations;
    let [place, speed] = [
        (
            &equations.start_positions,
            ["position_errors", "position_slopes"],
        ),
        (
            &equations.start_velocities,
            ["velocity_errors", "velocity_slopes"],
        ),
    ]
    .map(|(rows, names)| lists(subject, rows, names));
    quote! {
        /// The constraints and the equations of the start for positions.
        static WITH_START_POSITIONS: Structure = #positions;
        /// The constraints and the equations of the start for velocities.
        static WITH_START_VELOCITIES: Structure = #velocities;

        impl<T: Real> StartEquations<T, #n> for #name<T> {
            #place
            #speed
        }
    }
}

fn lists(subject: &mut Subject, rows: &StartRows, names: [&'static str; 2]) -> TokenStream {
    let errors = list(subject, names[0], &rows.errors);
    let slopes = list(subject, names[1], &rows.slopes.concat());
    quote!(#errors #slopes)
}
