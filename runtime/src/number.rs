//! Numbers in messages.
//!
//! In:  a number.
//! Out: its digits, with an exponent where they would be lost among zeros.

use crate::Real;
use core::fmt::{Display, Formatter, Result};

/// The sizes that are written without an exponent.
const PLAIN: core::ops::Range<f64> = 1e-4..1e16;

/// A number as people write it.
pub(crate) struct Number<'a, T>(pub(crate) &'a T);

impl<T: Real> Display for Number<'_, T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let rounded = self.0.to_f64();
        let size = if rounded < 0.0 { -rounded } else { rounded };
        if PLAIN.contains(&size) || size == 0.0 || !rounded.is_finite() {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{rounded:e}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Number;

    #[test]
    fn tiny_and_huge_numbers_are_written_with_an_exponent() {
        let written = [0.0, -0.25, 1e-4, 7.5e-15, -3e20, f64::NAN].map(|x| Number(&x).to_string());
        assert_eq!(written, ["0", "-0.25", "0.0001", "7.5e-15", "-3e20", "NaN"]);
    }
}
