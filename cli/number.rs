//! Numbers as text that reads back to the same bits, and the largest of several.
//!
//! In:  numbers.
//! Out: their shortest digits; the largest size, NaN if one of them is NaN.

/// A number in the fewest digits that read back to the same bits.
pub fn exact(value: f64) -> String {
    let text = format!("{value:?}");
    match text.strip_suffix(".0") {
        Some(whole) => whole.to_string(),
        None => text,
    }
}

/// The largest absolute value; NaN if one of them is NaN.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    let sizes = values.into_iter().map(f64::abs);
    sizes.fold(0.0, |most, x| if x > most || x.is_nan() { x } else { most })
}

#[cfg(test)]
mod tests {
    use super::{exact, largest};
    use bricard_testkit::Random;

    #[test]
    fn printed_numbers_read_back_to_the_same_bits() {
        let mut random = Random::seeded(1);
        let values = (0..10_000).map(|_| f64::from_bits(random.bits()));
        for value in values.filter(|value| value.is_finite()) {
            let read: f64 = exact(value).parse().unwrap_or(f64::NAN);
            assert_eq!(read.to_bits(), value.to_bits(), "{value:?}");
        }
        assert_eq!(exact(-0.0), "-0");
        assert_eq!(exact(4.0), "4");
        assert_eq!(exact(1e-300), "1e-300");
    }

    #[test]
    fn the_largest_of_numbers_is_nan_if_one_is_nan() {
        assert_eq!(largest([1.0, -3.0, 2.0]), 3.0);
        for values in [[f64::NAN, 1.0], [1.0, f64::NAN]] {
            assert!(largest(values).is_nan());
        }
    }
}
