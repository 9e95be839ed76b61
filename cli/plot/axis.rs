//! Numbers and places on axes.

use super::style::DETAIL;

/// A place in pixels of the picture as it is shown.
pub fn px(x: u32, y: u32) -> (i32, i32) {
    let scaled = |v: u32| i32::try_from(v * DETAIL).unwrap_or(i32::MAX);
    (scaled(x), scaled(y))
}

/// A number of an axis that spans a range, in as few digits as tell neighbours
/// apart.
pub fn short(value: f64, range: f64) -> String {
    if value.abs() < 1e-9 * range {
        return "0".to_string();
    }
    if !(1e-6..=1e5).contains(&range) {
        return format!("{value:.1e}").replace(".0e", "e").replace('-', "−");
    }
    let digits = (2.0 - range.log10()).floor().clamp(0.0, 12.0) as usize;
    let text = format!("{value:.digits$}");
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    text.replace('-', "−")
}

/// `10^exponent`, for whole exponents.
pub fn power_of_ten(exponent: f64) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        _ => '⁹',
    };
    let whole = exponent.round();
    if (exponent - whole).abs() > 1e-9 {
        return String::new();
    }
    let digits: String = format!("{whole:.0}").chars().map(raised).collect();
    format!("10{digits}")
}

#[cfg(test)]
mod tests {
    use super::{power_of_ten, short};

    #[test]
    fn numbers_of_an_axis_are_short() {
        assert_eq!(short(-0.5, 2.0), "−0.5");
        assert_eq!(short(0.0, 2.0), "0");
        assert_eq!(short(100.0, 90.0), "100");
        assert_eq!(power_of_ten(-14.0), "10⁻¹⁴");
    }
}
