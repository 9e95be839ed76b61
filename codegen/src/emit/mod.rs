//! Programs to Rust: one module for each mechanism.
//!
//! In:  a mechanism, its equations, and the programs that `optimise` made of them.
//! Out: a module that holds the mechanism's struct, its parameters and inputs, the
//!      implementations of the runtime's traits, and a function for each array.
//!
//! Not here: mathematics. What is computed was decided by `optimise`, and nothing is
//! concluded from tokens that were written: signatures and imports follow from the programs.

mod angles;
mod arrays;
mod c;
mod column;
mod columns;
mod described;
mod dynamics;
mod filling;
mod function;
mod imports;
mod index;
mod interface;
mod linearised;
mod list;
mod literal;
mod loops;
mod name;
mod numbers;
mod outputs;
mod partials;
mod parts;
mod quantity;
mod repeated;
mod start;
mod statements;
mod step;
mod structure;
mod subject;
mod sum;
mod switches;
mod symbol;
mod tables;
mod turns;
mod write;

pub use c::c_header;
pub use name::{camel_case as type_name, snake_case as module_name};
pub use subject::{EmitOptions, Provenance};
pub use write::{catalogue, render, write_if_changed};

use crate::derive::Equations;
use crate::model::Mechanism;
use crate::optimise::Programs;
use imports::imports;
use name::ident;
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use subject::{Subject, doc_lines};
use symbol::SymbolNames;

/// The version of the interface that modules are written for: the runtime's `FORMAT`.
const FORMAT: u32 = 10;

/// The module of a mechanism, from the programs that it runs. The numbers of a description are
/// meant as they are, though one be nearly π or √2.
pub fn module(
    mechanism: &Mechanism,
    equations: &Equations,
    programs: &Programs,
    provenance: Provenance,
    options: EmitOptions,
) -> TokenStream {
    let subject = Subject {
        mechanism,
        equations,
        programs,
        names: SymbolNames::of(mechanism),
        file: provenance.file,
        options,
    };
    let docs = module_docs(&subject, provenance);
    let module = ident(&module_name(provenance.module));
    let imports = imports(&subject);
    let format = Literal::u32_unsuffixed(FORMAT);
    let source = provenance.source;
    let structure = structure::structure(&subject);
    let conditions = switches::table(&subject);
    let tables = tables::tables(&subject);
    let parameters = structure::parameters(&subject);
    let inputs = structure::inputs(&subject);
    let holder = holder(&subject);
    let dynamics = dynamics::mechanism(&subject);
    let arrays = arrays::arrays(&subject);
    let start_equations = start::equations(&subject);
    let interface = interface::interface(&subject);
    let derivatives = partials::derivatives(&subject);
    let export = options
        .c_interface
        .then(|| c::export(mechanism, provenance.module));
    quote! {
        #(#[doc = #docs])*
        #[allow(clippy::approx_constant, clippy::needless_range_loop)]
        pub mod #module {
            #imports
            const _: () = bricard_runtime::written_for(#format);

            /// The description that this module was generated from.
            pub const SOURCE: &str = #source;

            #structure
            #conditions
            #tables
            #parameters
            #inputs
            #holder
            #dynamics
            #arrays
            #start_equations
            #interface
            #derivatives
        }

        #export
    }
}

fn module_docs(subject: &Subject, provenance: Provenance) -> Vec<String> {
    let Mechanism {
        name,
        docs,
        constants,
        ..
    } = subject.mechanism;
    let docs = if docs.trim().is_empty() {
        name.as_str()
    } else {
        docs.trim()
    };
    let mut lines = doc_lines(docs);
    let (n, r) = subject.counts();
    let states = match subject.mechanism.states {
        0 => String::new(),
        1 => ", the last of them the integral of a state".to_string(),
        states => format!(", the last {states} of them integrals of states"),
    };
    lines.push(String::new());
    lines.push(format!(
        " Generated from `{}`: {n} coordinates{states}, {r} constraint equations.",
        provenance.file
    ));
    if let Some(eliminated) = described::docs(subject) {
        lines.extend([String::new(), eliminated]);
    }
    if !constants.is_empty() {
        let folded: Vec<String> = constants
            .iter()
            .map(|constant| {
                let value = subject
                    .mechanism
                    .graph
                    .text(constant.value, &|s| subject.text(s));
                format!("`{} = {value}`", constant.quantity.name)
            })
            .collect();
        lines.extend([
            String::new(),
            format!(" Folded constants: {}.", folded.join(", ")),
        ]);
    }
    if !provenance.frozen.is_empty() {
        lines.extend([
            String::new(),
            format!(
                " Parameters frozen at their defaults: `{}`.",
                provenance.frozen.join("`, `")
            ),
        ]);
    }
    if let Some(left_out) = linearised::docs(subject) {
        lines.extend([String::new(), left_out.to_string()]);
    }
    lines
}

/// The struct that stands for the mechanism.
fn holder(subject: &Subject) -> TokenStream {
    let name = subject.type_name();
    let docs = match subject.mechanism.docs.trim() {
        "" => doc_lines(&subject.mechanism.name),
        docs => doc_lines(docs),
    };
    let parameters = !subject.mechanism.parameters.is_empty();
    let inputs = !subject.mechanism.inputs.is_empty();
    let (mut fields, mut defaults) = (TokenStream::new(), TokenStream::new());
    if parameters {
        fields.extend(quote!(/** Run-time parameters. */ pub parameters: Parameters<T>,));
        defaults.extend(quote!(parameters: Parameters::default(),));
    }
    if inputs {
        fields.extend(quote!(/** External signals. */ pub inputs: Inputs<T>,));
        defaults.extend(quote!(inputs: Inputs::default(),));
    }
    if !parameters && !inputs {
        fields.extend(quote!(scalar: core::marker::PhantomData<T>,));
        defaults.extend(quote!(scalar: core::marker::PhantomData,));
    }
    quote! {
        #(#[doc = #docs])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct #name<T> { #fields }

        impl<T: Real> Default for #name<T> {
            fn default() -> Self {
                #name { #defaults }
            }
        }
    }
}
