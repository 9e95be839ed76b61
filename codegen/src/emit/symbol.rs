//! The names of a mechanism's symbols in emitted code, and the statements that
//! bring them into scope.

use super::function::Symbols;
use super::index::Index;
use super::name::Names;
use crate::model::{Mechanism, Quantity, Symbol};
use crate::optimise::Program;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use std::collections::BTreeSet;

/// Names that emitted bodies use for themselves.
const RESERVED: [&str; 12] = [
    "state",
    "out",
    "values",
    "canvas",
    "index",
    "value",
    "acceleration",
    "multiplier",
    "outputs",
    "inputs",
    "kept",
    "turn",
];

/// The entries of an array with at most so many are always named all at once.
const SHORT: usize = 64;
/// Those of a longer array are named one by one if there are more than so many for each one that is
/// read.
const FEW_OF: usize = 8;

/// Names of fields and of local variables.
pub(super) struct SymbolNames {
    /// Fields of the struct of parameters.
    pub parameter_fields: Vec<Ident>,
    /// Fields of the struct of inputs.
    pub input_fields: Vec<Ident>,
    time: Ident,
    coordinates: Vec<Ident>,
    velocities: Vec<Ident>,
    parameters: Vec<Ident>,
    accelerations: Vec<Ident>,
    multipliers: Vec<Ident>,
    weights: Vec<Ident>,
    follows: Vec<Ident>,
    /// The local names that are taken.
    pub taken: Names,
}

impl SymbolNames {
    /// Names for everything a mechanism declares.
    pub fn of(mechanism: &Mechanism) -> Self {
        let mut fields = Names::default();
        let mut input_names = Names::default();
        let mut taken = Names::reserving(&RESERVED);
        let time = taken.unique("t");
        let freedoms = mechanism.freedoms();
        let mut locals = |moving: &str, state: &str| -> Vec<Ident> {
            let all = mechanism.coordinates.iter().enumerate();
            let name = |(i, q): (usize, &Quantity)| match i < freedoms {
                true => taken.unique(&format!("{}{moving}", q.name)),
                false => taken.unique(&format!("{}{state}", q.name)),
            };
            all.map(name).collect()
        };
        let coordinates = locals("", "_integral");
        let velocities = locals("_dot", "");
        let accelerations = locals("_ddot", "_dot");
        let parameters: Vec<&str> = mechanism
            .parameters
            .iter()
            .map(|p| p.quantity.name.as_str())
            .collect();
        let inputs: Vec<&str> = mechanism
            .inputs
            .iter()
            .map(|input| input.quantity.name.as_str())
            .collect();
        let input_fields = input_names.all(&inputs);
        let parameter_names = parameters.iter().map(|name| taken.unique(name)).collect();
        let rows = 0..mechanism.constraints.len();
        let multipliers = rows
            .map(|row| taken.unique(&format!("lambda_{row}")))
            .collect();
        let rows = 0..mechanism.constraints.len();
        let weights = rows
            .map(|row| taken.unique(&format!("weight_{row}")))
            .collect();
        let follows = input_fields
            .iter()
            .map(|input| taken.unique(&format!("follows_{input}")))
            .collect();
        SymbolNames {
            parameter_fields: fields.all(&parameters),
            input_fields,
            time,
            coordinates,
            velocities,
            parameters: parameter_names,
            accelerations,
            multipliers,
            weights,
            follows,
            taken,
        }
    }

