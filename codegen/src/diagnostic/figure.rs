//! Numbers as messages show them.

/// A number with four significant digits, without needless zeros: what a person
/// compares, not what a program reads back.
pub fn figure(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    match rounded.abs() {
        size if (1e-4..1e6).contains(&size) => format!("{rounded}"),
        _ => format!("{rounded:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::figure;

    #[test]
    fn a_figure_has_four_digits_and_no_needless_zeros() {
        assert_eq!(figure(0.1 + 0.2), "0.3");
        assert_eq!(figure(-2.0 / 3.0), "-0.6667");
        assert_eq!(figure(123_456.0), "123500");
        assert_eq!(figure(1.0 / 3e7), "3.333e-8");
        assert_eq!(figure(0.0), "0");
    }
}
