//! What a module uses of the runtime.
//!
//! In:  a mechanism, the methods that were written for it.
//! Out: its `use` items.

use super::Subject;
use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use quote::quote;

/// What the module uses of the runtime: a method that is not emitted leaves its
/// buffer out.
pub(super) fn imports(subject: &Subject, dynamics: &TokenStream) -> TokenStream {
    let mut names = vec![
        "Canvas",
        "Energy",
        "Initial",
        "Interface",
        "Linearised",
        "Mechanism",
        "Partials",
        "Quantity",
        "Real",
        "Regular",
        "Start",
        "State",
        "Structure",
        "Terms",
    ];
    if !subject.mechanism.constraints.is_empty() {
        names.extend(["ConstraintRow", "Correction", "Position"]);
    }
    if (subject.mechanism.constraints.iter()).any(|row| row.multiplier.is_some()) {
        names.push("Multiplier");
    }
    if !subject.mechanism.described.is_empty() {
        names.extend(["ConstraintRow", "Declared", "Described"]);
    }
    let starts = &subject.mechanism;
    if !starts.start_equations.is_empty() {
        names.extend(["ConstraintRow", "meet"]);
    }
    if !starts.start_guesses.is_empty() {
        names.push("guess");
    }
    if !(starts.start_equations.is_empty() && starts.start_guesses.is_empty()) {
        names.extend(["StartEquations", "StartFault"]);
    }
    if !subject.mechanism.events.is_empty() {
        names.extend(["Direction", "Event"]);
    }
    if !subject.mechanism.switches.is_empty() {
        names.extend(["Condition", "Switch"]);
    }
    let optional = ["Correction", "Linearised", "Partials", "Regular"];
    names.retain(|name| !optional.contains(name) || mentions(dynamics, name));
    names.sort_unstable();
    names.dedup();
    let names = names
        .into_iter()
        .map(|name| Ident::new(name, Span::call_site()));
    quote! {
        use bricard_runtime::nalgebra::{SMatrix, SVector};
        use bricard_runtime::{#(#names),*};
    }
}

/// Whether a name occurs in tokens, at any depth.
pub(super) fn mentions(tokens: &TokenStream, name: &str) -> bool {
    tokens.clone().into_iter().any(|token| match token {
        TokenTree::Ident(ident) => ident == name,
        TokenTree::Group(group) => mentions(&group.stream(), name),
        _ => false,
    })
}