    /// Statements that bring symbols into scope.
    fn bindings(&self, used: &BTreeSet<Symbol>) -> TokenStream {
        let time = &self.time;
        let mut statements = TokenStream::new();
        if used.contains(&Symbol::Time) {
            statements.extend(quote!(let #time = state.t;));
        }
        let mut bind = |names: &[Ident], symbol: fn(u32) -> Symbol| {
            let array = array_of(symbol(0)).unwrap_or_default();
            let uses = |i: &usize| u32::try_from(*i).is_ok_and(|i| used.contains(&symbol(i)));
            let places: Vec<usize> = (0..names.len()).filter(uses).collect();
            statements.extend(entries(names, &places, &quote!(#array.data.0[0])));
        };
        bind(&self.coordinates, Symbol::Coordinate);
        bind(&self.velocities, Symbol::Velocity);
        bind(&self.accelerations, Symbol::Acceleration);
        bind(&self.multipliers, Symbol::Multiplier);
        bind(&self.weights, Symbol::Weight);
        statements.extend(self.parameter_prelude(used));
        statements.extend(self.follows_prelude(used));
        statements
    }

    fn follows_prelude(&self, used: &BTreeSet<Symbol>) -> TokenStream {
        let mut statements = TokenStream::new();
        for symbol in used {
            if let Symbol::Follows(i) = symbol {
                let (local, field) = (&self.follows[*i as usize], &self.input_fields[*i as usize]);
                statements.extend(quote! {
                    let #local = if self.inputs.#field.is_none() { T::one() } else { T::zero() };
                });
            }
        }
        statements
    }

    fn parameter_prelude(&self, used: &BTreeSet<Symbol>) -> TokenStream {
        let bindings: Vec<TokenStream> = used
            .iter()
            .filter_map(|symbol| match symbol {
                Symbol::Parameter(i) => Some(*i as usize),
                _ => None,
            })
            .map(|i| {
                let (field, local) = (&self.parameter_fields[i], &self.parameters[i]);
                if field == local {
                    quote!(#field)
                } else {
                    quote!(#field: #local)
                }
            })
            .collect();
        match (bindings.len(), self.parameters.len()) {
            (0, _) => TokenStream::new(),
            (some, all) if some == all => {
                quote!(let Parameters { #(#bindings),* } = self.parameters;)
            }
            _ => quote!(let Parameters { #(#bindings,)* .. } = self.parameters;),
        }
    }

    /// Whether a program reads the state.
    pub fn reads_state(program: &Program) -> bool {
        program.reads(|symbol| symbol.is_of_state())
    }
}

/// The array that a symbol is an entry of.
fn array_of(symbol: Symbol) -> Option<TokenStream> {
    match symbol {
        Symbol::Coordinate(_) => Some(quote!(state.q)),
        Symbol::Velocity(_) => Some(quote!(state.v)),
        Symbol::Acceleration(_) => Some(quote!(acceleration)),
        Symbol::Multiplier(_) => Some(quote!(multiplier)),
        Symbol::Weight(_) => Some(quote!(out.weights)),
        Symbol::Time
        | Symbol::Parameter(_)
        | Symbol::Input(_)
        | Symbol::Follows(_)
        | Symbol::Tabulated(_) => None,
    }
}

/// Gives entries of an array their names: all at once, unless few of many are read.
fn entries(names: &[Ident], places: &[usize], array: &TokenStream) -> TokenStream {
    if names.len() > FEW_OF * places.len() && names.len() > SHORT {
        let entry = |place: &usize| {
            let (name, place) = (&names[*place], Literal::usize_unsuffixed(*place));
            quote!(let #name = #array[#place];)
        };
        return places.iter().map(entry).collect();
    }
    let mut pattern = vec![quote!(_); names.len()];
    for place in places {
        let name = &names[*place];
        pattern[*place] = quote!(#name);
    }
    match places.is_empty() {
        true => TokenStream::new(),
        false => quote!(let [#(#pattern),*] = #array;),
    }
}

impl Symbols for SymbolNames {
    fn prelude(&self, used: &BTreeSet<Symbol>) -> TokenStream {
        self.bindings(used)
    }

    fn all_coordinates(&self, count: usize) -> Option<TokenStream> {
        (self.coordinates.len() == count).then(|| quote!(state.q.data.0[0]))
    }

    fn entry(&self, symbol: Symbol, index: Index) -> Option<TokenStream> {
        array_of(symbol).map(|array| quote!(#array.data.0[0][#index]))
    }

    fn local(&self, symbol: Symbol) -> Ident {
        match symbol {
            Symbol::Time => self.time.clone(),
            Symbol::Coordinate(i) => self.coordinates[i as usize].clone(),
            Symbol::Velocity(i) => self.velocities[i as usize].clone(),
            Symbol::Parameter(i) => self.parameters[i as usize].clone(),
            Symbol::Input(i) => self.input_fields[i as usize].clone(),
            Symbol::Acceleration(i) => self.accelerations[i as usize].clone(),
            Symbol::Multiplier(i) => self.multipliers[i as usize].clone(),
            Symbol::Weight(i) => self.weights[i as usize].clone(),
            Symbol::Follows(i) => self.follows[i as usize].clone(),
            // Only loops have tables, and symbols with one: `WithTable`.
            Symbol::Tabulated(_) => unreachable!("no table"),
        }
    }

    fn input(&self, index: u32, law: TokenStream) -> TokenStream {
        let field = &self.input_fields[index as usize];
        quote!(self.inputs.#field.unwrap_or(#law))
    }
}
