//! The names of units.
//!
//! In:  units as written behind `:`; dimensions.
//! Out: their dimensions; names of these in messages.
//!
//! Not here: units other than SI. A factor hidden in a unit would be a wrong
//! program, so `mm`, `deg` and the like are refused with the SI unit to write.

use super::unit::{Dimension, ENERGY, NONE, PARTS};
use crate::diagnostic::{Diagnostic, nearest};
use crate::syntax::ast::UnitExpr;
use crate::syntax::messages::did_you_mean;

/// The base units, in the order of the exponents of a [`Dimension`].
const BASE: [&str; 5] = ["kg", "m", "s", "A", "K"];

/// SI units with their exponents of kg, m, s, A, K.
pub const NAMED: [(&str, [i32; 5]); 21] = [
    ("kg", [1, 0, 0, 0, 0]),
    ("m", [0, 1, 0, 0, 0]),
    ("s", [0, 0, 1, 0, 0]),
    ("A", [0, 0, 0, 1, 0]),
    ("K", [0, 0, 0, 0, 1]),
    ("rad", [0, 0, 0, 0, 0]),
    ("sr", [0, 0, 0, 0, 0]),
    ("N", [1, 1, -2, 0, 0]),
    ("J", [1, 2, -2, 0, 0]),
    ("W", [1, 2, -3, 0, 0]),
    ("Pa", [1, -1, -2, 0, 0]),
    ("Hz", [0, 0, -1, 0, 0]),
    ("V", [1, 2, -3, -1, 0]),
    ("C", [0, 0, 1, 1, 0]),
    ("F", [-1, -2, 4, 2, 0]),
    ("H", [1, 2, -2, -2, 0]),
    ("T", [1, 0, -2, -1, 0]),
    ("Wb", [1, 2, -2, -1, 0]),
    ("ohm", [1, 2, -3, -2, 0]),
    ("Ohm", [1, 2, -3, -2, 0]),
    ("S", [-1, -2, 3, 2, 0]),
];

/// Units that hide a factor, with the SI unit and the factor.
const SCALED: [(&str, &str, &str); 37] = [
    ("mm", "m", "1e-3"),
    ("cm", "m", "1e-2"),
    ("dm", "m", "1e-1"),
    ("um", "m", "1e-6"),
    ("nm", "m", "1e-9"),
    ("km", "m", "1e3"),
    ("inch", "m", "0.0254"),
    ("ft", "m", "0.3048"),
    ("g", "kg", "1e-3"),
    ("mg", "kg", "1e-6"),
    ("t", "kg", "1e3"),
    ("lb", "kg", "0.45359237"),
    ("ms", "s", "1e-3"),
    ("us", "s", "1e-6"),
    ("ns", "s", "1e-9"),
    ("min", "s", "60"),
    ("h", "s", "3600"),
    ("deg", "rad", "deg"),
    ("rev", "rad", "2*pi"),
    ("rpm", "rad/s", "2*pi/60"),
    ("mN", "N", "1e-3"),
    ("kN", "N", "1e3"),
    ("MN", "N", "1e6"),
    ("Nm", "N*m", "1"),
    ("mJ", "J", "1e-3"),
    ("kJ", "J", "1e3"),
    ("MJ", "J", "1e6"),
    ("mW", "W", "1e-3"),
    ("kW", "W", "1e3"),
    ("MW", "W", "1e6"),
    ("kPa", "Pa", "1e3"),
    ("MPa", "Pa", "1e6"),
    ("GPa", "Pa", "1e9"),
    ("bar", "Pa", "1e5"),
    ("kHz", "Hz", "1e3"),
    ("mA", "A", "1e-3"),
    ("mV", "V", "1e-3"),
];

/// Units that are written out or shortened otherwise, in the singular.
const WRITTEN_OUT: [(&str, &str); 23] = [
    ("sec", "s"),
    ("second", "s"),
    ("minute", "min"),
    ("hour", "h"),
    ("meter", "m"),
    ("metre", "m"),
    ("millimeter", "mm"),
    ("millimetre", "mm"),
    ("centimeter", "cm"),
    ("centimetre", "cm"),
    ("kilometer", "km"),
    ("kilometre", "km"),
    ("kilogram", "kg"),
    ("gram", "g"),
    ("newton", "N"),
    ("joule", "J"),
    ("watt", "W"),
    ("pascal", "Pa"),
    ("hertz", "Hz"),
    ("volt", "V"),
    ("ampere", "A"),
    ("radian", "rad"),
    ("degree", "deg"),
];

/// The longest name, in bytes, that is split into units.
const LONGEST: usize = 20;

/// The names of units.
pub fn units() -> impl Iterator<Item = &'static str> {
    NAMED.iter().map(|(name, _)| *name)
}

/// Units that hide a factor, with that factor.
pub fn scaled_units() -> impl Iterator<Item = (&'static str, &'static str)> {
    SCALED.iter().map(|(name, _, factor)| (*name, *factor))
}

