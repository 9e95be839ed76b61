//! What the emitter looks at, and what all parts of a module are written with.

use super::function::{Body, Decided, Place, Words};
use super::index::{Index, Target};
use super::loops::Loops;
use super::name::{camel_case, ident};
use super::symbol::SymbolNames;
use crate::derive::Equations;
use crate::model::{Mechanism, Symbol};
use crate::optimise::{Optimised, Program, Programs};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use rustc_hash::FxHashMap;

/// The most operations of a function in which what comes again is no loop, unless another number is
/// asked for: those of a row of 40 parallelograms. Beyond, loops are faster on all processors, and
/// from 3,000 on on those that are not allowed to fuse products with sums (`docs/instructions.md`).
const UNROLLED: usize = 8_000;
/// The most operations without loops of a function that no step of a run calls: whether anyone
/// calls it or not, compilers look at all of it.
const UNROLLED_ON_REQUEST: usize = 1_000;

/// When a function is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Called {
    /// In each step of a run.
    InSteps,
    /// When somebody asks for it.
    OnRequest,
}

/// What to emit besides the necessary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct EmitOptions {
    /// Emit the Coriolis matrix `C` as a function of its own.
    pub coriolis_matrix: bool,
    /// The constraints are declared to be regular: runs end with an error where they are
    /// not.
    pub assumed_regular: bool,
    /// Emit the function by which a library hands the mechanism to programs in C.
    pub c_interface: bool,
    /// The most operations of a function in which what comes again is no loop: 8,000 unless it
    /// is given.
    pub unrolled: Option<usize>,
    /// The most operations of a function without loops that is one straight line: 20,000 unless
    /// it is given.
    pub straight_line: Option<usize>,
}

/// What a module is made from, for the emitted documentation.
#[derive(Clone, Copy, Debug)]
pub struct Provenance<'a> {
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
pub(super) struct Subject<'a> {
    pub mechanism: &'a Mechanism,
    pub equations: &'a Equations,
    pub programs: &'a Programs,
    pub names: SymbolNames,
    pub file: &'a str,
    pub options: EmitOptions,
}

/// A function body and what its signature needs to know.
pub(super) struct Written {
    pub body: Body,
    /// `state`, or `_state` where the body does not read it.
    pub state: Ident,
    /// `acceleration`, or `_acceleration` where the body does not read it.
    pub acceleration: Ident,
    /// What it costs, in words.
    pub cost: String,
}

/// Which arguments beside the state a program reads or writes.
pub(super) struct Reads {
    acceleration: bool,
    pub multiplier: bool,
    /// The buffer of its results.
    pub out: bool,
}

impl Reads {
    pub fn of(program: &Program) -> Self {
        Self {
            acceleration: program.reads(|symbol| matches!(symbol, Symbol::Acceleration(_))),
            multiplier: program.reads(|symbol| matches!(symbol, Symbol::Multiplier(_))),
            out: !program.outputs.is_empty(),
        }
    }
}

/// The name of an argument, or that it is not read.
pub(super) fn argument(name: &str, read: bool) -> Ident {
    match read {
        true => ident(name),
        false => ident(&format!("_{name}")),
    }
}

/// The lines of a text as the lines of a doc comment.
pub(super) fn doc_lines(text: &str) -> Vec<String> {
    let line = |line: &str| {
        if line.is_empty() {
            String::new()
        } else {
            format!(" {line}")
        }
    };
    text.lines().map(|text| line(text.trim())).collect()
}

