//! A number with its derivative and a first-order bound on the round-off of both.
//!
//! In:  operations in the order of any expression.
//! Out: [`Jet`]: what the operations give, and how far any order of the same
//!      operations may stray from it. The derivatives of functions are taken
//!      from dual numbers, so they share nothing with the symbolic rules.

use crate::dual;
use bricard_codegen::internals::expr::{Comparison, Function, Function2};
use num_dual::{Dual2_64, DualNum, HyperDual64};

/// The round-off of one operation, relative to its result.
const ROUND_OFF: f64 = f64::EPSILON;

/// A perturbation larger than this, relative to the number it is one of, is not
/// small any more, and a first-order bound says nothing.
const SMALL: f64 = 1e-6;

/// Numbers outside of this range have powers that overflow in one order of the operations
/// and not in another.
const RANGE: std::ops::Range<f64> = 1e-30..1e30;

/// A value, its derivative in one direction, and bounds on the errors of both.
#[derive(Clone, Copy, Debug)]
pub struct Jet {
    pub value: f64,
    pub slope: f64,
    pub value_error: f64,
    pub slope_error: f64,
}

/// The first and second derivatives of a function of one argument.
struct Taylor {
    value: f64,
    first: f64,
    second: f64,
}

impl Jet {
    pub const ZERO: Jet = Jet::exact(0.0, 0.0);

    pub const fn exact(value: f64, slope: f64) -> Self {
        Jet {
            value,
            slope,
            value_error: 0.0,
            slope_error: 0.0,
        }
    }

    /// Whether the bounds are worth a comparison.
    pub fn is_sound(&self) -> bool {
        let small = |x: f64, error: f64| x.is_finite() && error <= SMALL * (1.0 + x.abs());
        small(self.value, self.value_error) && small(self.slope, self.slope_error)
    }

    fn rounded(self) -> Self {
        Jet {
            value_error: self.value_error + ROUND_OFF * self.value.abs(),
            slope_error: self.slope_error + ROUND_OFF * self.slope.abs(),
            ..self
        }
    }

    fn unsound(self) -> Self {
        Jet {
            value_error: f64::INFINITY,
            slope_error: f64::INFINITY,
            ..self
        }
    }

    /// A quotient of two whole numbers.
    pub fn ratio(numerator: i32, denominator: i32) -> Self {
        Jet::exact(f64::from(numerator) / f64::from(denominator), 0.0).rounded()
    }

    pub fn add(self, other: Jet) -> Self {
        Jet {
            value: self.value + other.value,
            slope: self.slope + other.slope,
            value_error: self.value_error + other.value_error,
            slope_error: self.slope_error + other.slope_error,
        }
        .rounded()
    }

    pub fn mul(self, other: Jet) -> Self {
        let (a, b) = (self, other);
        let slope_terms = (a.slope * b.value).abs() + (a.value * b.slope).abs();
        Jet {
            value: a.value * b.value,
            slope: a.slope * b.value + a.value * b.slope,
            value_error: a.value_error * b.value.abs() + a.value.abs() * b.value_error,
            slope_error: a.slope_error * b.value.abs()
                + a.slope.abs() * b.value_error
                + a.value_error * b.slope.abs()
                + a.value.abs() * b.slope_error
                + ROUND_OFF * slope_terms,
        }
        .rounded()
    }

    pub fn powi(self, exponent: i32) -> Self {
        let size = self.value.powi(exponent).abs();
        let pole = exponent < 0 && self.value_error > SMALL * self.value.abs();
        if pole || !(size == 0.0 || RANGE.contains(&size) && RANGE.contains(&self.value.abs())) {
            return self.unsound();
        }
        let dual = Dual2_64::from_re(self.value).derivative().powi(exponent);
        let Jet {
            value,
            slope,
            value_error,
            slope_error,
        } = self.through(taylor(dual));
        let more = f64::from(exponent.abs());
        Jet {
            value,
            slope,
            value_error: value_error * more,
            slope_error: slope_error * more,
        }
    }

