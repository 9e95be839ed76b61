//! `impl Interface`: parameters by place, start, outputs, events, the picture.

use super::described::described;
use super::list::list;
use super::outputs;
use super::subject::{Subject, Written};
use crate::model::{Point, Shape};
use crate::optimise::Slot;
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use std::collections::BTreeMap;

/// `impl Interface`.
pub(super) fn interface(subject: &Subject) -> TokenStream {
    let n = subject.sizes().0;
    let (parameter, set_parameter) = parameters(subject);
    let set_input = set_input(subject);
    let start = start(subject);
    let outputs = outputs::outputs(subject);
    let signals = outputs::signals(subject);
    let events = list(subject, "events", &subject.programs.events);
    let draw = draw(subject);
    let described = described(subject);
    let name = subject.type_name();
    quote! {
        impl<T: Real> Interface<T, #n> for #name<T> {
            #parameter
            #set_parameter
            #set_input
            #start
            #outputs
            #signals
            #events
            #draw
            #described
        }
    }
}

fn parameters(subject: &Subject) -> (TokenStream, TokenStream) {
    let fields = &subject.names.parameter_fields;
    if fields.is_empty() {
        return (
            quote!(
                fn parameter(&self, _index: usize) -> Option<T> {
                    None
                }
            ),
            quote!(
                fn set_parameter(&mut self, _index: usize, _value: T) -> bool {
                    false
                }
            ),
        );
    }
    let places: Vec<Literal> = (0..fields.len()).map(Literal::usize_unsuffixed).collect();
    let get = quote! {
        fn parameter(&self, index: usize) -> Option<T> {
            match index {
                #(#places => Some(self.parameters.#fields),)*
                _ => None,
            }
        }
    };
    let set = quote! {
        fn set_parameter(&mut self, index: usize, value: T) -> bool {
            match index {
                #(#places => self.parameters.#fields = value,)*
                _ => return false,
            }
            true
        }
    };
    (get, set)
}

fn set_input(subject: &Subject) -> TokenStream {
    let fields = &subject.names.input_fields;
    if fields.is_empty() {
        return quote!(
            fn set_input(&mut self, _index: usize, _value: Option<T>) -> bool {
                false
            }
        );
    }
    let places: Vec<Literal> = (0..fields.len()).map(Literal::usize_unsuffixed).collect();
    quote! {
        fn set_input(&mut self, index: usize, value: Option<T>) -> bool {
            match index {
                #(#places => self.inputs.#fields = value,)*
                _ => return false,
            }
            true
        }
    }
}

/// The entries of the `start` block; what it does not mention is a guess of zero.
fn start(subject: &Subject) -> TokenStream {
    let n = subject.sizes().0;
    let starts = &subject.mechanism.starts;
    let Written { body, .. } = subject.on_request(&subject.programs.start);
    let statements = &body.statements;
    // What is given again later counts.
    let given: BTreeMap<(bool, usize), usize> = starts
        .iter()
        .enumerate()
        .map(|(row, start)| ((start.velocity, start.coordinate), row))
        .collect();
    let given = given
        .into_iter()
        .filter_map(|((velocity, coordinate), row)| {
            let start = &starts[row];
            if !start.held && subject.mechanism.graph.is_zero(start.value) {
                return None;
            }
            let (place, held) = (Literal::usize_unsuffixed(coordinate), start.held);
            let array = if velocity { quote!(v) } else { quote!(q) };
            let value = body.output(Slot::of_vector("start", row));
            Some(quote!(start.#array[#place] = Initial { value: #value, held: #held };))
        });
    let given: TokenStream = given.collect();
    let guesses = quote!(Start { q: [guess; #n], v: [guess; #n] });
    let start = match given.is_empty() {
        true => guesses,
        false => quote!(let mut start = #guesses; #given start),
    };
    quote! {
        fn start(&self) -> Start<T, #n> {
            #statements
            let guess = Initial { value: T::zero(), held: false };
            #start
        }
    }
}

fn draw(subject: &Subject) -> TokenStream {
    let n = subject.sizes().0;
    let shapes = &subject.mechanism.shapes;
    if shapes.is_empty() {
        return quote!(fn draw(&self, _state: &State<T, #n>, _canvas: &mut dyn Canvas<T>) {});
    }
    let Written { body, state, .. } = subject.on_request(&subject.programs.draw);
    let statements = &body.statements;
    let mut numbers = (0..).map(|row| body.output(Slot::of_vector("draw", row)));
    let mut take = || numbers.next().unwrap_or_default();
    let calls: TokenStream = shapes.iter().map(|shape| call(shape, &mut take)).collect();
    quote! {
        fn draw(&self, #state: &State<T, #n>, canvas: &mut dyn Canvas<T>) {
            #statements
            #calls
        }
    }
}

/// The call that draws a shape; takes its numbers in the order of [`Shape::numbers`].
fn call(shape: &Shape, take: &mut dyn FnMut() -> TokenStream) -> TokenStream {
    let mut point = |_: &Point| {
        let [x, y, z] = [take(), take(), take()];
        quote!([#x, #y, #z])
    };
    match shape {
        Shape::Line(points) => {
            let points = points.iter().map(&mut point);
            quote!(canvas.line(&[#(#points),*]);)
        }
        Shape::Polygon(points) => {
            let points = points.iter().map(&mut point);
            quote!(canvas.polygon(&[#(#points),*]);)
        }
        Shape::Trace(at) => {
            let at = point(at);
            quote!(canvas.trace(#at);)
        }
        Shape::Circle(centre, _) => {
            let centre = point(centre);
            let radius = take();
            quote!(canvas.circle(#centre, #radius);)
        }
    }
}