/// What to write instead of a unit in an expression, if the name is that of one and hardly
/// meant for anything else.
pub fn in_expression(name: &str) -> Option<String> {
    let scaled = || SCALED.iter().find(|(known, ..)| *known == name);
    let (unit, value) = match NAMED.iter().find(|(known, _)| *known == name) {
        _ if name.len() == 1 => return None,
        Some(("rad" | "sr", _)) => return Some("angles are in radians: leave the unit out".into()),
        Some((known, _)) => (*known, "1"),
        None => scaled().map(|(_, unit, factor)| (*unit, *factor))?,
    };
    Some(format!(
        "units stand behind `:` in declarations: declare `const c0: {unit} = {value};` and \
         write `c0`"
    ))
}

/// The dimension of a unit as written.
pub fn resolve(unit: &UnitExpr) -> Result<Dimension, Box<Diagnostic>> {
    let mut total = NONE;
    for (name, exponent) in &unit.factors {
        let Some((_, powers)) = NAMED.iter().find(|(known, _)| *known == name.text) else {
            let error = Diagnostic::error(name.span, unknown(&name.text));
            let help = instead_of_all(unit).unwrap_or_else(|| instead(&name.text, *exponent));
            return Err(Box::new(error.help(help)));
        };
        let mut factor = Dimension(*powers);
        factor
            .0
            .iter_mut()
            .for_each(|power| *power *= PARTS * exponent);
        total = total.times(factor);
    }
    Ok(total)
}

fn unknown(name: &str) -> String {
    match SCALED.iter().find(|(known, ..)| *known == name) {
        Some((_, "N*m", _)) => format!("`{name}` is written `N*m`"),
        Some(_) => format!("`{name}` is not an SI unit"),
        None => format!("unknown unit `{name}`"),
    }
}

/// What to write instead of `m2`, `mm2` and `kgm2`: names and powers without signs between
/// them.
fn run_together(name: &str, exponent: i32) -> Option<String> {
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let power = name[letters.len()..].parse::<i32>().ok();
    if let (Some(power @ 2..=9), Some((_, si, factor))) =
        (power, prefixed().find(|(known, ..)| *known == letters))
    {
        let si = match si.chars().all(char::is_alphanumeric) {
            true => format!("{si}^{power}"),
            false => format!("({si})^{power}"),
        };
        let total = exponent * power;
        let size = total.unsigned_abs();
        return Some(match total {
            0.. => format!("write SI: `{si}`, and multiply the value by `({factor})^{size}`"),
            _ => format!("write SI: `{si}`, and divide the value by `({factor})^{size}`"),
        });
    }
    let factors = split(name)?;
    let product = factors.join("*");
    Some(match factors.len() {
        1 => format!("write `{product}`"),
        _ if exponent == 1 => format!("write `{product}`"),
        _ => format!("write `({product})`"),
    })
}

/// The units with a factor.
fn prefixed() -> impl Iterator<Item = &'static (&'static str, &'static str, &'static str)> {
    SCALED.iter().filter(|(.., factor)| *factor != "1")
}

/// The units and powers that a name is put together of, none of them with a prefix.
fn split(name: &str) -> Option<Vec<String>> {
    if name.is_empty()
        || name.len() > LONGEST
        || prefixed().any(|(known, ..)| name.starts_with(known))
    {
        return None;
    }
    let mut units: Vec<&str> = units().filter(|unit| name.starts_with(unit)).collect();
    units.sort_by_key(|unit| std::cmp::Reverse(unit.len()));
    units.into_iter().find_map(|unit| {
        let rest = &name[unit.len()..];
        let power = rest.chars().take_while(char::is_ascii_digit).count();
        let (power, rest) = rest.split_at(power);
        let first = match power {
            "" => unit.to_string(),
            _ => format!("{unit}^{power}"),
        };
        let mut factors = vec![first];
        if !rest.is_empty() {
            factors.extend(split(rest)?);
        }
        Some(factors)
    })
}

/// What to write instead of a unit of which several names are refused, as of `km/h`.
fn instead_of_all(unit: &UnitExpr) -> Option<String> {
    let power = |base: &str, exponent: i32| {
        let is_power = exponent.abs() > 1 && !base.chars().all(char::is_alphanumeric);
        let base = match is_power || base.contains(['*', '/']) {
            true => format!("({base})"),
            false => base.to_string(),
        };
        (base, PARTS * exponent)
    };
    let (mut units, mut factors, mut refused) = (Vec::new(), Vec::new(), 0);
    for (name, exponent) in &unit.factors {
        if NAMED.iter().any(|(known, _)| *known == name.text) {
            units.push(power(&name.text, *exponent));
            continue;
        }
        let (_, si, factor) = SCALED.iter().find(|(known, ..)| *known == name.text)?;
        units.push(power(si, *exponent));
        factors.extend((*factor != "1").then(|| power(factor, *exponent)));
        refused += 1;
    }
    let text = |powers: &[(String, i32)]| {
        let powers: Vec<_> = powers.iter().map(|(base, p)| (base.as_str(), *p)).collect();
        quotient(&powers)
    };
    (refused > 1 && !factors.is_empty()).then(|| {
        let (si, factor) = (text(&units), text(&factors));
        format!("write SI: `{si}`, and multiply the value by `{factor}`")
    })
}

