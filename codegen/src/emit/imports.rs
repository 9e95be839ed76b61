//! What a module uses of the runtime.
//!
//! In:  a mechanism, its programs.
//! Out: its `use` items.

use super::name::ident;
use super::subject::Subject;
use proc_macro2::TokenStream;
use quote::quote;

/// What every module uses.
const ALWAYS: [&str; 11] = [
    "Canvas",
    "Energy",
    "Initial",
    "Interface",
    "Mechanism",
    "Quantity",
    "Real",
    "Start",
    "State",
    "Structure",
    "Terms",
];

/// What the module uses of the runtime: a function that is not emitted leaves its
/// types out.
pub(super) fn imports(subject: &Subject) -> TokenStream {
    let (mechanism, programs) = (subject.mechanism, subject.programs);
    let held = !mechanism.start_equations.is_empty();
    let guessed = !mechanism.start_guesses.is_empty();
    let named = mechanism.constraints.iter().any(|c| c.multiplier.is_some());
    let split = !subject.equations.components.is_empty();
    let parts: [(bool, &[&str]); 16] = [
        (true, &ALWAYS),
        (programs.acceleration.is_some(), &["Acceleration"]),
        (programs.position.is_some(), &["ConstraintRow", "Position"]),
        (programs.correction.is_some(), &["Correction"]),
        (programs.linearised.is_ok(), &["Linearised"]),
        (subject.options.c_interface, &["Differentiated"]),
        (programs.partials.is_some(), &["Partials"]),
        (split, &["ConnectedComponent"]),
        (named, &["Multiplier"]),
        (
            !mechanism.described.is_empty(),
            &["ConstraintRow", "Declared", "Described"],
        ),
        (held, &["ConstraintRow", "meet"]),
        (guessed, &["guess"]),
        (held || guessed, &["StartEquations", "StartFault"]),
        (!mechanism.events.is_empty(), &["Direction", "Event"]),
        (
            !mechanism.switches.is_empty(),
            &["Condition", "Discontinuity", "Switch", "Switches"],
        ),
        (!mechanism.tables.is_empty(), &["Table"]),
    ];
    let used = parts.into_iter().filter(|(used, _)| *used);
    let mut names: Vec<&str> = used.flat_map(|(_, names)| names).copied().collect();
    names.sort_unstable();
    names.dedup();
    let names = names.into_iter().map(ident);
    quote! {
        use bricard_runtime::nalgebra::{SMatrix, SVector};
        use bricard_runtime::{#(#names),*};
    }
}
