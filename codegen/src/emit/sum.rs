//! Sums in emitted functions.
//!
//! In:  a program that is being written.
//! Out: an expression for a sum, or, where loops are looked for in a long one, a name for each of
//!      its parts.

use super::function::{Binding, NESTED_MAX, OPERANDS_MAX, Piece, Writer};
use super::name::ident;
use crate::optimise::{Operation, Value};
use proc_macro2::Ident;
use quote::quote;

impl Writer<'_> {
    /// A product that is written where it is added goes with the sum into one operation.
    pub(super) fn sum(&mut self, terms: &[(bool, Value)]) -> Piece {
        let (first, rest) = self.begun(terms);
        let mut sum = first;
        for (count, (minus, value)) in (1..).zip(rest) {
            if count % NESTED_MAX == 0 {
                sum = self.named("sum", sum.tokens);
            }
            sum = self.with_term(sum, minus, value);
        }
        sum
    }

    /// A sum, and one term more.
    fn with_term(&self, sum: Piece, minus: bool, value: Value) -> Piece {
        let term = self.piece(value);
        let (so_far, operands) = (sum.tokens, sum.operands + term.operands);
        let (tokens, binding) = match (&term.factors, minus) {
            (Some((x, y)), false) => (quote!(#x.mul_add(#y, #so_far)), Binding::Atom),
            (Some((x, y)), true) => (quote!((-#x).mul_add(#y, #so_far)), Binding::Atom),
            (None, _) => {
                let term = self.bound(value, Binding::Product);
                let sign = if minus { quote!(-) } else { quote!(+) };
                (quote!(#so_far #sign #term), Binding::Sum)
            }
        };
        Piece::new(tokens, binding, operands)
    }

    /// The terms of a sum that is too long for one expression, in the order in which they are
    /// added; `None` for a value that is no such sum.
    pub(super) fn long_sum(&self, value: Value) -> Option<Vec<(bool, Value)>> {
        let written = self.pieces[value.index()].is_some();
        match self.program.operation(value) {
            Operation::Sum(terms) if terms.len() > OPERANDS_MAX && !written => {
                let mut rest = terms.clone();
                let first = rest.remove(self.beginning(terms));
                rest.insert(0, first);
                Some(rest)
            }
            _ => None,
        }
    }

    /// Names the sum of a term and all terms added before; the last of these names is that of the
    /// value.
    pub(super) fn add_term(&mut self, value: Value, (minus, term): (bool, Value)) -> Ident {
        let sum = match self.pieces[value.index()].take() {
            Some(sum) => self.with_term(sum, minus, term),
            None => self.only(minus, term),
        };
        let piece = self.named("sum", sum.tokens);
        let name = piece.name.clone();
        self.pieces[value.index()] = Some(piece);
        name.unwrap_or_else(|| ident("_"))
    }

    /// What a sum begins with, and its other terms.
    fn begun(&self, terms: &[(bool, Value)]) -> (Piece, Vec<(bool, Value)>) {
        let mut rest = terms.to_vec();
        let (minus, value) = rest.remove(self.beginning(terms));
        (self.only(minus, value), rest)
    }

    /// The term that a sum begins with: one that is added, not subtracted, and is no product, if
    /// there is one.
    fn beginning(&self, terms: &[(bool, Value)]) -> usize {
        let plain = |(minus, value): &(bool, Value)| !minus && self.piece(*value).factors.is_none();
        terms.iter().position(plain).unwrap_or(0)
    }

    /// A sum of one term.
    fn only(&self, minus: bool, value: Value) -> Piece {
        let term = self.piece(value);
        let tokens = match minus {
            true => {
                let term = self.bound(value, Binding::Product);
                quote!(-#term)
            }
            false => term.tokens.clone(),
        };
        Piece::new(tokens, Binding::Sum, term.operands)
    }
}
