//! Coordinates so small that the absolute tolerance leaves them few digits.
//!
//! In:  the rows of runs with steps of adaptive length.
//! Out: warnings, one for each unit.

use bricard_runtime::Structure;

/// Part of the largest coordinate by which a step may be off.
const COARSE: f64 = 1e-3;
/// Part of the tolerance below which coordinates are round-off.
const NOTHING: f64 = 1e-6;

/// The largest values of coordinates.
pub struct Sizes {
    /// Error that a step may have whatever the coordinates are; none where steps are fixed.
    absolute: Option<f64>,
    /// Units, each with the largest value of the coordinates that have it.
    largest: Vec<(String, f64)>,
    /// For each coordinate the place of its unit; none for angles, whose size is one by nature.
    units: Vec<Option<usize>>,
}

impl Sizes {
    /// Nothing is known yet of the coordinates.
    pub fn new(structure: &Structure, absolute: Option<f64>) -> Self {
        let mut largest: Vec<(String, f64)> = Vec::new();
        let mut place = |unit: &str| match unit {
            "rad" | "deg" => None,
            unit => Some(match largest.iter().position(|(other, _)| other == unit) {
                Some(place) => place,
                None => {
                    largest.push((unit.to_string(), 0.0));
                    largest.len() - 1
                }
            }),
        };
        let coordinates = structure.coordinates.iter();
        let units = coordinates.map(|quantity| place(quantity.unit)).collect();
        Self {
            absolute,
            largest,
            units,
        }
    }

    /// Takes note of the coordinates of a row, which come behind the time.
    pub fn note(&mut self, row: &[f64]) {
        for (value, unit) in row.iter().skip(1).zip(&self.units) {
            let largest = unit.and_then(|unit| self.largest.get_mut(unit));
            if let Some((_, largest)) = largest {
                *largest = largest.max(value.abs());
            }
        }
    }

    /// What to say of coordinates that are not much larger than the tolerance.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        let absolute = self.absolute.unwrap_or(0.0);
        let is_coarse = move |size: f64| absolute > COARSE * size && size > NOTHING * absolute;
        let coarse = self
            .largest
            .iter()
            .filter(move |(_, size)| is_coarse(*size));
        coarse.map(move |(unit, size)| {
            let of = match unit.as_str() {
                "" => "without a unit".to_string(),
                unit => format!("in {unit}"),
            };
            format!(
                "warning: coordinates {of} are {size:.1e} at most, and each step may be off by \
                 {absolute:.1e}, the absolute tolerance; give a smaller one with `--atol`"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bricard_runtime::Quantity;

    const fn of(name: &'static str, unit: &'static str) -> Quantity {
        Quantity {
            name,
            unit,
            docs: "",
        }
    }

    const STRUCTURE: Structure = Structure {
        coordinates: &[of("a", "rad"), of("x", "m"), of("y", "m"), of("s", "")],
        ..Structure::PLAIN
    };

    fn said(absolute: Option<f64>, row: &[f64]) -> Vec<String> {
        let mut sizes = Sizes::new(&STRUCTURE, absolute);
        sizes.note(&[0.0; 9]);
        sizes.note(row);
        sizes.warnings().collect()
    }

    #[test]
    fn lengths_that_are_not_much_larger_than_the_tolerance_are_named() {
        let row = [1.0, 1e-9, -2e-7, 1e-8, 5.0];
        let [warning] = &said(Some(1e-9), &row)[..] else {
            panic!("one warning");
        };
        assert!(
            warning.contains("coordinates in m are 2.0e-7 at most"),
            "{warning}"
        );
        assert_eq!(said(Some(1e-10), &row), [""; 0]);
        assert_eq!(said(None, &row), [""; 0]);
    }

    #[test]
    fn round_off_is_no_size() {
        assert_eq!(said(Some(1e-9), &[1.0, 1.0, 0.0, 1e-17, 0.0]), [""; 0]);
    }
}
