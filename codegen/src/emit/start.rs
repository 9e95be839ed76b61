//! Equations of the `start` block that are no values of coordinates.

use super::list::list;
use super::quantity::constraint_row;
use super::subject::Subject;
use crate::model::{Constraint, Mechanism};
use crate::optimise::StartPrograms;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// All equations of the start, those that are held first.
fn all(mechanism: &Mechanism) -> impl Iterator<Item = &Constraint> {
    (mechanism.start_equations.iter()).chain(&mechanism.start_guesses)
}

/// The method of `impl Mechanism` that meets them; nothing if there are none.
pub(super) fn begin(subject: &Subject) -> TokenStream {
    let ((n, _), (_, r)) = (subject.sizes(), subject.counts());
    let (held, guessed) = (
        &subject.mechanism.start_equations,
        &subject.mechanism.start_guesses,
    );
    let sizes = |first: usize, rows: &mut dyn Iterator<Item = &Constraint>| {
        let (positions, velocities): (Vec<_>, Vec<_>) = rows.partition(|row| row.holonomic);
        let sizes = [r, first + positions.len(), first + velocities.len()];
        let [r, p, v] = sizes.map(Literal::usize_unsuffixed);
        quote!(<T, Self, #n, #r, #p, #v>)
    };
    let guess = (!guessed.is_empty()).then(|| {
        let sizes = sizes(0, &mut all(subject.mechanism));
        quote! {
            // Guesses that can't be met are ignored.
            let _met = guess::#sizes(self, &STRUCTURE, start, t);
        }
    });
    let last = match held.is_empty() {
        true => quote!(Ok(())),
        false => {
            let sizes = sizes(r, &mut held.iter());
            quote! {
                let structures = [&WITH_START_POSITIONS, &WITH_START_VELOCITIES];
                meet::#sizes(self, structures, start, t)
            }
        }
    };
    if held.is_empty() && guessed.is_empty() {
        return TokenStream::new();
    }
    quote! {
        fn begin(&self, start: &mut Start<T, #n>, t: T) -> Result<(), StartFault<T, #n>> {
            #guess
            #last
        }
    }
}

/// The implementation of `StartEquations`, and the texts of the rows.
pub(super) fn equations(subject: &Subject) -> TokenStream {
    if all(subject.mechanism).next().is_none() {
        return TokenStream::new();
    }
    let held = &subject.mechanism.start_equations;
    let rows = |holonomic: bool| {
        let own = subject.mechanism.constraints.iter();
        let further = held.iter().filter(move |row| row.holonomic == holonomic);
        let rows: Vec<TokenStream> = own.chain(further).map(constraint_row).collect();
        quote!(Structure { constraints: &[#(#rows),*], components: &[], ..STRUCTURE })
    };
    let (positions, velocities) = (rows(true), rows(false));
    let (n, name) = (subject.sizes().0, subject.type_name());
    let place = lists(
        subject,
        &subject.programs.start_positions,
        ["position_errors", "position_slopes"],
    );
    let speed = lists(
        subject,
        &subject.programs.start_velocities,
        ["velocity_errors", "velocity_slopes"],
    );
    let structures = (!held.is_empty()).then(|| {
        quote! {
            /// The constraints and the equations of the start for positions.
            static WITH_START_POSITIONS: Structure = #positions;
            /// The constraints and the equations of the start for velocities.
            static WITH_START_VELOCITIES: Structure = #velocities;
        }
    });
    quote! {
        #structures

        impl<T: Real> StartEquations<T, #n> for #name<T> {
            #place
            #speed
        }
    }
}

fn lists(subject: &Subject, rows: &StartPrograms, names: [&'static str; 2]) -> TokenStream {
    let errors = list(subject, names[0], &rows.errors);
    let slopes = list(subject, names[1], &rows.slopes);
    quote!(#errors #slopes)
}
