//! Exact rationals, and finite floats where a rational does not fit.
//!
//! In:  literals of the description and the arithmetic of folding.
//! Out: [`Number`], totally ordered and hashable.
//!
//! A rational whose numerator or denominator leaves `i128` becomes the nearest
//! float; from there on arithmetic is rounded. Nothing here panics.

use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, Mul, Neg};

/// The bits of the mantissa of a float.
const MANTISSA_BITS: i32 = f64::MANTISSA_DIGITS.cast_signed();

/// A number of the symbolic engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Number {
    /// `numerator / denominator` in lowest terms, denominator positive.
    Exact(i128, i128),
    /// The bits of an `f64`, where the exact value does not fit.
    Float(u64),
}

impl Number {
    /// Zero.
    pub const ZERO: Number = Number::Exact(0, 1);
    /// One.
    pub const ONE: Number = Number::Exact(1, 1);
    /// Minus one.
    pub const MINUS_ONE: Number = Number::Exact(-1, 1);

    /// A whole number.
    pub fn integer(value: i64) -> Self {
        Number::Exact(i128::from(value), 1)
    }

    /// A float; `-0.0` becomes `0.0`, so that equal numbers are equal bits.
    pub fn float(value: f64) -> Self {
        Number::Float((value + 0.0).to_bits())
    }

    /// `numerator / denominator`, or `None` where the denominator is zero.
    pub fn ratio(numerator: i128, denominator: i128) -> Option<Self> {
        if denominator == 0 {
            return None;
        }
        let common = gcd(numerator.unsigned_abs(), denominator.unsigned_abs());
        let reduce = |x: i128| i128::try_from(x.unsigned_abs() / common).ok();
        let (Some(n), Some(d)) = (reduce(numerator), reduce(denominator)) else {
            return Some(Number::float(numerator as f64 / denominator as f64));
        };
        let negative = (numerator < 0) != (denominator < 0);
        Some(Number::Exact(if negative { -n } else { n }, d))
    }

    /// Reads a decimal literal exactly: `12`, `0.1`, `1e-3`, `1_000`.
    ///
    /// `None` if it is no decimal literal or too large for an `f64`.
    pub fn parse_literal(text: &str) -> Option<Self> {
        let text: String = text.chars().filter(|&c| c != '_').collect();
        let value: f64 = text.parse().ok().filter(|x: &f64| x.is_finite())?;
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((&text, "0"));
        let exponent: i32 = exponent.parse().ok()?;
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let digits: Option<i128> = format!("{whole}{fraction}").parse().ok();
        let scale = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?;
        let exact = digits.and_then(|digits| {
            let power = 10_i128.checked_pow(scale.unsigned_abs())?;
            if scale >= 0 {
                Number::ratio(digits.checked_mul(power)?, 1)
            } else {
                Number::ratio(digits, power)
            }
        });
        Some(exact.unwrap_or_else(|| Number::float(value)))
    }

    /// The nearest float.
    pub fn to_f64(self) -> f64 {
        match self {
            // A quotient of two floats is rounded to the nearest.
            Number::Exact(n, d) if n.unsigned_abs().max(d.unsigned_abs()) < 1 << MANTISSA_BITS => {
                n as f64 / d as f64
            }
            _ => self.parts().0,
        }
    }

    /// Two floats whose sum is the number to about 106 bits; the first is the
    /// nearest float.
    pub fn parts(self) -> (f64, f64) {
        match self {
            Number::Float(bits) => (f64::from_bits(bits), 0.0),
            Number::Exact(n, d) => {
                let (high, low) = quotient(n.unsigned_abs(), d.unsigned_abs());
                if n < 0 { (-high, -low) } else { (high, low) }
            }
        }
    }

    /// The value if it is a whole number that fits.
    pub fn as_integer(self) -> Option<i64> {
        match self {
            Number::Exact(n, 1) => i64::try_from(n).ok(),
            _ => None,
        }
    }

