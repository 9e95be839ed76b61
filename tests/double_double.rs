//! Reference motions in numbers of 106 bits, against exact ones.

use bricard::double_four_bar::DoubleFourBar;
use bricard::n_four_bar::NFourBar;
use bricard::slider_crank::SliderCrank;
use bricard::slider_crank_driven::SliderCrankDriven;
use bricard_reference::{DoubleDouble, Reference, ReferenceError, reference};
use bricard_runtime::{Method, Options, Real, StepControl, Whole, assemble, simulate};

/// What a reference motion may be off by (m, rad, m/s, rad/s).
const ERROR: f64 = 1e-18;

/// Ends of motions: mechanism, time (s), first coordinate and its velocity.
///
/// The paper's examples by Gauss–Legendre collocation of order 20 with 34 digits on
/// the exact reduction (`tests/reduction.rs` states it), two step sizes agreeing to
/// 1e-21; the velocity of the double four-bar from its energy. The N-four-bar by
/// elliptic functions: with `k = 3g(3N+1)/(2(4N+1))`, `φ/2 = am(t/2 | −4k)`.
const ENDS: [(&str, f64, &str, &str); 3] = [
    (
        "slider_crank",
        8.0,
        "-1.962686419093815250880",
        "-3.684010995488191536980",
    ),
    (
        "slider_crank_driven",
        8.0,
        "35.501177212785511765621",
        "4.890780775913958135451",
    ),
    (
        "double_four_bar",
        8.0,
        "-1.528710001192138201764",
        "-8.581436319158871060755",
    ),
];

/// The end of a reference motion: coordinates, velocities, estimated error.
type End = (Vec<DoubleDouble>, Vec<DoubleDouble>, f64);

fn motion<const N: usize, const R: usize>(
    mechanism: &dyn Whole<DoubleDouble, N, R>,
    until: f64,
) -> End {
    let result: Result<Reference<N>, ReferenceError<N, R>> =
        reference(mechanism, DoubleDouble::from(until));
    let motion = result.unwrap_or_else(|error| panic!("{error}"));
    let (q, v) = (motion.end.q, motion.end.v);
    (q.as_slice().to_vec(), v.as_slice().to_vec(), motion.error)
}

fn number(text: &str) -> DoubleDouble {
    text.parse().expect("a number")
}

fn check(name: &str, what: &str, found: DoubleDouble, exact: &str) {
    let error = (found - number(exact)).abs().to_f64();
    assert!(error <= ERROR, "{name}: {what} = {found}, off by {error:e}");
}

/// The end of one of the paper's examples.
fn example(name: &str, until: f64) -> End {
    match name {
        "slider_crank" => motion(&SliderCrank::default(), until),
        "slider_crank_driven" => motion(&SliderCrankDriven::default(), until),
        "double_four_bar" => motion(&DoubleFourBar::default(), until),
        other => panic!("{other} is no example of the paper"),
    }
}

/// Holds the ends of some motions against exact ones.
fn ends(motions: &[(&str, f64, &str, &str)]) {
    for &(name, until, angle, rate) in motions {
        let (q, v, error) = example(name, until);
        check(name, "q1", q[0], angle);
        check(name, "q1'", v[0], rate);
        assert!(error <= ERROR, "{name}: estimated error {error:e}");
    }
}

#[test]
fn a_reference_motion_has_18_decimals_through_singular_positions() {
    ends(&ENDS[..1]);
}

#[test]
#[ignore = "long: two motions of eight seconds in numbers of 106 bits"]
fn reference_motions_have_18_decimals_through_singular_positions() {
    ends(&ENDS[1..]);
}

#[test]
fn the_row_of_parallelograms_follows_the_elliptic_functions() {
    let (q, v, _) = motion(&NFourBar::default(), 10.0);
    for crank in 0..3 {
        let (sine, cosine) = q[crank].sin_cos();
        check("n_four_bar", "x", sine, "0.328458111540815378652164");
        check("n_four_bar", "y", cosine, "0.944518538178600962161285");
        check("n_four_bar", "φ'", v[crank], "1.506642180841829469894272");
    }
}

#[test]
fn coefficients_of_the_implicit_method_have_more_digits_than_an_f64() {
    let mechanism: &dyn Whole<DoubleDouble, 3, 2> = &SliderCrank::default();
    let until = DoubleDouble::from(0.25);
    let exact: Result<Reference<3>, ReferenceError<3, 2>> = reference(mechanism, until);
    let exact = exact.unwrap_or_else(|error| panic!("{error}"));
    let start = assemble(mechanism, &mechanism.start(), DoubleDouble::default());
    let start = start.unwrap_or_else(|error| panic!("{error}"));
    let tolerance = DoubleDouble::from(1e-19);
    let step_control = StepControl::Adaptive {
        relative: tolerance,
        absolute: tolerance,
    };
    let options = Options::new(until, Method::Radau9, step_control);
    let run = simulate(mechanism, &start, &options, &mut []);
    let end = run.unwrap_or_else(|failure| panic!("{failure}")).end;
    let off = (end.q - exact.end.q).map(|x| x.abs().to_f64()).max();
    assert!(off <= 1e-20, "{off:e}");
}
