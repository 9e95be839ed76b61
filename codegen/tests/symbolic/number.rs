//! Exact numbers against the arithmetic of whole numbers and correctly rounded
//! reading of decimals.

use super::config;
use bricard_codegen::internals::expr::Number;
use proptest::prelude::*;

fn ratio() -> impl Strategy<Value = Number> {
    (-1_000_000_i128..1_000_000, 1_i128..1_000_000)
        .prop_map(|(n, d)| Number::ratio(n, d).expect("the denominator is not zero"))
}

/// Any number, those that leave the range of exact ones included.
fn any_number() -> impl Strategy<Value = Number> {
    let wide = (any::<i128>(), any::<i128>())
        .prop_map(|(n, d)| Number::ratio(n, d).unwrap_or(Number::ZERO));
    let float = prop_oneof![-1e300..1e300_f64, -1.0..1.0].prop_map(Number::float);
    prop_oneof![ratio(), wide, float]
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn addition_and_multiplication_obey_the_laws_of_a_field(
        a in ratio(),
        b in ratio(),
        c in ratio(),
    ) {
        prop_assert_eq!(a + b, b + a);
        prop_assert_eq!((a + b) + c, a + (b + c));
        prop_assert_eq!((a * b) * c, a * (b * c));
        prop_assert_eq!(a * (b + c), a * b + a * c);
        prop_assert!((a + -a).is_zero());
        if !a.is_zero() {
            let inverse = a.powi(-1).expect("not a power of zero");
            prop_assert!((a * inverse).is_one());
        }
    }

    #[test]
    fn a_fraction_is_in_lowest_terms_with_a_positive_denominator(
        n in -10_000_i128..10_000,
        d in -10_000_i128..10_000,
        k in 1_i128..10_000,
    ) {
        prop_assume!(d != 0);
        prop_assert_eq!(Number::ratio(n, d), Number::ratio(k * n, k * d));
        prop_assert_eq!(Number::ratio(n, d), Number::ratio(-n, -d));
    }

    #[test]
    fn decimal_literals_round_as_correct_rounding_does(
        whole in 0_u64..1_000_000_000_000,
        digits in 0_u64..1_000_000_000_000,
        exponent in -30..30,
    ) {
        let text = format!("{whole}.{digits:012}e{exponent}");
        let read = Number::parse_literal(&text).expect("a literal").to_f64();
        prop_assert_eq!(read, text.parse::<f64>().expect("a literal"), "{}", text);
    }

    #[test]
    fn printed_numbers_read_back(number in ratio()) {
        let text = number.to_string();
        let (above, below) = text.split_once('/').unwrap_or((&text, "1"));
        let sign = if above.starts_with('-') { Number::MINUS_ONE } else { Number::ONE };
        let read = |text: &str| Number::parse_literal(text).expect("digits");
        let above = read(above.trim_start_matches('-')) * sign;
        let back = above * read(below).powi(-1).expect("not zero");
        prop_assert_eq!(back, number, "{}", text);
    }

    #[test]
    fn comparison_is_a_total_order(
        a in any_number(),
        b in any_number(),
        c in any_number(),
    ) {
        prop_assert_eq!(a.cmp(&b), b.cmp(&a).reverse());
        prop_assert_eq!(a.cmp(&b).is_eq(), a == b);
        let mut sorted = [a, b, c];
        sorted.sort();
        prop_assert!(sorted[0] <= sorted[1] && sorted[1] <= sorted[2] && sorted[0] <= sorted[2]);
    }

    #[test]
    fn arithmetic_never_panics_and_stays_near_that_of_floats(
        a in any_number(),
        b in any_number(),
    ) {
        let near = |found: f64, exact: f64, scale: f64| {
            !exact.is_finite() || (found - exact).abs() <= 1e-15 * scale.abs()
        };
        let (x, y) = (a.to_f64(), b.to_f64());
        prop_assert!(near((a + b).to_f64(), x + y, x.abs() + y.abs()));
        prop_assert!(near((a * b).to_f64(), x * y, x * y));
        prop_assert!(near((-a).to_f64(), -x, x));
    }

    #[test]
    fn the_second_part_of_a_constant_is_below_the_round_off_of_the_first(number in ratio()) {
        let (high, low) = number.parts();
        prop_assert_eq!(high, number.to_f64());
        prop_assert!(low.abs() <= f64::EPSILON / 2.0 * high.abs());
    }

    #[test]
    fn the_root_of_a_square_is_exact(number in ratio()) {
        let root = (number * number).exact_sqrt().expect("a square");
        prop_assert_eq!(root, if number.is_negative() { -number } else { number });
        prop_assert_eq!((-(number * number + Number::ONE)).exact_sqrt(), None);
    }
}

#[test]
fn a_power_is_repeated_multiplication() {
    let base = Number::ratio(-3, 7).expect("a ratio");
    let mut product = Number::ONE;
    for exponent in 0..20 {
        assert_eq!(base.powi(exponent), Some(product));
        let inverse = product.powi(-1).expect("not zero");
        assert_eq!(base.powi(-exponent), Some(inverse));
        product = product * base;
    }
    assert_eq!(Number::ZERO.powi(-1), None);
}
