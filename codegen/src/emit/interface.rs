//! `impl Interface`: parameters by place, start, outputs, events, the picture.

use super::described::described;
use super::{Subject, Written, outputs};
use crate::expr::ExprId;
use crate::model::{Point, Shape};
use crate::optimise::Slot;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// `impl Interface`, with the method of its derivatives, if there is one.
pub(super) fn interface(subject: &mut Subject, partials: &TokenStream) -> TokenStream {
    let n = subject.sizes().0;
    let (parameter, set_parameter) = parameters(subject);
    let set_input = set_input(subject);
    let start = start(subject);
    let outputs = outputs::outputs(subject);
    let signals = outputs::signals(subject);
    let events: Vec<ExprId> = subject.mechanism.events.iter().map(|e| e.value).collect();
    let events = list(subject, "events", &events);
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
            #partials
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
fn start(subject: &mut Subject) -> TokenStream {
    let n = subject.sizes().0;
    let entry = |(row, start): (usize, &crate::model::Start)| {
        (
            Slot {
                array: "start",
                row,
                column: 0,
            },
            start.value,
        )
    };
    let wanted: Vec<_> = subject
        .mechanism
        .starts
        .iter()
        .enumerate()
        .map(entry)
        .collect();
    let Written { body, .. } = subject.body(&wanted, &|_| None);
    let statements = &body.statements;
    let initial = |coordinate: usize, velocity: bool| {
        let given = subject.mechanism.starts.iter().enumerate();
        let found = given
            .rev()
            .find(|(_, s)| s.coordinate == coordinate && s.velocity == velocity);
        let (value, held) = match found {
            Some((row, start)) => (
                body.output(Slot {
                    array: "start",
                    row,
                    column: 0,
                }),
                start.held,
            ),
            None => (quote!(T::zero()), false),
        };
        quote!(Initial { value: #value, held: #held })
    };
    let count = subject.mechanism.coordinates.len();
    let positions = (0..count).map(|i| initial(i, false));
    let velocities = (0..count).map(|i| initial(i, true));
    quote! {
        fn start(&self) -> Start<T, #n> {
            #statements
            Start { q: [#(#positions),*], v: [#(#velocities),*] }
        }
    }
}

/// A method that writes a list of values into a slice, as many as there is room for.
pub(super) fn list(subject: &mut Subject, name: &'static str, entries: &[ExprId]) -> TokenStream {
    let n = subject.sizes().0;
    let name_token = proc_macro2::Ident::new(name, proc_macro2::Span::call_site());
    if entries.is_empty() {
        return quote!(fn #name_token(&self, _state: &State<T, #n>, _values: &mut [T]) {});
    }
    let slot = |row| Slot {
        array: name,
        row,
        column: 0,
    };
    let wanted: Vec<_> = entries
        .iter()
        .enumerate()
        .map(|(row, &e)| (slot(row), e))
        .collect();
    let Written {
        body, state, cost, ..
    } = subject.body(&wanted, &|_| None);
    let statements = &body.statements;
    let computed = (0..entries.len()).map(|row| body.output(slot(row)));
    quote! {
        #[doc = #cost]
        fn #name_token(&self, #state: &State<T, #n>, values: &mut [T]) {
            #statements
            let computed = [#(#computed),*];
            for (place, value) in values.iter_mut().zip(computed) {
                *place = value;
            }
        }
    }
}

fn draw(subject: &mut Subject) -> TokenStream {
    let n = subject.sizes().0;
    if subject.mechanism.shapes.is_empty() {
        return quote!(fn draw(&self, _state: &State<T, #n>, _canvas: &mut dyn Canvas<T>) {});
    }
    let shapes = subject.mechanism.shapes.clone();
    let numbers: Vec<ExprId> = shapes.iter().flat_map(coordinates).collect();
    let slot = |row| Slot {
        array: "draw",
        row,
        column: 0,
    };
    let wanted: Vec<_> = numbers
        .iter()
        .enumerate()
        .map(|(row, &e)| (slot(row), e))
        .collect();
    let Written { body, state, .. } = subject.body(&wanted, &|_| None);
    let statements = &body.statements;
    let mut next = 0..;
    let mut take = || body.output(slot(next.next().unwrap_or(usize::MAX)));
    let calls: TokenStream = shapes.iter().map(|shape| call(shape, &mut take)).collect();
    quote! {
        fn draw(&self, #state: &State<T, #n>, canvas: &mut dyn Canvas<T>) {
            #statements
            #calls
        }
    }
}

/// The numbers of a shape, in the order in which `call` takes them.
fn coordinates(shape: &Shape) -> Vec<ExprId> {
    match shape {
        Shape::Line(points) | Shape::Polygon(points) => points.concat(),
        Shape::Circle(centre, radius) => centre.iter().chain([radius]).copied().collect(),
        Shape::Trace(point) => point.to_vec(),
    }
}

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
