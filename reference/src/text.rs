//! Numbers as decimal text.
//!
//! In:  a number, or its text.
//! Out: the other: 32 significant digits unless a precision is asked for.

use crate::DoubleDouble;
use core::fmt::{Display, Formatter, Result as FmtResult};
use core::str::FromStr;
use num_traits::{FloatErrorKind, Num, One, ParseFloatError, Zero};

/// Significant digits after the first, where none are asked for.
const DIGITS: usize = 31;

/// A power of ten; exact up to 10²² in each factor.
fn power_of_ten(exponent: i32) -> DoubleDouble {
    let size = num_traits::pow(DoubleDouble::from(10.0), exponent.unsigned_abs() as usize);
    if exponent < 0 {
        DoubleDouble::one() / size
    } else {
        size
    }
}

impl Display for DoubleDouble {
    /// As `d.ddd…e±x`, with as many digits after the point as the precision says.
    fn fmt(&self, f: &mut Formatter<'_>) -> FmtResult {
        if !self.is_finite() || self.is_zero() {
            return self.high().fmt(f);
        }
        let wanted = f.precision().unwrap_or(DIGITS).min(DIGITS);
        let mut exponent = self.high().abs().log10().floor() as i32;
        let size = if self.high() < 0.0 { -*self } else { *self };
        let mut rest = size / power_of_ten(exponent);
        let ten = DoubleDouble::from(10.0);
        if rest >= ten {
            (rest, exponent) = (rest / ten, exponent + 1);
        } else if rest < DoubleDouble::one() {
            (rest, exponent) = (rest * ten, exponent - 1);
        }
        let mut digits = digits(rest, wanted);
        if digits[0] == 10 {
            // Rounding went through all of the nines.
            (digits, exponent) = (vec![0; wanted + 1], exponent + 1);
            digits[0] = 1;
        }
        let text: String = digits
            .iter()
            .map(|digit| char::from(b'0' + digit))
            .collect();
        let (first, others) = text.split_at(1);
        let sign = if self.high() < 0.0 { "-" } else { "" };
        let point = if others.is_empty() { "" } else { "." };
        let text = format!("{sign}{first}{point}{others}e{exponent}");
        f.pad_integral(true, "", &text)
    }
}

/// The decimal digits of a number from 1 to 10, `wanted` of them after the first,
/// rounded; the first may become 10.
fn digits(mut rest: DoubleDouble, wanted: usize) -> Vec<u8> {
    let mut digits = Vec::with_capacity(wanted + 1);
    for _ in 0..=wanted {
        let digit = rest.high().floor().clamp(0.0, 9.0);
        digits.push(digit as u8);
        rest = (rest - DoubleDouble::from(digit)) * DoubleDouble::from(10.0);
    }
    let mut carry = rest.high() >= 5.0;
    for (i, digit) in digits.iter_mut().enumerate().rev() {
        if !carry {
            break;
        }
        *digit += 1;
        carry = *digit == 10 && i > 0;
        if carry {
            *digit = 0;
        }
    }
    digits
}

impl FromStr for DoubleDouble {
    type Err = ParseFloatError;

    fn from_str(text: &str) -> Result<Self, ParseFloatError> {
        parse(text, 10)
    }
}

impl Num for DoubleDouble {
    type FromStrRadixErr = ParseFloatError;

    fn from_str_radix(text: &str, radix: u32) -> Result<Self, ParseFloatError> {
        parse(text, radix)
    }
}

/// Reads a decimal number: digits with at most one point, and an exponent.
fn parse(text: &str, radix: u32) -> Result<DoubleDouble, ParseFloatError> {
    let invalid = || ParseFloatError {
        kind: if text.is_empty() {
            FloatErrorKind::Empty
        } else {
            FloatErrorKind::Invalid
        },
    };
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse().map_err(|_| invalid())?),
        None => (text, 0_i32),
    };
    let unsigned = mantissa.strip_prefix(['-', '+']).unwrap_or(mantissa);
    let (whole, fraction) = unsigned.split_once('.').unwrap_or((unsigned, ""));
    let all = || whole.bytes().chain(fraction.bytes());
    let any = all().next().is_some();
    if radix != 10 || !any || !all().all(|x| x.is_ascii_digit()) || exponent.abs() > 400 {
        return Err(invalid());
    }
    let value = all().fold(DoubleDouble::zero(), |sum, digit| {
        sum * DoubleDouble::from(10.0) + DoubleDouble::from(f64::from(digit - b'0'))
    });
    let places = i32::try_from(fraction.len()).map_err(|_| invalid())?;
    let value = value * power_of_ten(exponent - places);
    Ok(if mantissa.starts_with('-') {
        -value
    } else {
        value
    })
}
