//! The scalar that generated code and the runtime's kernels are generic over.
//!
//! Out: [`Real`], implemented here for `f64` and `f32`.
//!
//! Not here: lanes, dual numbers and extended precision. A type joins by
//! implementing this one trait; nothing else in the crate names a float type.

use crate::sincos;
use core::fmt::{Debug, Display};
use core::ops::Neg;
use nalgebra::Scalar;
use num_traits::NumAssign;

/// A real number: what the equations of motion are computed with.
///
/// The supertraits give the four operations, their assigning forms and what
/// nalgebra wants of a matrix entry. The methods are the functions of the
/// mechanism language and the two ways in from `f64`.
pub trait Real:
    Scalar + Copy + Default + PartialOrd + Debug + Display + NumAssign + Neg<Output = Self>
{
    /// The distance from 1 to the next larger number.
    const EPSILON: Self;
    /// Whether what works on slices of these numbers is compiled with this crate.
    #[doc(hidden)]
    const IS_COMPILED_HERE: bool = false;

    /// The nearest number to an `f64`.
    fn from_f64(value: f64) -> Self;
    /// The number `high + low`, where `low` holds the bits of a constant that
    /// do not fit into `high`. Types of 53 bits or fewer ignore `low`.
    fn constant(high: f64, low: f64) -> Self;
    /// π.
    #[inline(always)]
    fn pi() -> Self {
        // What the nearest `f64` leaves of it.
        Self::constant(core::f64::consts::PI, 1.224_646_799_147_353_2e-16)
    }
    /// The nearest `f64`.
    fn to_f64(self) -> f64;
    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;

    /// `self · factor + term`, rounded once where the processor has an operation for
    /// that.
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        self * factor + term
    }
    /// Sine and cosine of one angle (rad), computed together.
    fn sin_cos(self) -> (Self, Self);
    /// Sines and cosines of several angles (rad): the first array holds the sines.
    #[inline(always)]
    fn sin_cos_all<const K: usize>(angles: &[Self; K]) -> ([Self; K], [Self; K]) {
        let mut both = ([Self::zero(); K], [Self::zero(); K]);
        for (i, angle) in angles.iter().enumerate() {
            (both.0[i], both.1[i]) = angle.sin_cos();
        }
        both
    }
    /// Tangent of an angle (rad).
    fn tan(self) -> Self;
    /// Angle in [−π/2, π/2] with this sine.
    fn asin(self) -> Self;
    /// Angle in [0, π] with this cosine.
    fn acos(self) -> Self;
    /// Angle in (−π/2, π/2) with this tangent.
    fn atan(self) -> Self;
    /// Angle of the point (`x`, `self`) from the x axis, in (−π, π].
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic sine.
    fn sinh(self) -> Self;
    /// Hyperbolic cosine.
    fn cosh(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Exponential function.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Non-negative square root.
    fn sqrt(self) -> Self;
    /// `self` to a real power.
    fn powf(self, exponent: Self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// −1, 0 or 1: the sign, with 0 for 0 (unlike `f64::signum`).
    fn sign(self) -> Self;
    /// The smaller of two numbers; NaN if one of them is NaN (unlike `f64::min`).
    fn min(self, other: Self) -> Self;
    /// The larger of two numbers; NaN if one of them is NaN (unlike `f64::max`).
    fn max(self, other: Self) -> Self;
}

macro_rules! real_for_float {
    ($float:ident, $is_compiled_here:literal) => {
        impl Real for $float {
            const EPSILON: Self = $float::EPSILON;
            const IS_COMPILED_HERE: bool = $is_compiled_here;

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $float
            }
            #[inline(always)]
            fn constant(high: f64, _low: f64) -> Self {
                high as $float
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                // One comparison; the library's own is made of operations on bits.
                self.abs() <= $float::MAX
            }
            // Without such an operation a function would be called.
            #[cfg(all(feature = "std", target_feature = "fma"))]
            #[inline(always)]
            fn mul_add(self, factor: Self, term: Self) -> Self {
                $float::mul_add(self, factor, term)
            }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                let (sin, cos) = sincos::sin_cos(f64::from(self));
                (sin as $float, cos as $float)
            }
            #[inline(always)]
            fn sin_cos_all<const K: usize>(angles: &[Self; K]) -> ([Self; K], [Self; K]) {
                real_for_float!(@batch $float, angles)
            }
            real_for_float!(@unary $float: tan asin acos atan sinh cosh tanh exp ln sqrt);
            #[inline]
            fn atan2(self, x: Self) -> Self {
                real_for_float!(@call $float, atan2, self, x)
            }
            // Where the compiler sees a constant argument it may replace this by another
            // function, which rounds differently: the same run would give other bits in
            // another build.
            #[inline(never)]
            fn powf(self, exponent: Self) -> Self {
                real_for_float!(@call $float, powf, self, exponent)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $float::abs(self)
            }
            #[inline(always)]
            fn sign(self) -> Self {
                if self == 0.0 { 0.0 } else { $float::signum(self) }
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if self < other || self.is_nan() {
                    self
                } else {
                    other
                }
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if self > other || self.is_nan() {
                    self
                } else {
                    other
                }
            }
        }
    };
    (@batch f64, $angles:ident) => {
        sincos::sin_cos_all($angles)
    };
    (@batch f32, $angles:ident) => {{
        let (sines, cosines) = sincos::sin_cos_all(&$angles.map(f64::from));
        (sines.map(|x| x as f32), cosines.map(|x| x as f32))
    }};
    (@unary $float:ident: $($name:ident)*) => {
        $(
            #[inline]
            fn $name(self) -> Self {
                real_for_float!(@call $float, $name, self)
            }
        )*
    };
    (@call $float:ident, $name:ident, $($argument:expr),*) => {{
        #[cfg(feature = "std")]
        {
            $float::$name($($argument),*)
        }
        #[cfg(not(feature = "std"))]
        {
            num_traits::Float::$name($($argument),*)
        }
    }};
}

real_for_float!(f64, true);
real_for_float!(f32, false);

#[cfg(test)]
mod tests {
    use super::Real;

    /// The larger and the smaller of two numbers, by the trait.
    fn both<T: Real>(a: f64, b: f64) -> [f64; 2] {
        let (a, b) = (T::from_f64(a), T::from_f64(b));
        [a.max(b).to_f64(), a.min(b).to_f64()]
    }

    #[test]
    fn the_larger_and_the_smaller_of_two_numbers_keep_what_is_not_a_number() {
        for (a, b) in [(f64::NAN, 1.0), (1.0, f64::NAN), (f64::NAN, f64::NAN)] {
            for value in both::<f64>(a, b).into_iter().chain(both::<f32>(a, b)) {
                assert!(value.is_nan(), "of {a} and {b}: {value}");
            }
        }
        assert_eq!(both::<f64>(2.0, -3.0), [2.0, -3.0]);
        assert_eq!(both::<f32>(-3.0, 2.0), [2.0, -3.0]);
        assert_eq!(both::<f64>(f64::INFINITY, 1.0), [f64::INFINITY, 1.0]);
    }
}
