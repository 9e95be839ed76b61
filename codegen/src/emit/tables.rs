//! Tables of many points, which code holds as data.
//!
//! In:  the tables of a mechanism.
//! Out: a static for each, and calls of it.

use crate::expr::{Entry, Lookup};
use crate::model::Mechanism;
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

/// The statics.
pub(super) fn tables(mechanism: &Mechanism) -> TokenStream {
    let tables = mechanism.tables.iter().map(|table| {
        let name = name(table.index);
        let docs = format!(" A function through {} points.", table.places.len());
        let places = table.places.iter().map(|place| number(*place));
        let pieces = table.pieces.iter().map(|piece| {
            let piece = piece.map(number);
            quote!([#(#piece),*])
        });
        quote! {
            #[doc = #docs]
            pub static #name: Table = Table {
                places: &[#(#places),*],
                pieces: &[#(#pieces),*],
            };
        }
    });
    tables.collect()
}

/// A call of a table; whether a run may hold the interval.
pub(super) fn call(lookup: Lookup, x: &TokenStream, by_sides: bool) -> TokenStream {
    let table = name(lookup.table.index);
    let held = lookup.held.filter(|_| by_sides);
    match (lookup.entry, held) {
        (Entry::Derivative(order), Some(first)) => {
            let (order, first) = (
                Literal::u8_unsuffixed(order),
                Literal::u32_unsuffixed(first),
            );
            quote!(#table.held(#order, #x, out.sides, #first))
        }
        (Entry::Derivative(order), None) => {
            let order = Literal::u8_unsuffixed(order);
            quote!(#table.value(#order, #x))
        }
        (Entry::Side(bit) | Entry::Turn(bit), _) => {
            let bit = Literal::u32_unsuffixed(bit);
            let what = match lookup.entry {
                Entry::Side(_) => "side",
                _ => "turn",
            };
            let what = Ident::new(what, Span::call_site());
            quote!(#table.#what(#bit, #x))
        }
    }
}

fn name(index: u32) -> Ident {
    format_ident!("TABLE_{index}")
}

/// A number of the data. A sign is a token of its own.
fn number(value: f64) -> TokenStream {
    let size = Literal::f64_unsuffixed(value.abs());
    if value < 0.0 {
        quote!(-#size)
    } else {
        quote!(#size)
    }
}
