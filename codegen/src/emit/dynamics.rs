//! The equations of motion: the trait implementation, and the separate functions.

use super::function::{Body, Decided};
use super::linearised::{argument, linearised};
use super::switches::switches;
use super::{Method, Subject, Written, doc_lines, entry};
use crate::derive::coriolis_matrix;
use crate::expr::ExprId;
use crate::optimise::{Slot, Way, regular_acceleration, regular_correction};
use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;

/// What is said of an acceleration by a Schur complement.
const SCHUR: &str = "The acceleration where the constraints are regular: `M = L D Lᵀ`, then the
Schur complement `A M⁻¹ Aᵀ`.";

/// What is said of one by a single elimination.
const SADDLE: &str = "The acceleration where the constraints are regular: `[M Aᵀ; A 0] = L D Lᵀ`,
each multiplier after the coordinates of its row. The pivots of rows are bounds of those of
`A M⁻¹ Aᵀ` from below.";

/// An entry wanted of an array.
type Wanted = Vec<(Slot, ExprId)>;

fn vector(array: &'static str, entries: &[ExprId]) -> Wanted {
    let slot = |(row, &e)| {
        (
            Slot {
                array,
                row,
                column: 0,
            },
            e,
        )
    };
    entries.iter().enumerate().map(slot).collect()
}

/// Column by column, as nalgebra stores it.
pub(super) fn matrix(array: &'static str, rows: &[Vec<ExprId>]) -> Wanted {
    let columns = rows.first().map_or(0, Vec::len);
    let entry = |column| {
        rows.iter()
            .enumerate()
            .map(move |(row, entries)| (row, entries[column], column))
    };
    (0..columns)
        .flat_map(entry)
        .map(|(row, e, column)| (Slot { array, row, column }, e))
        .collect()
}

/// `impl Mechanism`.
pub(super) fn mechanism(subject: &mut Subject) -> TokenStream {
    let (n, r) = subject.sizes();
    let equations = subject.equations;
    let mut wanted = matrix("mass", &equations.mass);
    wanted.extend(vector("force", &equations.force));
    wanted.extend(matrix("jacobian", &equations.jacobian));
    wanted.extend(vector("bias", &equations.bias));
    let regular = regular(subject, &wanted);
    let terms = subject.method(Method {
        docs: "Everything one acceleration needs: `M q̈ + r = p₁`, `A q̈ = p₂`.

| field | equation | shape | unit |
|---|---|---|---|
| `mass` | `M = ∂²T/∂q̇²` | `N × N` | kg for two lengths, kg·m², kg·m where an angle takes part |
| `force` | `p₁ = Q − C q̇ − h` | `N` | N for a length, N·m for an angle |
| `jacobian` | `A = ∂g/∂q` | `R × N` | unit of the row per unit of the coordinate |
| `bias` | `p₂ = −(Ȧ q̇ + ḃ)` | `R` | unit of the row per s² |",
        name: "terms",
        buffer: quote!(Terms<T, #n, #r>),
        wanted,
    });
    let closure = if equations.jacobian.is_empty() {
        TokenStream::new()
    } else {
        closure(subject)
    };
    let energy = energy(subject);
    let linearised = linearised(subject);
    let begin = super::start::begin(subject);
    let switches = switches(subject);
    let name = subject.type_name();
    quote! {
        impl<T: Real> Mechanism<T, #n, #r> for #name<T> {
            fn structure(&self) -> &'static Structure {
                &STRUCTURE
            }
            #terms
            #regular
            #closure
            #begin
            #energy
            #linearised
            #switches
        }
    }
}

/// The acceleration by the regular path.
fn regular(subject: &mut Subject, terms: &Wanted) -> TokenStream {
    let (sizes, weighed) = (subject.counts(), &subject.equations.weighed);
    let Some(solved_by) = regular_acceleration(&subject.program(terms), sizes, weighed) else {
        return TokenStream::new();
    };
    let docs = match solved_by.way {
        Way::Schur => doc_lines(SCHUR),
        Way::Saddle => doc_lines(SADDLE),
    };
    let Written {
        body: Body { statements, .. },
        state,
        cost,
        ..
    } = subject.written(&solved_by.program, &solved, Decided::BySides);
    let out = argument("out", &statements);
    let (n, r) = subject.sizes();
    quote! {
        #(#[doc = #docs])*
        ///
        #[doc = #cost]
        #[inline(always)]
        fn regular(&self, #state: &State<T, #n>, #out: &mut Regular<T, #n, #r>) -> bool {
            #statements
            true
        }
    }
}

/// The projection step by the regular path.
fn correction(subject: &mut Subject) -> TokenStream {
    let equations = subject.equations;
    let mut wanted = matrix("mass", &equations.mass);
    wanted.extend(matrix("jacobian", &equations.jacobian));
    wanted.extend(vector("residual", &equations.residual));
    wanted.extend(vector("speed", &equations.speed));
    wanted.extend(matrix("turn", &equations.turn));
    let (sizes, weighed) = (subject.counts(), &equations.weighed);
    let Some(solved_by) = regular_correction(&subject.program(&wanted), sizes, weighed) else {
        return TokenStream::new();
    };
    let Written {
        body: Body { statements, .. },
        state,
        cost,
        ..
    } = subject.written(&solved_by.program, &solved, Decided::BySides);
    let out = argument("out", &statements);
    let (n, r) = subject.sizes();
    quote! {
        /// The least corrections of position and velocity in the kinetic metric, where
        /// the constraints are regular.
        ///
        #[doc = #cost]
        #[inline(always)]
        fn correction(&self, #state: &State<T, #n>, #out: &mut Correction<T, #n, #r>) -> bool {
            #statements
            true
        }
    }
}