    /// Whether it is zero.
    pub fn is_zero(self) -> bool {
        self == Number::ZERO || self == Number::Float(0)
    }

    /// Whether it is one.
    pub fn is_one(self) -> bool {
        self == Number::ONE
    }

    /// Whether it is below zero.
    pub fn is_negative(self) -> bool {
        match self {
            Number::Exact(n, _) => n < 0,
            Number::Float(bits) => f64::from_bits(bits) < 0.0,
        }
    }

    /// Whether it is neither infinite nor NaN.
    pub fn is_finite(self) -> bool {
        match self {
            Number::Exact(..) => true,
            Number::Float(bits) => f64::from_bits(bits).is_finite(),
        }
    }

    /// An integer power; `None` for a negative power of zero.
    pub fn powi(self, exponent: i32) -> Option<Number> {
        if exponent < 0 && self.is_zero() {
            return None;
        }
        let exact = match self {
            Number::Exact(n, d) => {
                let size = exponent.unsigned_abs();
                let power = |x: i128| x.checked_pow(size);
                power(n).zip(power(d)).and_then(|(n, d)| {
                    if exponent >= 0 {
                        Number::ratio(n, d)
                    } else {
                        Number::ratio(d, n)
                    }
                })
            }
            Number::Float(_) => None,
        };
        Some(exact.unwrap_or_else(|| Number::float(self.to_f64().powi(exponent))))
    }

    /// The square root if it is rational.
    pub fn exact_sqrt(self) -> Option<Number> {
        let root = |x: i128| {
            let r = x.checked_isqrt()?;
            (r * r == x).then_some(r)
        };
        match self {
            Number::Exact(n, d) => Number::ratio(root(n)?, root(d)?),
            Number::Float(_) => None,
        }
    }

    fn exact_with(self, other: Number) -> Option<((i128, i128), (i128, i128))> {
        match (self, other) {
            (Number::Exact(a, b), Number::Exact(c, d)) => Some(((a, b), (c, d))),
            _ => None,
        }
    }
}

/// The float nearest to `n/d` and what is left of it, by long division in base two.
fn quotient(n: u128, d: u128) -> (f64, f64) {
    if n == 0 {
        return (0.0, 0.0);
    }
    // Most numbers are whole, and floats.
    if d == 1 && n < 1 << MANTISSA_BITS {
        return (n as f64, 0.0);
    }
    let bits = |x: u128| (u128::BITS - x.leading_zeros()).cast_signed();
    let mut exponent = (bits(n) - bits(d) - MANTISSA_BITS + 1).max(0);
    let d = d << exponent;
    let (mut mantissa, mut rest) = (n / d, n % d);
    while bits(mantissa) < MANTISSA_BITS {
        (mantissa, rest, exponent) = (2 * mantissa, 2 * rest, exponent - 1);
        if rest >= d {
            (mantissa, rest) = (mantissa + 1, rest - d);
        }
    }
    let missing = d - rest;
    // Half way between two floats, the even one is the nearest by convention.
    let up = rest > missing || (rest == missing && mantissa % 2 == 1);
    let left = if up { -(missing as f64) } else { rest as f64 } / d as f64;
    let unit = 2.0_f64.powi(exponent);
    ((mantissa + u128::from(up)) as f64 * unit, left * unit)
}

impl Add for Number {
    type Output = Number;

    fn add(self, other: Number) -> Number {
        // Most numbers are whole, and those need no common divisor.
        if let (Number::Exact(a, 1), Number::Exact(c, 1)) = (self, other)
            && let Some(sum) = a.checked_add(c)
        {
            return Number::Exact(sum, 1);
        }
        let exact = self.exact_with(other).and_then(|((a, b), (c, d))| {
            let left = a.checked_mul(d)?;
            let right = c.checked_mul(b)?;
            Number::ratio(left.checked_add(right)?, b.checked_mul(d)?)
        });
        exact.unwrap_or_else(|| Number::float(self.to_f64() + other.to_f64()))
    }
}

impl Mul for Number {
    type Output = Number;

