//! One public function for each array, for those who want it by itself.
//!
//! In:  the programs of the arrays.
//! Out: functions that return them.

use super::columns::{MASS, columns};
use super::function::Decided;
use super::name::ident;
use super::subject::{Called, Reads, Subject, Written, doc_lines, entry};
use crate::optimise::{Array, Optimised};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

const CORIOLIS_FORCE: &str =
    "`C q̇` and the terms of moving frames, `d/dt ∂T/∂q̇ − M q̈ − ∂T/∂q`, `N`; N for a
length, N·m for an angle.";

const CORIOLIS_MATRIX: &str =
    "Coriolis matrix `C` by Christoffel symbols, `N × N`: `Ṁ − 2C` is skew-symmetric; the
unit of `M` per s.";

/// What nalgebra keeps an array in.
enum Shape {
    Vector(Literal),
    Matrix(Literal, Literal),
}

/// An array's documentation and shape.
struct Described {
    docs: &'static str,
    shape: Shape,
}

/// `impl` of the functions.
pub(super) fn arrays(subject: &Subject) -> TokenStream {
    let arrays = subject.programs.arrays.iter();
    let functions: TokenStream = arrays
        .map(|(array, computed)| function(subject, *array, computed))
        .collect();
    let mass = columns(subject);
    let name = subject.type_name();
    quote!(impl<T: Real> #name<T> { #mass #functions })
}

fn described(subject: &Subject, array: Array) -> Described {
    let (n, r) = subject.sizes();
    let (docs, shape) = match array {
        Array::Mass => (MASS, Shape::Matrix(n.clone(), n)),
        Array::PotentialForce => (
            "Potential forces `h = ∂Π/∂q`, `N`; N for a length, N·m for an angle.",
            Shape::Vector(n),
        ),
        Array::AppliedForce => (
            "Applied and dissipative forces `Q`, `N`; N for a length, N·m for an angle.",
            Shape::Vector(n),
        ),
        Array::CoriolisForce => (CORIOLIS_FORCE, Shape::Vector(n)),
        Array::CoriolisMatrix => (CORIOLIS_MATRIX, Shape::Matrix(n.clone(), n)),
        Array::Residual => (
            "Constraints `g`, `R`, each in the unit it is written in; zero for velocity constraints.",
            Shape::Vector(r),
        ),
        Array::Jacobian => (
            "Constraint Jacobian `A = ∂g/∂q`, `R × N`; unit of the row per unit of the coordinate.",
            Shape::Matrix(r, n),
        ),
        Array::Bias => (
            "`p₂ = −(Ȧ q̇ + ḃ)`, `R`: the constraints ask for `A q̈ = p₂`; unit of the row per s².",
            Shape::Vector(r),
        ),
    };
    Described { docs, shape }
}

fn function(subject: &Subject, array: Array, computed: &Optimised) -> TokenStream {
    let described = described(subject, array);
    let place = |target: &_| Some(entry(quote!(out), target));
    let Written {
        body, state, cost, ..
    } = subject.optimised(computed, &place, (Decided::ByState, Called::OnRequest));
    let (kind, sizes) = match described.shape {
        Shape::Vector(rows) => (quote!(SVector), quote!(#rows)),
        Shape::Matrix(rows, columns) => (quote!(SMatrix), quote!(#rows, #columns)),
    };
    let statements = body.statements;
    let result = match Reads::of(&computed.program).out {
        true => quote!(let mut out = #kind::zeros(); #statements out),
        false => quote!(#kind::zeros()),
    };
    let docs = doc_lines(described.docs);
    let name = ident(array.name());
    let n = subject.sizes().0;
    quote! {
        #(#[doc = #docs])*
        ///
        #[doc = #cost]
        pub fn #name(&self, #state: &State<T, #n>) -> #kind<T, #sizes> {
            #result
        }
    }
}
