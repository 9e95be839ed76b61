//! Programs to Rust: one module for each mechanism.
//!
//! In:  a mechanism and its equations.
//! Out: a module that holds the mechanism's struct, its parameters and inputs, the
//!      implementations of the runtime's traits, and a function for each array.
//!
//! Not here: mathematics. What is computed was decided by `optimise`.

mod angles;
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
mod partials;
mod start;
mod structure;
mod switches;
mod symbol;
mod write;

pub use c::c_header;
pub use write::{catalogue, render, write_if_changed};

use crate::derive::Equations;
use crate::expr::{ExprId, Symbol};
use crate::model::Mechanism;
use crate::optimise::{Cost, Polynomials, Program, Slot, cost, derived_cost, optimise_among};
use function::{Body, Decided, Place};
use imports::{imports, mentions};
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
    mechanism: &'a mut Mechanism,
    equations: &'a Equations,
    polynomials: Polynomials,
    /// What was wanted last, and its program: two functions follow one another that
    /// compute the same.
    last: (Vec<(Slot, ExprId)>, Program),
    names: SymbolNames,
    file: &'a str,
    options: Options,
}

/// A method of an emitted struct that computes arrays.
struct Method {
    docs: &'static str,
    name: &'static str,
    /// The type of the buffer, or of the result.
    buffer: TokenStream,
    wanted: Vec<(Slot, ExprId)>,
}

/// A function body and what its signature needs to know.
struct Written {
    body: Body,
    /// No output differs from zero.
    is_zero: bool,
    /// `state`, or `_state` where the body does not read it.
    state: Ident,
    counts: Cost,
    /// What it costs, in words.
    cost: String,
}

/// Said of a mechanism whose linearisation is too long.
const LEFT_OUT: &str = " The linearised equations of motion would be too long and are left out: \
                        implicit integrators take differences.";

/// The module of a mechanism.
pub fn module(
    mechanism: &mut Mechanism,
    equations: &Equations,
    origin: Origin,
    options: Options,
) -> TokenStream {
    let names = SymbolNames::of(mechanism);
    let mut subject = Subject {
        mechanism,
        equations,
        polynomials: Polynomials::default(),
        last: (Vec::new(), Program::default()),
        names,
        file: origin.file,
        options,
    };
    let parameters = structure::parameters(&subject);
    let inputs = structure::inputs(&subject);
    let structure = structure::structure(&subject);
    let holder = holder(&subject);
    let dynamics = dynamics::mechanism(&mut subject);
    let functions = dynamics::functions(&mut subject);
    let start_equations = start::equations(&mut subject);
    let has_slopes = mentions(&dynamics, "linearised");
    let partials = match options.c_interface && has_slopes {
        true => partials::partials(&mut subject),
        false => TokenStream::new(),
    };
    let interface = interface::interface(&mut subject, &partials);
    let conditions = switches::table(&subject);
    let imports = imports(&subject, &quote!(#dynamics #partials));
    let mut docs = module_docs(&subject, origin);
    if !has_slopes {
        docs.extend([String::new(), LEFT_OUT.to_string()]);
    }
    let module = Ident::new(&module_name(origin.module), Span::call_site());
    let source = origin.source;
    let export = options
        .c_interface
        .then(|| c::export(subject.mechanism, origin.module));
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
            #functions
            #start_equations
            #interface
        }

        #export
    }
}

