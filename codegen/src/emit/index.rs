//! Indices of arrays in emitted code.
//!
//! In:  a number, and by how much it changes from one turn of a loop to the next.
//! Out: the expression for it.

use super::name::ident;
use crate::optimise::Slot;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, quote};
use std::cmp::Ordering;

/// An index in the first turn of a loop, and its step from each turn to the next; outside of
/// loops the step is zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Index {
    pub first: usize,
    pub step: isize,
}

/// An entry of a named array; `column` is zero for a vector.
pub(super) struct Target {
    pub array: &'static str,
    pub row: Index,
    pub column: Index,
}

impl Index {
    pub fn fixed(first: usize) -> Self {
        Self { first, step: 0 }
    }
}

impl From<&Slot> for Target {
    fn from(slot: &Slot) -> Self {
        Self {
            array: slot.array,
            row: Index::fixed(slot.row),
            column: Index::fixed(slot.column),
        }
    }
}

/// The variable that counts the turns of a loop.
pub(super) fn turn() -> Ident {
    ident("turn")
}

impl ToTokens for Index {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        let (first, turn) = (Literal::usize_unsuffixed(self.first), turn());
        let by = match self.step.unsigned_abs() {
            0 => return first.to_tokens(tokens),
            1 => quote!(#turn),
            step => {
                let step = Literal::usize_unsuffixed(step);
                quote!(#step * #turn)
            }
        };
        tokens.extend(match (self.step.cmp(&0), self.first) {
            (Ordering::Less, _) => quote!(#first - #by),
            (_, 0) => by,
            _ => quote!(#first + #by),
        });
    }
}
