//! Tables of many points, which code holds as data.
//!
//! In:  the tables of a mechanism.
//! Out: a static for each.

use super::name::table_name;
use super::subject::Subject;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// The statics.
pub(super) fn tables(subject: &Subject) -> TokenStream {
    let tables = subject.mechanism.tables.iter().map(|table| {
        let name = table_name(table.index);
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

/// A number of the data. A sign is a token of its own.
fn number(value: f64) -> TokenStream {
    let size = Literal::f64_unsuffixed(value.abs());
    if value < 0.0 {
        quote!(-#size)
    } else {
        quote!(#size)
    }
}
