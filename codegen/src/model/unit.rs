//! Units: dimensions as exponents of SI base units.
//!
//! In:  dimensions of symbols, from [`super::unit_names`].
//! Out: [`Unit`]s that formulas are checked with.
//!
//! A number has no unit of its own: it takes that of what it stands beside (`x -
//! 0.1`, `x + 0.5*cos(phi)`, `param L: m = 0.5`), and as a factor of what has a unit
//! it is dimensionless (`1/2*m*v^2`). In the law of an input and in the picture,
//! formulas with numbers are not checked at all (`10 - 2*der(q1)`). A symbol
//! declared without unit, and `t` (so that `sin(2*t)` can be written), switch the
//! check off for every formula they take part in.

/// Exponents are counted in twelfths, so that roots have a unit.
pub const PARTS: i32 = 12;

/// Exponents of the base units, in twelfths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Dimension(pub [i32; 5]);

/// What is known of the unit of a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// A pure number, which takes the unit of what it stands beside.
    Number,
    /// A dimension.
    Known(Dimension),
    /// A symbol without unit takes part.
    Unchecked,
}

pub(super) const fn whole(kg: i32, m: i32, s: i32) -> Dimension {
    Dimension([kg * PARTS, m * PARTS, s * PARTS, 0, 0])
}

/// No dimension: angles, ratios.
pub const NONE: Dimension = whole(0, 0, 0);
/// `1/s`.
pub const PER_SECOND: Dimension = whole(0, 0, -1);
/// `1/s^2`.
pub const FREQUENCY2: Dimension = whole(0, 0, -2);
/// `m^2`.
pub const AREA: Dimension = whole(0, 2, 0);
/// `J = N*m`.
pub const ENERGY: Dimension = whole(1, 2, -2);
/// `W`.
pub const POWER: Dimension = whole(1, 2, -3);

impl Dimension {
    /// The dimension of a product.
    pub fn times(self, other: Dimension) -> Dimension {
        let mut powers = self.0;
        powers
            .iter_mut()
            .zip(other.0)
            .for_each(|(a, b)| *a = a.saturating_add(b));
        Dimension(powers)
    }

    /// The dimension of a power; `None` if its exponents are no twelfths.
    pub fn power(self, exponent: f64) -> Option<Dimension> {
        let mut powers = [0; 5];
        for (power, old) in powers.iter_mut().zip(self.0) {
            let scaled = f64::from(old) * exponent;
            let rounded = scaled.round();
            if (scaled - rounded).abs() > 1e-9 || rounded.abs() > 1e6 {
                return None;
            }
            *power = rounded as i32;
        }
        Some(Dimension(powers))
    }

    /// Whether it is that of a bare number or of its derivatives in time.
    pub fn is_rate(self) -> bool {
        matches!(self.0, [0, 0, _, 0, 0])
    }
}

impl Unit {
    /// A pure number, an angle, a ratio.
    pub const PURE: Unit = Unit::Known(NONE);

    /// The unit of a product.
    pub fn times(self, other: Unit) -> Unit {
        match (self, other) {
            (Unit::Unchecked, _) | (_, Unit::Unchecked) => Unit::Unchecked,
            (Unit::Number, unit) | (unit, Unit::Number) => unit,
            (Unit::Known(a), Unit::Known(b)) => Unit::Known(a.times(b)),
        }
    }

    /// The unit of a power with a numeric exponent.
    pub fn power(self, exponent: f64) -> Unit {
        match self {
            Unit::Known(dimension) => dimension
                .power(exponent)
                .map_or(Unit::Unchecked, Unit::Known),
            unit => unit,
        }
    }

    /// The unit of a sum or of two sides of an equation, or the two that differ.
    pub fn meet(self, other: Unit) -> Result<Unit, (Dimension, Dimension)> {
        match (self, other) {
            (Unit::Known(a), Unit::Known(b)) if a != b => Err((a, b)),
            (Unit::Unchecked, _) | (_, Unit::Unchecked) => Ok(Unit::Unchecked),
            (Unit::Number, unit) | (unit, _) => Ok(unit),
        }
    }

    /// Whether it can be an angle or ratio.
    pub fn is_pure(self) -> bool {
        !matches!(self, Unit::Known(dimension) if dimension != NONE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_takes_the_unit_it_stands_beside() {
        let metre = Unit::Known(whole(0, 1, 0));
        assert_eq!(Unit::Number.meet(metre), Ok(metre));
        assert_eq!(Unit::Number.times(metre), metre);
        assert!(metre.meet(Unit::PURE).is_err());
        assert_eq!(metre.times(Unit::Unchecked), Unit::Unchecked);
    }
}