/// Where a solve writes an entry; pivots have a struct of their own.
fn solved(slot: &Slot) -> Option<TokenStream> {
    let field = Ident::new(slot.array, Span::call_site());
    let array = match slot.array {
        "mass_pivots" | "mass_diagonal" | "row_pivots" | "row_squares" => {
            quote!(out.pivots.#field)
        }
        _ => quote!(out.#field),
    };
    Some(entry(array, slot))
}

/// What a mechanism with constraints provides besides.
fn closure(subject: &mut Subject) -> TokenStream {
    let (n, r) = subject.sizes();
    let equations = subject.equations;
    let mut wanted = matrix("mass", &equations.mass);
    wanted.extend(vector("residual", &equations.residual));
    wanted.extend(matrix("jacobian", &equations.jacobian));
    wanted.extend(vector("drift", &equations.drift));
    let position = subject.method(Method {
        docs: "Everything a projection needs: `A Δq = −g`, `A q̇ + b = 0`, in the metric `M`.

| field | equation | shape | unit |
|---|---|---|---|
| `mass` | `M = ∂²T/∂q̇²` | `N × N` | kg for two lengths, kg·m², kg·m where an angle takes part |
| `residual` | `g`; zero for velocity constraints | `R` | unit of the row |
| `jacobian` | `A = ∂g/∂q` | `R × N` | unit of the row per unit of the coordinate |
| `drift` | `b = ∂g/∂t` | `R` | unit of the row per s |",
        name: "position",
        buffer: quote!(Position<T, #n, #r>),
        wanted,
    });
    let correction = correction(subject);
    quote!(#position #correction)
}

fn energy(subject: &mut Subject) -> TokenStream {
    let energies = subject.equations.energies;
    let fields = [
        energies.kinetic,
        energies.potential,
        energies.balance,
        energies.power,
    ];
    let wanted = vector("energy", &fields);
    let written = subject.body(&wanted, &|_| None);
    let [kinetic, potential, balance, power] = [0, 1, 2, 3].map(|row| {
        written.body.output(Slot {
            array: "energy",
            row,
            column: 0,
        })
    });
    let (statements, state, cost) = (&written.body.statements, &written.state, &written.cost);
    let n = subject.sizes().0;
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

/// One public function for each array, for those who want it by itself.
pub(super) fn functions(subject: &mut Subject) -> TokenStream {
    let (n, r) = subject.sizes();
    let equations = subject.equations;
    let mut functions = vec![
        Method {
            docs: "Mass matrix `M = ∂²T/∂q̇²`, `N × N`, symmetric; kg for two lengths, kg·m² for two
angles, kg·m for one of each.",
            name: "mass_matrix",
            buffer: quote!(SMatrix<T, #n, #n>),
            wanted: matrix("", &equations.mass),
        },
        Method {
            docs: "Potential forces `h = ∂Π/∂q`, `N`; N for a length, N·m for an angle.",
            name: "potential_force",
            buffer: quote!(SVector<T, #n>),
            wanted: vector("", &equations.gravity),
        },
        Method {
            docs: "Applied and dissipative forces `Q`, `N`; N for a length, N·m for an angle.",
            name: "applied_force",
            buffer: quote!(SVector<T, #n>),
            wanted: vector("", &equations.applied),
        },
    ];
    functions.extend(coriolis(subject));
    if !equations.jacobian.is_empty() {
        functions.extend([
            Method {
                docs: "Constraints `g`, `R`, each in the unit it is written in; zero for velocity constraints.",
                name: "constraint_residual",
                buffer: quote!(SVector<T, #r>),
                wanted: vector("", &equations.residual),
            },
            Method {
                docs: "Constraint Jacobian `A = ∂g/∂q`, `R × N`; unit of the row per unit of the coordinate.",
                name: "constraint_jacobian",
                buffer: quote!(SMatrix<T, #r, #n>),
                wanted: matrix("", &equations.jacobian),
            },
            Method {
                docs: "`p₂ = −(Ȧ q̇ + ḃ)`, `R`: the constraints ask for `A q̈ = p₂`; unit of the row per s².",
                name: "constraint_bias",
                buffer: quote!(SVector<T, #r>),
                wanted: vector("", &equations.bias),
            },
        ]);
    }
    let functions: TokenStream = functions
        .into_iter()
        .map(|function| subject.returning(function))
        .collect();
    let name = subject.type_name();
    quote!(impl<T: Real> #name<T> { #functions })
}

/// `C q̇`, and `C` if it is asked for; nothing where `M` is constant and `T` has no
/// other term that brings one.
fn coriolis(subject: &mut Subject) -> Vec<Method> {
    let n = subject.sizes().0;
    let equations = subject.equations;
    let mut functions = Vec::new();
    if equations
        .coriolis
        .iter()
        .any(|e| !subject.mechanism.graph.is_zero(*e))
    {
        functions.push(Method {
            docs: "`C q̇` and the terms of moving frames, `d/dt ∂T/∂q̇ − M q̈ − ∂T/∂q`, `N`; N for a
length, N·m for an angle.",
            name: "coriolis_force",
            buffer: quote!(SVector<T, #n>),
            wanted: vector("", &equations.coriolis),
        });
    }
    if subject.options.coriolis_matrix {
        let rows = coriolis_matrix(&mut subject.mechanism.graph, &equations.mass);
        if rows
            .iter()
            .flatten()
            .any(|e| !subject.mechanism.graph.is_zero(*e))
        {
            functions.push(Method {
                docs: "Coriolis matrix `C` by Christoffel symbols, `N × N`: `Ṁ − 2C` is skew-symmetric; the
unit of `M` per s.",
                name: "coriolis_matrix",
                buffer: quote!(SMatrix<T, #n, #n>),
                wanted: matrix("", &rows),
            });
        }
    }
    functions
}
