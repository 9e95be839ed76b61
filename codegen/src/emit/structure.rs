//! The static description of a mechanism, and the structs of its parameters and
//! inputs.

use super::function::Decided;
use super::quantity::{constraint_row, quantity};
use super::subject::{Subject, doc_lines};
use super::{described, name};
use crate::derive::ConnectedComponent;
use crate::model::{Constraint, Direction, Event, Input, Quantity};
use crate::optimise::{Program, Slot};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// `static STRUCTURE`.
pub(super) fn structure(subject: &Subject) -> TokenStream {
    let Subject {
        mechanism, file, ..
    } = subject;
    let (name, docs) = (&mechanism.name, &mechanism.docs);
    let coordinates = quantities(&mechanism.coordinates);
    let parameters = quantities(mechanism.parameters.iter().map(|p| &p.quantity));
    let inputs = quantities(mechanism.inputs.iter().map(|i| &i.quantity));
    let outputs = quantities(mechanism.outputs.iter().map(|o| &o.quantity));
    let described = described::table(subject);
    let constraints = mechanism.constraints.iter().map(constraint_row);
    let accelerated = mechanism.outputs.iter().any(|o| o.accelerated);
    let states = Literal::usize_unsuffixed(mechanism.states);
    let multipliers = multipliers(&mechanism.constraints);
    let events = mechanism.events.iter().map(event);
    let constant_mass = subject.equations.has_constant_mass(&mechanism.graph);
    let conservative = subject.equations.are_conservative(mechanism);
    let scleronomic = subject.equations.are_scleronomic(mechanism);
    let independent = subject.equations.are_independent(&mechanism.graph);
    let drawn = !mechanism.shapes.is_empty();
    let assumed_regular = subject.options.assumed_regular;
    let weighed = indices(&subject.equations.weighed);
    let redundant = indices(&subject.equations.redundant);
    // Where rows are independent by their form, nothing looks whether they are.
    let metric_degenerates = subject.equations.metric_degenerates && !independent;
    let components = subject.equations.components.iter().map(component);
    let unitless_angles = indices(&subject.equations.unitless_angles(mechanism));
    quote! {
        static STRUCTURE: Structure = Structure {
            name: #name,
            docs: #docs,
            file: #file,
            coordinates: &[#(#coordinates),*],
            unitless_angles: #unitless_angles,
            states: #states,
            described: &[#(#described),*],
            parameters: &[#(#parameters),*],
            inputs: &[#(#inputs),*],
            outputs: &[#(#outputs),*],
            accelerated: #accelerated,
            events: &[#(#events),*],
            constraints: &[#(#constraints),*],
            multipliers: &[#(#multipliers),*],
            constant_mass: #constant_mass,
            conservative: #conservative,
            scleronomic: #scleronomic,
            independent: #independent,
            drawn: #drawn,
            assumed_regular: #assumed_regular,
            weighed: #weighed,
            redundant: #redundant,
            metric_degenerates: #metric_degenerates,
            components: &[#(#components),*],
        };
    }
}

fn quantities<'a>(
    quantities: impl IntoIterator<Item = &'a Quantity>,
) -> impl Iterator<Item = TokenStream> {
    quantities.into_iter().map(quantity)
}

/// A slice of indices.
fn indices(indices: &[usize]) -> TokenStream {
    let indices = indices.iter().copied().map(Literal::usize_unsuffixed);
    quote!(&[#(#indices),*])
}

/// An entry of `Structure::events`.
fn event(event: &Event) -> TokenStream {
    let name = &event.name;
    let direction = match event.direction {
        Direction::Rising => quote!(Rising),
        Direction::Falling => quote!(Falling),
        Direction::Crossing => quote!(Crossing),
    };
    quote!(Event { name: #name, direction: Direction::#direction })
}

/// An entry of `Structure::components`.
fn component(component: &ConnectedComponent) -> TokenStream {
    let (coordinates, rows) = (indices(&component.coordinates), indices(&component.rows));
    let scleronomic = component.scleronomic;
    quote! {
        ConnectedComponent { coordinates: #coordinates, rows: #rows, scleronomic: #scleronomic }
    }
}

/// The entries of `Structure::multipliers`.
fn multipliers(constraints: &[Constraint]) -> impl Iterator<Item = TokenStream> {
    let rows = constraints.iter().enumerate();
    rows.filter_map(|(row, constraint)| {
        let quantity = quantity(constraint.multiplier.as_ref()?);
        let row = Literal::usize_unsuffixed(row);
        Some(quote!(Multiplier { quantity: #quantity, row: #row }))
    })
}

/// What is said of parameters whose fields would have the same name.
const ALIKE: &str = " Of names that differ in case alone, the one spelt as the field is has the \
                     field; the others have a number behind their names.";

/// The struct of run-time parameters with its defaults; nothing if there are none.
pub(super) fn parameters(subject: &Subject) -> TokenStream {
    let parameters = &subject.mechanism.parameters;
    if parameters.is_empty() {
        return TokenStream::new();
    }
    let fields = &subject.names.parameter_fields;
    let docs: Vec<Vec<String>> = parameters
        .iter()
        .map(|p| doc_lines(&quantity_docs(&p.quantity)))
        .collect();
    let defaults = subject.programs.defaults.iter();
    let defaults = defaults.map(|program| default(subject, program));
    let alike = parameters
        .iter()
        .zip(fields)
        .any(|(parameter, field)| *field != name::snake_case(&parameter.quantity.name));
    let alike = alike.then(|| {
        let docs = ["", ALIKE].map(str::to_string);
        quote!(#(#[doc = #docs])*)
    });
    quote! {
        /// Run-time parameters, in SI units.
        #alike
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Parameters<T> { #(#(#[doc = #docs])* pub #fields: T),* }

        impl<T: Real> Default for Parameters<T> {
            fn default() -> Self {
                Parameters { #(#fields: #defaults),* }
            }
        }
    }
}

/// A default value: an expression, or a block where it takes statements.
fn default(subject: &Subject, program: &Program) -> TokenStream {
    let body = subject.straight(program, &|_| None, Decided::ByState);
    let value = body.output(Slot::of_vector("default", 0));
    match &body.statements {
        none if none.is_empty() => value,
        statements => quote!({ #statements #value }),
    }
}

/// The struct of inputs, each at its law by default; nothing if there are none.
pub(super) fn inputs(subject: &Subject) -> TokenStream {
    let inputs = &subject.mechanism.inputs;
    if inputs.is_empty() {
        return TokenStream::new();
    }
    let fields = &subject.names.input_fields;
    let docs = |input: &Input| {
        let law = subject
            .mechanism
            .graph
            .text(input.law, &|symbol| subject.text(symbol));
        let docs = quantity_docs(&input.quantity);
        doc_lines(&format!("{docs}\n\nDefault law: `{law}`."))
    };
    let docs: Vec<Vec<String>> = inputs.iter().map(docs).collect();
    quote! {
        /// External signals, in SI units: `None` is the default law.
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct Inputs<T> { #(#(#[doc = #docs])* pub #fields: Option<T>),* }
    }
}

fn quantity_docs(quantity: &Quantity) -> String {
    let Quantity {
        name, unit, docs, ..
    } = quantity;
    let unit = if unit.is_empty() {
        String::new()
    } else {
        format!(" ({unit})")
    };
    let docs = docs.trim();
    let stop = if docs.is_empty() {
        String::new()
    } else {
        format!(": {docs}")
    };
    format!("`{name}`{unit}{stop}")
}