    pub fn function(self, function: Function) -> Self {
        let x = Dual2_64::from_re(self.value).derivative();
        let kinks = matches!(function, Function::Abs | Function::Sign);
        if kinks && self.value.abs() <= self.value_error {
            return self.unsound();
        }
        let y = dual::call(function, x);
        self.through(taylor(y))
    }

    fn through(self, f: Taylor) -> Self {
        let slope = f.first * self.slope;
        Jet {
            value: f.value,
            slope,
            value_error: f.first.abs() * self.value_error + ROUND_OFF * f.value.abs(),
            slope_error: (f.second * self.slope).abs() * self.value_error
                + f.first.abs() * self.slope_error
                + 4.0 * ROUND_OFF * slope.abs(),
        }
    }

    pub fn function2(self, function: Function2, other: Jet) -> Self {
        match function {
            Function2::Min => Jet::choose(Comparison::Less, [self, other, self, other]),
            Function2::Max => Jet::choose(Comparison::Less, [self, other, other, self]),
            // The sign of zero decides on the branch cut.
            Function2::Atan2 if self.value.abs() <= self.value_error && other.value <= 0.0 => {
                self.unsound()
            }
            // Its derivatives divide by the square of the distance.
            Function2::Atan2 if !RANGE.contains(&self.value.hypot(other.value)) => self.unsound(),
            Function2::Atan2 => self.through2(other, |x, y| x.atan2(y)),
            Function2::Pow => {
                let power = self.through2(other, |x, y| (y * x.ln()).exp());
                // The exponential makes the round-off of its argument a relative one.
                let steepness = 2.0 * ROUND_OFF * power.value.abs().ln().abs();
                Jet {
                    value_error: power.value_error + steepness * power.value.abs(),
                    slope_error: power.slope_error + steepness * power.slope.abs(),
                    ..power
                }
            }
        }
    }

    fn through2(self, other: Jet, f: fn(HyperDual64, HyperDual64) -> HyperDual64) -> Self {
        let parts = |x: [f64; 2], y: [f64; 2]| {
            let x = HyperDual64::new(self.value, x[0], x[1], 0.0);
            let y = HyperDual64::new(other.value, y[0], y[1], 0.0);
            f(x, y)
        };
        let mixed = parts([1.0, 0.0], [0.0, 1.0]);
        let bend_x = parts([1.0, 1.0], [0.0, 0.0]).eps1eps2.abs();
        let bend_y = parts([0.0, 0.0], [1.0, 1.0]).eps1eps2.abs();
        let (by_x, by_y) = (mixed.eps1.abs(), mixed.eps2.abs());
        let bend = mixed.eps1eps2.abs();
        let (a, b) = (self, other);
        Jet {
            value: mixed.re,
            slope: mixed.eps1 * a.slope + mixed.eps2 * b.slope,
            value_error: by_x * a.value_error + by_y * b.value_error,
            slope_error: by_x * a.slope_error
                + by_y * b.slope_error
                + (bend_x * a.slope.abs() + bend * b.slope.abs()) * a.value_error
                + (bend_y * b.slope.abs() + bend * a.slope.abs()) * b.value_error
                + 16.0 * ROUND_OFF * (by_x * a.slope.abs() + by_y * b.slope.abs()),
        }
        .rounded()
        .rounded()
    }

    /// `if a ⋈ b then … else …`; unsound where round-off could decide otherwise.
    pub fn choose(comparison: Comparison, [a, b, then, otherwise]: [Jet; 4]) -> Self {
        let chosen = if comparison.holds(a.value, b.value) {
            then
        } else {
            otherwise
        };
        let clear = (a.value - b.value).abs() > a.value_error + b.value_error;
        if clear { chosen } else { chosen.unsound() }
    }
}

fn taylor(dual: Dual2_64) -> Taylor {
    Taylor {
        value: dual.re,
        first: dual.v1,
        second: dual.v2,
    }
}