fn instead(name: &str, exponent: i32) -> String {
    if let Some((_, si, factor)) = SCALED.iter().find(|(known, ..)| *known == name) {
        let alone = exponent == 1 || si.chars().all(char::is_alphanumeric);
        let si = if alone {
            si.to_string()
        } else {
            format!("({si})")
        };
        return match (*factor, exponent) {
            ("1", _) => format!("write `{si}`"),
            (_, 1) => format!("write SI: `{si}`, and multiply the value by `{factor}`"),
            (_, -1) => format!("write SI: `{si}`, and divide the value by `{factor}`"),
            (_, 2..) => {
                format!("write SI: `{si}`, and multiply the value by `({factor})^{exponent}`")
            }
            _ => format!(
                "write SI: `{si}`, and divide the value by `({factor})^{}`",
                exponent.unsigned_abs()
            ),
        };
    }
    let lower = name.to_lowercase();
    let is_it = |long: &str| lower == long || lower.strip_suffix('s') == Some(long);
    if let Some((_, short)) = WRITTEN_OUT.iter().find(|(long, _)| is_it(long)) {
        return match units().any(|unit| unit == *short) {
            true => format!("write `{short}`"),
            false => instead(short, exponent),
        };
    }
    if let Some(help) = run_together(name, exponent) {
        return help;
    }
    let known = NAMED.iter().map(|(known, _)| *known);
    match nearest(name, known) {
        Some(near) => did_you_mean(near),
        None => {
            "units are products of m, kg, s, rad, N, J, W, Pa, Hz, A, V, K and their powers".into()
        }
    }
}

impl Dimension {
    /// What has this dimension, in words.
    pub fn said(self) -> String {
        if self == NONE {
            "this has no unit".into()
        } else {
            format!("this is in {}", self.text())
        }
    }

    /// Its name in a message.
    pub fn text(self) -> String {
        if self == NONE {
            return "no unit".into();
        }
        if self == ENERGY {
            return "N*m".into();
        }
        let exact = |powers: &[i32; 5]| powers.map(|power| power * PARTS) == self.0;
        let spoken = ["N", "W", "Pa", "V"];
        if let Some((name, _)) = NAMED.iter().find(|(n, p)| spoken.contains(n) && exact(p)) {
            return (*name).into();
        }
        let [kg, m, s, ..] = self.0;
        let with_newton =
            (kg == PARTS).then_some([(NEWTON, kg), ("m", m - PARTS), ("s", s + 2 * PARTS)]);
        let plain: Vec<_> = BASE.into_iter().zip(self.0).collect();
        let size = |powers: &[(&str, i32)]| powers.iter().map(|(_, p)| p.abs()).sum::<i32>();
        match with_newton {
            Some(powers) if self.0[3..] == [0, 0] && size(&powers) < size(&plain) => {
                quotient(&powers)
            }
            _ => quotient(&plain),
        }
    }
}

const NEWTON: &str = "N";

/// A product of powers as a quotient of products.
fn quotient(powers: &[(&str, i32)]) -> String {
    let side = |below: bool| -> Vec<String> {
        let powers = powers.iter().filter(|(_, p)| (*p < 0) == below && *p != 0);
        powers
            .map(|(name, p)| format!("{name}{}", exponent_text(p.abs())))
            .collect()
    };
    let (above, below) = (side(false), side(true));
    let numerator = if above.is_empty() {
        "1".to_string()
    } else {
        above.join("*")
    };
    match below.len() {
        0 => numerator,
        1 => format!("{numerator}/{}", below[0]),
        _ => format!("{numerator}/({})", below.join("*")),
    }
}

fn exponent_text(twelfths: i32) -> String {
    if twelfths == PARTS {
        String::new()
    } else if twelfths % PARTS == 0 {
        format!("^{}", twelfths / PARTS)
    } else {
        let divisor = (1..=PARTS)
            .rev()
            .find(|d| twelfths % d == 0 && PARTS % d == 0)
            .unwrap_or(1);
        format!("^({}/{})", twelfths / divisor, PARTS / divisor)
    }
}

#[cfg(test)]
mod tests {
    use super::super::unit::whole;
    use super::*;

    #[test]
    fn dimensions_are_named_as_people_write_them() {
        assert_eq!(whole(1, 1, -2).text(), "N");
        assert_eq!(whole(0, 1, -2).text(), "m/s^2");
        assert_eq!(whole(0, 0, -1).text(), "1/s");
        assert_eq!(whole(1, -1, -1).text(), "kg/(m*s)");
        assert_eq!(whole(1, 0, -2).text(), "N/m");
        assert_eq!(whole(1, 1, -1).text(), "N*s");
        assert_eq!(
            whole(0, 1, 0).power(0.5).map(Dimension::text),
            Some("m^(1/2)".into())
        );
        assert_eq!(NONE.text(), "no unit");
    }
}
