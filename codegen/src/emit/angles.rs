//! Sines and cosines in emitted functions.
//!
//! In:  a program that is being written.
//! Out: one call for all angles that are known from the start: it checks their sizes at once,
//!      and many of them run in the lanes of the processor; a call of its own for each of the
//!      others.

use super::function::{Binding, Writer, pattern};
use super::name::ident;
use crate::expr::Function;
use crate::model::Symbol;
use crate::optimise::{Operation, Value};
use proc_macro2::{Ident, TokenStream};
use quote::quote;
use rustc_hash::FxHashSet;
use std::collections::BTreeSet;
use std::mem::discriminant;

/// The fewest angles for which one call for all is worth while.
const ANGLES_MIN: usize = 2;

/// Angles whose sines and cosines are computed by one call.
pub(super) struct Together {
    /// The array of the angles.
    pub array: TokenStream,
    /// The names of their sines and cosines.
    pub pairs: Vec<(Ident, Ident)>,
    /// The symbols that are in scope after the call, or not needed any more.
    bound: BTreeSet<Symbol>,
}

impl Writer<'_> {
    /// Writes the call for all angles that are known from the start; the symbols that
    /// are in scope after it, or not needed any more.
    pub(super) fn place_angles(&mut self) -> BTreeSet<Symbol> {
        let Some(Together {
            array,
            pairs,
            bound,
        }) = self.angles_together(false)
        else {
            return BTreeSet::new();
        };
        let sines = pairs.iter().map(|(sin, _)| pattern(sin));
        let cosines = pairs.iter().map(|(_, cos)| pattern(cos));
        self.statements.push(quote! {
            let ([#(#sines),*], [#(#cosines),*]) = T::sin_cos_all(&#array);
        });
        bound
    }

    /// All angles that are known from the start, if there are several. `alone` says that no other
    /// statements are in the scope of the call for them.
    pub(super) fn angles_together(&mut self, alone: bool) -> Option<Together> {
        let angles = self.early_angles();
        if angles.len() < ANGLES_MIN {
            return None;
        }
        let (array, bound) = match self.whole(&angles) {
            Some(coordinates) => {
                let read = |angle: &Value| self.only_as_angle(*angle);
                (coordinates, angles.iter().filter_map(read).collect())
            }
            None => {
                let bound = self.bind(&angles, alone);
                let arguments = angles.iter().map(|angle| {
                    self.place_with_operands(*angle);
                    self.piece(*angle).tokens.clone()
                });
                let arguments: Vec<TokenStream> = arguments.collect();
                (quote!([#(#arguments),*]), bound)
            }
        };
        let pairs: Vec<_> = angles.iter().map(|angle| self.pair_names(*angle)).collect();
        self.angles.extend(angles.into_iter().zip(pairs.clone()));
        Some(Together {
            array,
            pairs,
            bound,
        })
    }

    /// Angles that no other function has to be called for: coordinates first, in their
    /// order, since what lies side by side is loaded at once.
    fn early_angles(&self) -> Vec<Value> {
        let mut early = vec![false; self.program.len()];
        let mut angles: Vec<Value> = Vec::new();
        let mut known: FxHashSet<Value> = FxHashSet::default();
        for (value, operation) in self.program.operations() {
            early[value.index()] = match operation {
                Operation::Function(Function::Sin | Function::Cos, x) => {
                    if early[x.index()] && known.insert(*x) {
                        angles.push(*x);
                    }
                    false
                }
                Operation::Function(..)
                | Operation::Function2(..)
                | Operation::Select(..)
                | Operation::Input(..) => false,
                _ => operation
                    .operands()
                    .iter()
                    .all(|operand| early[operand.index()]),
            };
        }
        angles.sort_by_key(|angle| match self.program.operation(*angle) {
            Operation::Symbol(Symbol::Coordinate(i)) => *i,
            _ => u32::MAX,
        });
        angles
    }

    /// The array of coordinates, if the angles are all of them.
    fn whole(&self, angles: &[Value]) -> Option<TokenStream> {
        let is_coordinate = |angle: &Value| {
            let operation = self.program.operation(*angle);
            matches!(operation, Operation::Symbol(Symbol::Coordinate(_)))
        };
        let coordinates = self.symbols.all_coordinates(angles.len())?;
        angles.iter().all(is_coordinate).then_some(coordinates)
    }

    /// The symbol that an angle is, if nothing but its sine and cosine is read.
    fn only_as_angle(&self, angle: Value) -> Option<Symbol> {
        let calls = [Function::Sin, Function::Cos].map(|f| self.has(f, angle));
        let calls = calls.into_iter().filter(|call| *call).count();
        match self.program.operation(angle) {
            Operation::Symbol(symbol) if self.uses[angle.index()] == calls => Some(*symbol),
            _ => None,
        }
    }

    /// Brings into scope what the angles read, and, unless they are alone, all else that comes
    /// from the same arrays.
    fn bind(&mut self, angles: &[Value], alone: bool) -> BTreeSet<Symbol> {
        let mut bound = BTreeSet::new();
        let mut pending = angles.to_vec();
        while let Some(value) = pending.pop() {
            let operation = self.program.operation(value);
            if let Operation::Symbol(symbol) = operation {
                bound.insert(*symbol);
            }
            pending.extend(operation.operands());
        }
        if !alone {
            let kinds: Vec<_> = bound.iter().map(discriminant).collect();
            bound = self.symbols_read();
            bound.retain(|symbol| kinds.contains(&discriminant(symbol)));
        }
        let prelude = self.symbols.prelude(&bound);
        self.statements.push(prelude);
        bound
    }

    fn place_with_operands(&mut self, value: Value) {
        for operand in self.program.operation(value).operands() {
            self.place_with_operands(operand);
        }
        self.place(value);
    }

    /// One call for both, wherever the first of them is met.
    pub(super) fn sine_and_cosine(&mut self, x: Value) -> (Ident, Ident) {
        if let Some(names) = self.angles.get(&x) {
            return names.clone();
        }
        let angle = self.bound(x, Binding::Atom);
        let names = self.pair_names(x);
        let (sin, cos) = (pattern(&names.0), pattern(&names.1));
        self.statements
            .push(quote!(let (#sin, #cos) = #angle.sin_cos();));
        self.angles.insert(x, names.clone());
        names
    }

    /// Names for the sine and cosine of an angle; `_` for the one nobody reads.
    fn pair_names(&mut self, x: Value) -> (Ident, Ident) {
        let text = match self.program.operation(x) {
            Operation::Symbol(symbol) => self.symbols.local(*symbol).to_string(),
            _ => "angle".into(),
        };
        let [has_sin, has_cos] = [Function::Sin, Function::Cos].map(|f| self.has(f, x));
        let mut name = |has: bool, prefix: &str| match has {
            true => self.names.unique(&format!("{prefix}_{text}")),
            false => ident("_"),
        };
        (name(has_sin, "sin"), name(has_cos, "cos"))
    }

    fn has(&self, function: Function, x: Value) -> bool {
        let wanted = Operation::Function(function, x);
        self.program.value(&wanted).is_some()
    }
}
