//! The equations of motion: the trait implementation.

use super::filling::{Heading, Method, begin, types};
use super::index::Target;
use super::linearised::linearised;
use super::name::ident;
use super::subject::{Subject, Written, cost_in_words, entry, entry_of_field};
use super::switches::switches;
use crate::optimise::{Optimised, Slot, Solved, Way, cost};
use proc_macro2::TokenStream;
use quote::quote;

const TERMS: &str = "Everything one acceleration needs: `M q̈ + r = p₁`, `A q̈ = p₂`.

| field | equation | shape | unit |
|---|---|---|---|
| `mass` | `M = ∂²T/∂q̇²` | `N × N` | kg for two lengths, kg·m², kg·m where an angle takes part |
| `force` | `p₁ = Q − C q̇ − h` | `N` | N for a length, N·m for an angle |
| `jacobian` | `A = ∂g/∂q` | `R × N` | unit of the row per unit of the coordinate |
| `bias` | `p₂ = −(Ȧ q̇ + ḃ)` | `R` | unit of the row per s² |";

const POSITION: &str =
    "Everything a projection needs: `A Δq = −g`, `A q̇ + b = 0`, in the metric `M`.

| field | equation | shape | unit |
|---|---|---|---|
| `mass` | `M = ∂²T/∂q̇²` | `N × N` | kg for two lengths, kg·m², kg·m where an angle takes part |
| `residual` | `g`; zero for velocity constraints | `R` | unit of the row |
| `jacobian` | `A = ∂g/∂q` | `R × N` | unit of the row per unit of the coordinate |
| `drift` | `b = ∂g/∂t` | `R` | unit of the row per s |";

/// What is said of an acceleration by a Schur complement.
const SCHUR: &str = "The acceleration where the constraints are regular: `M = L D Lᵀ`, then the
Schur complement `A M⁻¹ Aᵀ`.";

/// What is said of an acceleration by a single elimination.
const SADDLE: &str = "The acceleration where the constraints are regular: `[M Aᵀ; A 0] = L D Lᵀ`,
each multiplier after the coordinates of its row. The pivots of rows are bounds of those of
`A M⁻¹ Aᵀ` from below.";

/// What is said of an acceleration in velocities that bodies share.
const SHARED: &str = "The acceleration by one elimination in which the velocities of points that
bodies have in common are unknowns beside those of the coordinates: from body to body.";

const CORRECTION: &str =
    "The least corrections of position and velocity in the kinetic metric, where
the constraints are regular.";

/// `impl Mechanism`.
pub(super) fn mechanism(subject: &Subject) -> TokenStream {
    let (n, r) = subject.sizes();
    let methods = methods(subject);
    let called = methods.iter().map(|method| &method.functions);
    let called: TokenStream = called.cloned().collect();
    let methods = methods.iter().map(|method| &method.method);
    let start = super::start::begin(subject);
    let energy = energy(subject);
    let linearised = linearised(subject);
    let switches = switches(subject);
    let name = subject.type_name();
    let functions = (!called.is_empty()).then(|| quote!(impl<T: Real> #name<T> { #called }));
    quote! {
        impl<T: Real> Mechanism<T, #n, #r> for #name<T> {
            fn structure(&self) -> &'static Structure {
                &STRUCTURE
            }
            #(#methods)*
            #start
            #energy
            #linearised
            #switches
        }

        #functions
    }
}

/// The methods that fill buffers.
fn methods(subject: &Subject) -> Vec<Method> {
    let programs = subject.programs;
    let mut methods = vec![filled(subject, ["terms", "Terms", TERMS], &programs.terms)];
    if let Some(solved) = &programs.acceleration {
        let docs = match solved.way {
            Way::Schur => SCHUR,
            Way::Saddle => SADDLE,
            Way::Shared => SHARED,
        };
        methods.push(solution(
            subject,
            ["acceleration", "Acceleration", docs],
            solved,
        ));
    }
    if let Some(terms) = &programs.position {
        methods.push(filled(subject, ["position", "Position", POSITION], terms));
    }
    if let Some(solved) = &programs.correction {
        let heading = ["correction", "Correction", CORRECTION];
        methods.push(solution(subject, heading, solved));
    }
    methods
}

/// A method that fills the fields of a buffer with arrays of their names; the mass matrix
/// by a function of its own, if there is one. Where a buffer has to be begun, the method ends with
/// a call of the function that begins it, which calls the method once more: so nothing is kept
/// during a call that is hardly ever made.
fn filled(subject: &Subject, [name, buffer, docs]: [&str; 3], computed: &Optimised) -> Method {
    let mut program = computed.program.clone();
    let statements = begin(subject, &mut program, &entry_of_field);
    let (method, first) = (ident(name), ident(&format!("begin_{name}")));
    let [state_type, out_type] = types(subject, buffer);
    let by_columns = subject.programs.inertia.is_some();
    let mass = by_columns.then(|| quote!(self.write_mass(state, &mut out.mass);));
    let ends_here = (by_columns || !program.is_empty()).then(|| quote!(return));
    let heading = Heading {
        name,
        buffer,
        docs,
        cost: cost_in_words(computed),
        before: quote! {
            if !out.is_filled_by(&STRUCTURE) {
                #ends_here self.#first(state, out);
            }
            #mass
        },
        solves: false,
        divisible: false,
    };
    let mut filled = Method::of(subject, &heading, &program, &entry_of_field);
    filled.functions.extend(quote! {
        /// Writes what does not change, and everything else after that.
        #[cold]
        #[inline(never)]
        fn #first(&self, state: &#state_type, out: &mut #out_type) {
            #statements
            self.#method(state, out);
        }
    });
    filled
}

/// A method that solves where the constraints are regular.
fn solution(subject: &Subject, [name, buffer, docs]: [&str; 3], solved: &Solved) -> Method {
    let heading = Heading {
        name,
        buffer,
        docs,
        // What it costs includes what it solves.
        cost: format!(" Costs {}.", cost(&solved.program)),
        before: TokenStream::new(),
        solves: true,
        // From body to body, values are read soon after they are computed, and compilers take a
        // straight line as it is.
        divisible: solved.way != Way::Shared,
    };
    Method::of(subject, &heading, &solved.program, &entry_of_solution)
}

/// Where a solve writes an entry; pivots have a struct of their own.
fn entry_of_solution(target: &Target) -> Option<TokenStream> {
    let field = ident(target.array);
    let array = match target.array {
        "mass_pivots" | "mass_diagonal" | "row_pivots" | "row_squares" => {
            quote!(out.pivots.#field)
        }
        _ => quote!(out.#field),
    };
    Some(entry(array, target))
}

fn energy(subject: &Subject) -> TokenStream {
    let Written {
        body, state, cost, ..
    } = subject.on_request(&subject.programs.energy);
    let slots = [0, 1, 2, 3].map(|row| Slot::of_vector("energy", row));
    let [kinetic, potential, balance, power] = slots.map(|slot| body.output(slot));
    let (statements, n) = (&body.statements, subject.sizes().0);
    quote! {
        /// Energies and the power supplied from outside.
        ///
        #[doc = #cost]
        fn energy(&self, #state: &State<T, #n>) -> Energy<T> {
            #statements
            Energy { kinetic: #kinetic, potential: #potential, balance: #balance, power: #power }
        }
    }
}