    fn mul(self, other: Number) -> Number {
        if let (Number::Exact(a, 1), Number::Exact(c, 1)) = (self, other)
            && let Some(product) = a.checked_mul(c)
        {
            return Number::Exact(product, 1);
        }
        let exact = self
            .exact_with(other)
            .and_then(|((a, b), (c, d))| Number::ratio(a.checked_mul(c)?, b.checked_mul(d)?));
        exact.unwrap_or_else(|| Number::float(self.to_f64() * other.to_f64()))
    }
}

impl Neg for Number {
    type Output = Number;

    fn neg(self) -> Number {
        match self {
            Number::Exact(n, d) if n > i128::MIN => Number::Exact(-n, d),
            _ => self * Number::MINUS_ONE,
        }
    }
}

fn gcd(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a.max(1)
}

impl Ord for Number {
    fn cmp(&self, other: &Self) -> Ordering {
        let exact = self
            .exact_with(*other)
            .and_then(|((a, b), (c, d))| Some(a.checked_mul(d)?.cmp(&c.checked_mul(b)?)));
        let rounded = || self.to_f64().total_cmp(&other.to_f64());
        let tie = || format!("{self:?}").cmp(&format!("{other:?}"));
        exact.unwrap_or_else(|| rounded().then_with(tie))
    }
}

impl PartialOrd for Number {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl fmt::Display for Number {
    /// A decimal where it is short and exact (`9.81`), else a fraction (`1/3`).
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Number::Float(bits) => write!(f, "{:?}", f64::from_bits(bits)),
            Number::Exact(n, 1) => write!(f, "{n}"),
            Number::Exact(n, d) => match decimal(n, d) {
                Some(text) if d > 20 || d == 10 => f.write_str(&text),
                _ => write!(f, "{n}/{d}"),
            },
        }
    }
}

/// `n/d` as a decimal of at most twelve places, if it is one.
fn decimal(n: i128, d: i128) -> Option<String> {
    let places = (1..=12_u32).find(|&p| 10_i128.pow(p) % d == 0)?;
    let scaled = n.checked_mul(10_i128.pow(places) / d)?;
    let unit = 10_i128.pow(places);
    let sign = if scaled < 0 { "-" } else { "" };
    let width = places as usize;
    let (whole, part) = (scaled.abs() / unit, scaled.abs() % unit);
    Some(format!("{sign}{whole}.{part:0width$}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimal_literals_are_exact() {
        assert_eq!(Number::parse_literal("0.1"), Number::ratio(1, 10));
        assert_eq!(Number::parse_literal("1e-3"), Number::ratio(1, 1000));
        assert_eq!(Number::parse_literal("2.50e1"), Number::ratio(25, 1));
        assert_eq!(Number::parse_literal("1e400"), None);
    }

    #[test]
    fn a_rational_that_overflows_becomes_the_nearest_float() {
        let tiny = Number::parse_literal("1e-300").expect("a literal");
        assert_eq!(tiny.to_f64(), 1e-300);
        let huge = Number::integer(i64::MAX)
            .powi(5)
            .expect("not a power of zero");
        assert_eq!(huge.to_f64(), (i64::MAX as f64).powi(5));
    }

    #[test]
    fn both_parts_of_a_constant_carry_it_to_twice_the_bits() {
        let (high, low) = Number::ratio(981, 100).expect("a ratio").parts();
        assert_eq!(high, 9.81);
        // 9.81 − fl(9.81), from rational arithmetic.
        assert!((low + 4.973_799_150_320_701e-16).abs() < 1e-31, "{low:e}");
    }

    #[test]
    fn numbers_print_as_people_write_them() {
        let text = |n, d| Number::ratio(n, d).expect("a ratio").to_string();
        assert_eq!(text(981, 100), "9.81");
        assert_eq!(text(1, 2), "1/2");
        assert_eq!(text(-1, 3), "-1/3");
        assert_eq!(text(1, 10), "0.1");
    }
}
