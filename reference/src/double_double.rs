//! The scalar: an unevaluated sum of two `f64`.
//!
//! In:  the arithmetic of the crate `qd`.
//! Out: [`DoubleDouble`] with the operators and number traits that nalgebra asks for.
//!
//! Not here: functions ([`crate::function`]), text ([`crate::text`]).

use core::ops::{
    Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Rem, RemAssign, Sub, SubAssign,
};
use num_traits::{One, Zero};
use qd::Quad;

/// A number of 106 bits: about 31 decimal digits, in the range of `f64`.
///
/// What leaves that range behaves as `f64` does: it is infinite or NaN.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct DoubleDouble(Quad);

impl DoubleDouble {
    /// The distance from 1 to the next number that all operations can tell from it:
    /// 2⁻¹⁰⁴.
    pub const EPSILON: Self = Self(Quad::EPSILON);

    /// The sum of two numbers, exact if the second is at most half a unit in the last
    /// place of the first.
    pub const fn new(high: f64, low: f64) -> Self {
        Self(Quad(high, low))
    }

    /// The nearest `f64`.
    pub const fn high(self) -> f64 {
        self.0.0
    }

    /// What the nearest `f64` leaves.
    pub const fn low(self) -> f64 {
        self.0.1
    }

    /// Neither infinite nor NaN.
    pub const fn is_finite(self) -> bool {
        self.high().is_finite() && self.low().is_finite()
    }

    /// A result, or that of the high parts alone where the low part is lost: next to
    /// infinity it comes out as NaN.
    fn checked(exact: Quad, rough: impl FnOnce() -> f64) -> Self {
        if exact.1.is_finite() {
            Self(exact)
        } else {
            Self::new(rough(), 0.0)
        }
    }

    /// A result of a function of the crate.
    pub(crate) fn apply(self, function: fn(Quad) -> Quad) -> Self {
        Self(function(self.0))
    }
}

impl From<f64> for DoubleDouble {
    fn from(value: f64) -> Self {
        Self::new(value, 0.0)
    }
}

impl Default for DoubleDouble {
    fn default() -> Self {
        Self::zero()
    }
}

impl Neg for DoubleDouble {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! operators {
    ($($trait:ident $name:ident $assign:ident $assign_name:ident $exact:expr, $rough:expr;)*) => {
        $(
            impl $trait for DoubleDouble {
                type Output = Self;

                #[inline]
                fn $name(self, other: Self) -> Self {
                    let (exact, rough): (fn(Quad, Quad) -> Quad, fn(f64, f64) -> f64) =
                        ($exact, $rough);
                    Self::checked(exact(self.0, other.0), || rough(self.high(), other.high()))
                }
            }

            impl $assign for DoubleDouble {
                #[inline]
                fn $assign_name(&mut self, other: Self) {
                    *self = $trait::$name(*self, other);
                }
            }
        )*
    };
}

operators! {
    Add add AddAssign add_assign Quad::add_accurate, |a, b| a + b;
    Sub sub SubAssign sub_assign Quad::sub_accurate, |a, b| a - b;
    Mul mul MulAssign mul_assign Quad::mul, |a, b| a * b;
    Div div DivAssign div_assign Quad::div, |a, b| a / b;
    Rem rem RemAssign rem_assign |a, b| a % b, |a, b| a % b;
}

impl Zero for DoubleDouble {
    fn zero() -> Self {
        Self(Quad::ZERO)
    }

    fn is_zero(&self) -> bool {
        self.0 == Quad::ZERO
    }
}

impl One for DoubleDouble {
    fn one() -> Self {
        Self(Quad::ONE)
    }
}