impl Subject<'_> {
    /// `N` and `R`.
    pub fn counts(&self) -> (usize, usize) {
        self.equations.sizes()
    }

    /// `N` and `R` as literals.
    pub fn sizes(&self) -> (Literal, Literal) {
        let (n, r) = self.counts();
        (Literal::usize_unsuffixed(n), Literal::usize_unsuffixed(r))
    }

    pub fn type_name(&self) -> Ident {
        ident(&camel_case(&self.mechanism.name))
    }

    /// A symbol as the description names it.
    pub fn text(&self, symbol: Symbol) -> String {
        self.mechanism.symbol_text(symbol)
    }

    /// The body of a function whose outputs are assigned by whoever asks for it.
    pub fn body(&self, computed: &Optimised, (decided, called): (Decided, Called)) -> Written {
        let program = &computed.program;
        let loops = self.loops(program, decided, called);
        let body = match loops.filter(|_| program.is_list()) {
            Some(loops) => body_of_list(program, loops),
            None => self.straight(program, &|_| None, decided),
        };
        self.with_arguments(computed, body)
    }

    /// The body of a function that somebody asks for, which the state decides.
    pub fn on_request(&self, computed: &Optimised) -> Written {
        self.body(computed, (Decided::ByState, Called::OnRequest))
    }

    /// The body that runs a program; says what it costs, and what it would cost as derived.
    pub fn optimised(
        &self,
        computed: &Optimised,
        place: Place,
        (decided, called): (Decided, Called),
    ) -> Written {
        let program = &computed.program;
        let body = match self.loops(program, decided, called) {
            Some(loops) => Body::new(loops.statements(place), FxHashMap::default()),
            None => self.straight(program, place, decided),
        };
        self.with_arguments(computed, body)
    }

    /// A body without loops.
    pub fn straight(&self, program: &Program, place: Place, decided: Decided) -> Body {
        Body::of(program, self.words(decided), place)
    }

    /// The words of its functions.
    pub fn words(&self, decided: Decided) -> Words<'_> {
        Words {
            symbols: &self.names,
            names: self.names.taken.clone(),
            decided,
        }
    }

    fn with_arguments(&self, computed: &Optimised, body: Body) -> Written {
        let program = &computed.program;
        Written {
            body,
            state: argument("state", SymbolNames::reads_state(program)),
            acceleration: argument("acceleration", Reads::of(program).acceleration),
            cost: cost_in_words(computed),
        }
    }

    /// The loops of a program, if it is long and they make it much shorter.
    pub fn loops(&self, program: &Program, decided: Decided, called: Called) -> Option<Loops<'_>> {
        let length = program.len() + program.outputs.len();
        let unrolled = self.options.unrolled.unwrap_or(UNROLLED);
        let straight = match called {
            Called::InSteps => unrolled,
            Called::OnRequest => unrolled.min(UNROLLED_ON_REQUEST),
        };
        (length > straight).then(|| Loops::of(program, self.words(decided)))?
    }
}

/// The body of a function with loops that writes a list, an array `out`.
fn body_of_list(program: &Program, loops: Loops) -> Body {
    let entry = |row: Index| quote!(out[#row]);
    let rows = program.outputs.iter().map(|(slot, _)| slot.row);
    let count = Literal::usize_unsuffixed(rows.max().map_or(0, |last| last + 1));
    let statements = loops.statements(&|target| Some(entry(target.row)));
    let outputs = program.outputs.iter();
    let outputs = outputs.map(|(slot, _)| (*slot, entry(Index::fixed(slot.row))));
    Body::new(
        quote!(let mut out = [T::zero(); #count]; #statements),
        outputs.collect(),
    )
}

/// What a program costs, and what it would cost as derived.
pub(super) fn cost_in_words(computed: &Optimised) -> String {
    let Optimised { cost, derived, .. } = computed;
    match derived == cost {
        true => format!(" Costs {cost}."),
        false => format!(" Costs {cost}. As derived: {derived}."),
    }
}

/// An entry of an array. Arrays are indexed by literals below nalgebra's own indexing, so
/// the compiler checks the bounds.
pub(super) fn entry(array: TokenStream, Target { row, column, .. }: &Target) -> TokenStream {
    quote!(#array.data.0[#column][#row])
}

/// An entry of the buffer's field of the array's name.
pub(super) fn entry_of_field(target: &Target) -> Option<TokenStream> {
    let field = ident(target.array);
    Some(entry(quote!(out.#field), target))
}
