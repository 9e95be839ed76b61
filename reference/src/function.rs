//! Elementary functions, to the last few of 106 bits.
//!
//! In:  numbers.
//! Out: sines and arcs; exponentials and hyperbolic functions; powers.
//!
//! Series are summed to the last bit that counts; inverse functions start from
//! their value in 53 bits and make one step of Newton's method, which doubles the
//! number of right digits.

use crate::DoubleDouble;
use num_traits::{One, Zero};
use qd::Quad;

/// 1/k! for k = 2 … 28 as pairs `high, low`.
const INVERSE_FACTORIALS: [(f64, f64); 27] = [
    (0.5, 0.0),
    (0.16666666666666666, 9.25185853854297e-18),
    (0.041666666666666664, 2.3129646346357427e-18),
    (0.008333333333333333, 1.1564823173178714e-19),
    (0.001388888888888889, -5.300543954373577e-20),
    (0.0001984126984126984, 1.7209558293420705e-22),
    (2.48015873015873e-5, 2.1511947866775882e-23),
    (2.7557319223985893e-6, -1.858393274046472e-22),
    (2.755731922398589e-7, 2.3767714622250297e-23),
    (2.505210838544172e-8, -1.448814070935912e-24),
    (2.08767569878681e-9, -1.20734505911326e-25),
    (1.6059043836821613e-10, 1.2585294588752098e-26),
    (1.1470745597729725e-11, 2.0655512752830745e-28),
    (7.647163731819816e-13, 7.03872877733453e-30),
    (4.779477332387385e-14, 4.399205485834081e-31),
    (2.8114572543455206e-15, 1.6508842730861433e-31),
    (1.5619206968586225e-16, 1.1910679660273754e-32),
    (8.22063524662433e-18, 2.2141894119604265e-34),
    (4.110317623312165e-19, 1.4412973378659527e-36),
    (1.9572941063391263e-20, -1.3643503830087908e-36),
    (8.896791392450574e-22, -7.911402614872376e-38),
    (3.868170170630684e-23, -8.843177655482344e-40),
    (1.6117375710961184e-24, -3.6846573564509766e-41),
    (6.446950284384474e-26, -1.9330404233703465e-42),
    (2.4795962632247976e-27, -1.2953730964765229e-43),
    (9.183689863795546e-29, 1.4303150396787322e-45),
    (3.279889237069838e-30, 1.5117542744029879e-46),
];

/// π/2 in three parts: what the nearest `f64` leaves, and what that leaves.
const HALF_PI: [f64; 3] = [
    core::f64::consts::FRAC_PI_2,
    6.123233995736766e-17,
    -1.4973849048591698e-33,
];

/// Below this size the hyperbolic sine is a series, since the difference of
/// exponentials would cancel.
const SMALL: f64 = 0.5;

/// Above this size the hyperbolic tangent is ±1 in all 106 bits.
const SATURATED: f64 = 40.0;

/// The largest exponent up to which powers are products.
const LARGEST_PRODUCT: f64 = 1024.0;

/// `Σ zⁱ/(first + 2i)!`.
fn series(z: DoubleDouble, first: usize) -> DoubleDouble {
    let terms = INVERSE_FACTORIALS.iter().skip(first - 2).step_by(2);
    terms.rev().fold(DoubleDouble::zero(), |sum, &(high, low)| {
        sum * z + DoubleDouble::new(high, low)
    })
}

/// Sine and cosine of an angle (rad).
pub(crate) fn sin_cos(x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let turns = (x.high() * core::f64::consts::FRAC_2_PI).round();
    let n = DoubleDouble::from(turns);
    let part = |i: usize| n * DoubleDouble::from(HALF_PI[i]);
    let r = ((x - part(0)) - part(1)) - part(2);
    let z = -(r * r);
    let sine = r + r * z * series(z, 3);
    let cosine = DoubleDouble::one() + z * series(z, 2);
    match turns.rem_euclid(4.0) as u8 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// Angle of the point (`x`, `y`) from the x axis.
pub(crate) fn atan2(y: DoubleDouble, x: DoubleDouble) -> DoubleDouble {
    let near = DoubleDouble::from(y.high().atan2(x.high()));
    let size = DoubleDouble::from(x.high().abs().max(y.high().abs()));
    if size.is_zero() || !size.is_finite() {
        return near;
    }
    let (x, y) = (x / size, y / size);
    let (sine, cosine) = sin_cos(near);
    near + (y * cosine - x * sine) / sqrt(x * x + y * y)
}

/// The other leg of a right triangle with hypotenuse one.
pub(crate) fn leg(x: DoubleDouble) -> DoubleDouble {
    sqrt((DoubleDouble::one() - x) * (DoubleDouble::one() + x))
}

/// Non-negative square root.
pub(crate) fn sqrt(x: DoubleDouble) -> DoubleDouble {
    if x.high() > 0.0 && x.is_finite() {
        x.apply(Quad::sqrt)
    } else {
        DoubleDouble::from(x.high().sqrt())
    }
}

/// Exponential function.
pub(crate) fn exp(x: DoubleDouble) -> DoubleDouble {
    let rough = x.high().exp();
    if rough > 0.0 && rough.is_finite() {
        x.apply(Quad::exp)
    } else {
        DoubleDouble::from(rough)
    }
}

/// Natural logarithm.
pub(crate) fn ln(x: DoubleDouble) -> DoubleDouble {
    let near = DoubleDouble::from(x.high().ln());
    if near.is_finite() {
        near + (x * exp(-near) - DoubleDouble::one())
    } else {
        near
    }
}

/// Hyperbolic sine and cosine.
pub(crate) fn sinh_cosh(x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let half = DoubleDouble::from(0.5);
    let (up, down) = (exp(x), exp(-x));
    let cosine = (up + down) * half;
    if x.high().abs() > SMALL {
        return ((up - down) * half, cosine);
    }
    let z = x * x;
    (x + x * z * series(z, 3), cosine)
}

/// Hyperbolic tangent.
pub(crate) fn tanh(x: DoubleDouble) -> DoubleDouble {
    if x.high().abs() > SATURATED {
        return DoubleDouble::from(x.high().signum());
    }
    let (sine, cosine) = sinh_cosh(x);
    sine / cosine
}

/// A real power, with the special cases of `f64`.
pub(crate) fn power(x: DoubleDouble, exponent: DoubleDouble) -> DoubleDouble {
    let whole = exponent.high();
    if exponent.low() == 0.0 && whole.fract() == 0.0 && whole.abs() <= LARGEST_PRODUCT {
        let product = num_traits::pow(x, whole.abs() as usize);
        return if whole < 0.0 {
            DoubleDouble::one() / product
        } else {
            product
        };
    }
    if x.high() > 0.0 && x.is_finite() && exponent.is_finite() {
        exp(exponent * ln(x))
    } else {
        DoubleDouble::from(x.high().powf(exponent.high()))
    }
}
