//! Quantities and constraint rows of the static description.

use crate::model::{Constraint, Quantity};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// A `Quantity`.
pub(super) fn quantity(quantity: &Quantity) -> TokenStream {
    let Quantity {
        name, unit, docs, ..
    } = quantity;
    quote!(Quantity { name: #name, unit: #unit, docs: #docs })
}

/// A `ConstraintRow`.
pub(super) fn constraint_row(row: &Constraint) -> TokenStream {
    let (text, holonomic) = (&row.text, row.holonomic);
    let line = Literal::u32_unsuffixed(row.span.start.line);
    quote!(ConstraintRow { text: #text, line: #line, holonomic: #holonomic })
}