/// Whether a module provides the derivatives that programs in other languages ask for.
pub fn is_differentiated(module: &TokenStream) -> bool {
    mentions(module, partials::KIND)
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
    } = &*subject.mechanism;
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

    /// Expressions of numbers alone, as values of `T`.
    fn constants(&self, expressions: Vec<ExprId>) -> Vec<TokenStream> {
        let slot = |row| Slot {
            array: "constant",
            row,
            column: 0,
        };
        let write = |(row, e): (usize, ExprId)| {
            let program = crate::optimise::plain(&self.mechanism.graph, &[(slot(row), e)]);
            let taken = self.names.taken.clone();
            let body = Body::of(&program, &self.names, taken, &|_| None, Decided::ByState);
            let (statements, value) = (&body.statements, body.output(slot(row)));
            if statements.is_empty() {
                value
            } else {
                quote!({ #statements #value })
            }
        };
        expressions.into_iter().enumerate().map(write).collect()
    }

    /// The default laws of the inputs.
    fn laws(&self) -> Vec<ExprId> {
        let inputs = self.mechanism.inputs.iter();
        inputs.map(|input| input.law).collect()
    }

    fn program(&mut self, wanted: &[(Slot, ExprId)]) -> Program {
        if self.last.0 != wanted {
            let laws = self.laws();
            let graph = &mut self.mechanism.graph;
            let program = optimise_among(graph, &mut self.polynomials, &laws, wanted);
            self.last = (wanted.to_vec(), program);
        }
        self.last.1.clone()
    }

    fn body(&mut self, wanted: &[(Slot, ExprId)], place: Place) -> Written {
        let program = self.program(wanted);
        self.beside_derived(wanted, self.written(&program, place, Decided::ByState))
    }

    /// Says besides what the program would cost as it was derived.
    fn beside_derived(&self, wanted: &[(Slot, ExprId)], mut written: Written) -> Written {
        let derived = derived_cost(&self.mechanism.graph, &self.laws(), wanted);
        if derived != written.counts {
            written.cost = format!("{} As derived: {derived}.", written.cost);
        }
        written
    }

    fn written(&self, program: &Program, place: Place, decided: Decided) -> Written {
        let taken = self.names.taken.clone();
        let body = Body::of(program, &self.names, taken, place, decided);
        let state = if SymbolNames::reads_state(program) {
            "state"
        } else {
            "_state"
        };
        Written {
            is_zero: program.outputs.is_empty(),
            state: Ident::new(state, Span::call_site()),
            counts: cost(program),
            cost: format!(" Costs {}.", cost(program)),
            body,
        }
    }

    /// A method that fills a buffer whose fields are the arrays wanted.
    fn method(&mut self, method: Method) -> TokenStream {
        let Method {
            docs,
            name,
            buffer,
            wanted,
        } = method;
        let program = self.program(&wanted);
        let written = self.written(&program, &entry_of_field, Decided::BySides);
        let Written {
            body: Body { statements, .. },
            is_zero,
            state,
            cost,
            ..
        } = self.beside_derived(&wanted, written);
        let out = if is_zero { "_out" } else { "out" };
        let out = Ident::new(out, Span::call_site());
        let (docs, name) = (doc_lines(docs), Ident::new(name, Span::call_site()));
        let n = self.sizes().0;
        quote! {
            #(#[doc = #docs])*
            ///
            #[doc = #cost]
            fn #name(&self, #state: &State<T, #n>, #out: &mut #buffer) {
                #statements
            }
        }
    }

    /// A public function that returns an array.
    fn returning(&mut self, method: Method) -> TokenStream {
        let Method {
            docs,
            name,
            buffer,
            wanted,
        } = method;
        let Written {
            body: Body { statements, .. },
            is_zero,
            state,
            cost,
            ..
        } = self.body(&wanted, &|slot| Some(entry(quote!(out), slot)));
        let (docs, name) = (doc_lines(docs), Ident::new(name, Span::call_site()));
        let n = self.sizes().0;
        let kind = if buffer.to_string().starts_with("SVector") {
            quote!(SVector)
        } else {
            quote!(SMatrix)
        };
        let result = if is_zero {
            quote!(#kind::zeros())
        } else {
            quote!(let mut out = #kind::zeros(); #statements out)
        };
        quote! {
            #(#[doc = #docs])*
            ///
            #[doc = #cost]
            pub fn #name(&self, #state: &State<T, #n>) -> #buffer {
                #result
            }
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
