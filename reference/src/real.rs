//! What makes [`DoubleDouble`] a number that mechanisms are computed with.

use crate::{DoubleDouble, function};
use bricard_runtime::Real;

impl Real for DoubleDouble {
    const EPSILON: Self = Self::EPSILON;

    fn from_f64(value: f64) -> Self {
        Self::from(value)
    }

    fn constant(high: f64, low: f64) -> Self {
        Self::new(high, low)
    }

    fn to_f64(self) -> f64 {
        self.high()
    }

    fn is_finite(self) -> bool {
        Self::is_finite(self)
    }

    fn sin_cos(self) -> (Self, Self) {
        function::sin_cos(self)
    }

    fn tan(self) -> Self {
        let (sine, cosine) = function::sin_cos(self);
        sine / cosine
    }

    fn asin(self) -> Self {
        function::atan2(self, function::leg(self))
    }

    fn acos(self) -> Self {
        function::atan2(function::leg(self), self)
    }

    fn atan(self) -> Self {
        function::atan2(self, Self::from(1.0))
    }

    fn atan2(self, x: Self) -> Self {
        function::atan2(self, x)
    }

    fn sinh(self) -> Self {
        function::sinh_cosh(self).0
    }

    fn cosh(self) -> Self {
        function::sinh_cosh(self).1
    }

    fn tanh(self) -> Self {
        function::tanh(self)
    }

    fn exp(self) -> Self {
        function::exp(self)
    }

    fn ln(self) -> Self {
        function::ln(self)
    }

    fn sqrt(self) -> Self {
        function::sqrt(self)
    }

    fn powf(self, exponent: Self) -> Self {
        function::power(self, exponent)
    }

    fn abs(self) -> Self {
        if self.high() < 0.0 { -self } else { self }
    }

    fn sign(self) -> Self {
        Self::from(self.high().sign())
    }

    fn min(self, other: Self) -> Self {
        if self < other || self.high().is_nan() {
            self
        } else {
            other
        }
    }

    fn max(self, other: Self) -> Self {
        if self > other || self.high().is_nan() {
            self
        } else {
            other
        }
    }
}
