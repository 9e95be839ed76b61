//! Numbers to tokens.

use crate::expr::Number;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// A number as a value of the scalar `T`: exact where an `f64` holds it, else in
/// two parts, of which a 53-bit scalar ignores the second.
pub(super) fn number(value: Number) -> TokenStream {
    let (high, low) = value.parts();
    if value.is_zero() {
        quote!(T::zero())
    } else if value.is_one() {
        quote!(T::one())
    } else if low == 0.0 {
        let high = float(high);
        quote!(T::from_f64(#high))
    } else {
        let (high, low) = (float(high), float(low));
        quote!(T::constant(#high, #low))
    }
}

/// The two parts of a number, exact together.
pub(super) fn parts(value: Number) -> (TokenStream, TokenStream) {
    let (high, low) = value.parts();
    (float(high), float(low))
}

/// A finite float in its shortest form; the sign is an operator, since a negative
/// literal would print as two operators behind a minus.
fn float(value: f64) -> TokenStream {
    let text = format!("{:?}", value.abs());
    let literal: Literal = text
        .parse()
        .unwrap_or_else(|_| Literal::f64_unsuffixed(value.abs()));
    if value < 0.0 {
        quote!(-#literal)
    } else {
        quote!(#literal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bricard_testkit::Random;

    #[test]
    fn float_literals_read_back_to_the_same_bits() {
        let mut random = Random::seeded(1);
        let values = (0..10_000).map(|_| f64::from_bits(random.bits()));
        for value in values.filter(|value| value.is_finite()) {
            let text = float(value).to_string().replace(' ', "");
            let read = text.parse::<f64>().map(f64::to_bits);
            assert_eq!(read, Ok(value.to_bits()), "{text}");
        }
    }
}
