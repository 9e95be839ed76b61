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
mod described;
mod dynamics;
mod function;
mod imports;
mod interface;
mod linearised;
mod literal;
mod name;
mod outputs;
mod start;
mod structure;
mod switches;
mod symbol;
mod write;

pub use c::c_header;
pub use write::{catalogue, render, write_if_changed};

use crate::derive::Equations;
use crate::expr::Symbol;
use crate::model::Mechanism;
use crate::optimise::{Optimised, Program, Programs, Slot, Solved, cost};
use function::{Body, Decided, Place};
use imports::imports;
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use symbol::SymbolNames;

/// What to emit besides the necessary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Emit the Coriolis matrix `C` as a function of its own.
    pub coriolis_matrix: bool,
    /// The constraints are declared to be regular: runs end with an error where they are
    /// not.
    pub regular: bool,
    /// Emit the function by which a library hands the mechanism to programs in C.
    pub c_interface: bool,
}

/// A description in its own words, for the emitted documentation.
#[derive(Clone, Copy, Debug)]
pub struct Origin<'a> {
    /// The module's name: the stem of the description's file.
    pub module: &'a str,
    /// The description's file, as given to the generator.
    pub file: &'a str,
    /// The description.
    pub source: &'a str,
    /// Parameters that were frozen, with their values.
    pub frozen: &'a [String],
}

/// Everything the emitter looks at.
struct Subject<'a> {
    mechanism: &'a Mechanism,
    equations: &'a Equations,
    programs: &'a Programs,
    names: SymbolNames,
    file: &'a str,
    options: Options,
}

/// A function body and what its signature needs to know.
struct Written {
    body: Body,
    /// `state`, or `_state` where the body does not read it.
    state: Ident,
    /// What it costs, in words.
    cost: String,
}

/// Which arguments beside the state a program reads or writes.
struct Reads {
    acceleration: bool,
    multiplier: bool,
    /// The buffer of its results.
    out: bool,
}

impl Reads {
    fn of(program: &Program) -> Self {
        Self {
            acceleration: program.reads(|symbol| matches!(symbol, Symbol::Acceleration(_))),
            multiplier: program.reads(|symbol| matches!(symbol, Symbol::Multiplier(_))),
            out: !program.outputs.is_empty(),
        }
    }
}

/// The name of an argument, or that it is not read.
fn argument(name: &str, read: bool) -> Ident {
    match read {
        true => Ident::new(name, Span::call_site()),
        false => Ident::new(&format!("_{name}"), Span::call_site()),
    }
}

/// The module of a mechanism, from the programs that it runs.
pub fn module(
    mechanism: &Mechanism,
    equations: &Equations,
    programs: &Programs,
    origin: Origin,
    options: Options,
) -> TokenStream {
    let subject = Subject {
        mechanism,
        equations,
        programs,
        names: SymbolNames::of(mechanism),
        file: origin.file,
        options,
    };
    let docs = module_docs(&subject, origin);
    let module = Ident::new(&module_name(origin.module), Span::call_site());
    let imports = imports(&subject);
    let source = origin.source;
    let structure = structure::structure(&subject);
    let conditions = switches::table(&subject);
    let parameters = structure::parameters(&subject);
    let inputs = structure::inputs(&subject);
    let holder = holder(&subject);
    let dynamics = dynamics::mechanism(&subject);
    let arrays = arrays::arrays(&subject);
    let start_equations = start::equations(&subject);
    let interface = interface::interface(&subject);
    let export = options
        .c_interface
        .then(|| c::export(mechanism, origin.module));
    quote! {
        #(#[doc = #docs])*
        pub mod #module {
            #imports

            /// The description that this module was generated from.
            pub const SOURCE: &str = #source;

            #structure
            #conditions
            #parameters
            #inputs
            #holder
            #dynamics
            #arrays
            #start_equations
            #interface
        }

        #export
    }
}

/// The name of the module of a description whose file has this stem.
pub fn module_name(stem: &str) -> String {
    name::snake_case(stem)
}

/// The name of the struct of a mechanism with this name.
pub fn type_name(name: &str) -> String {
    name::camel_case(name)
}

fn module_docs(subject: &Subject, origin: Origin) -> Vec<String> {
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
        origin.file
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
    if !origin.frozen.is_empty() {
        lines.extend([
            String::new(),
            format!(
                " Parameters frozen at their defaults: `{}`.",
                origin.frozen.join("`, `")
            ),
        ]);
    }
    if let Some(left_out) = linearised::docs(subject) {
        lines.extend([String::new(), left_out.to_string()]);
    }
    lines
}

/// The lines of a text as the lines of a doc comment.
fn doc_lines(text: &str) -> Vec<String> {
    let line = |line: &str| {
        if line.is_empty() {
            String::new()
        } else {
            format!(" {line}")
        }
    };
    text.lines().map(|text| line(text.trim())).collect()
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

impl Subject<'_> {
    /// `N` and `R`.
    fn counts(&self) -> (usize, usize) {
        (self.equations.mass.len(), self.equations.jacobian.len())
    }

    /// `N` and `R` as literals.
    fn sizes(&self) -> (Literal, Literal) {
        let (n, r) = self.counts();
        (Literal::usize_unsuffixed(n), Literal::usize_unsuffixed(r))
    }

    fn type_name(&self) -> Ident {
        Ident::new(&type_name(&self.mechanism.name), Span::call_site())
    }

    /// A symbol as the description names it.
    fn text(&self, symbol: Symbol) -> String {
        self.mechanism.symbol_text(symbol)
    }

    /// The body of a function whose outputs are assigned by whoever asks for it.
    fn body(&self, computed: &Optimised) -> Written {
        self.optimised(computed, &|_| None, Decided::ByState)
    }

    /// The body that runs a program; says what it costs, and what it would as derived.
    fn optimised(&self, computed: &Optimised, place: Place, decided: Decided) -> Written {
        let Optimised {
            program,
            cost,
            derived,
        } = computed;
        let cost = match derived == cost {
            true => format!(" Costs {cost}."),
            false => format!(" Costs {cost}. As derived: {derived}."),
        };
        self.written(program, place, decided, cost)
    }

    /// The body that solves; what it costs includes what it solves.
    fn solved(&self, solved: &Solved, place: Place) -> Written {
        let cost = format!(" Costs {}.", cost(&solved.program));
        self.written(&solved.program, place, Decided::BySides, cost)
    }

    fn written(&self, program: &Program, place: Place, decided: Decided, cost: String) -> Written {
        let taken = self.names.taken.clone();
        Written {
            body: Body::of(program, &self.names, taken, place, decided),
            state: argument("state", SymbolNames::reads_state(program)),
            cost,
        }
    }
}

/// An entry of an array. Arrays are indexed by literals below nalgebra's own indexing, so
/// the compiler checks the bounds.
fn entry(array: TokenStream, slot: &Slot) -> TokenStream {
    let row = Literal::usize_unsuffixed(slot.row);
    let column = Literal::usize_unsuffixed(slot.column);
    quote!(#array.data.0[#column][#row])
}

/// An entry of the buffer's field of the array's name.
fn entry_of_field(slot: &Slot) -> Option<TokenStream> {
    let field = Ident::new(slot.array, Span::call_site());
    Some(entry(quote!(out.#field), slot))
}
