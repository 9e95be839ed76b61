//! Reference motions in numbers of 106 bits, against exact ones.

use bricard_reference::{DoubleDouble, Reference, ReferenceError, reference};
use bricard_runtime::{
    Interface, Mechanism, Options, Pace, Real, Scheme, Visitor, Whole, assemble, simulate,
};

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

/// Runs a reference motion.
struct Motion {
    until: f64,
}

/// Its end: coordinates, velocities, estimated error.
type End = (Vec<DoubleDouble>, Vec<DoubleDouble>, f64);

impl Visitor<DoubleDouble> for Motion {
    type Output = End;

    fn visit<M, const N: usize, const R: usize>(self, mechanism: M) -> End
    where
        M: Mechanism<DoubleDouble, N, R> + Interface<DoubleDouble, N>,
    {
        let mechanism: &dyn Whole<DoubleDouble, N, R> = &mechanism;
        let result: Result<Reference<N>, ReferenceError<N, R>> =
            reference(mechanism, DoubleDouble::from(self.until));
        let motion = result.unwrap_or_else(|error| panic!("{error}"));
        let (q, v) = (motion.end.q, motion.end.v);
        (q.as_slice().to_vec(), v.as_slice().to_vec(), motion.error)
    }
}

fn motion(name: &str, until: f64) -> End {
    bricard::visit(name, Motion { until }).expect("a name of the catalogue")
}

fn number(text: &str) -> DoubleDouble {
    text.parse().expect("a number")
}

fn check(name: &str, what: &str, found: DoubleDouble, exact: &str) {
    let error = (found - number(exact)).abs().to_f64();
    assert!(error <= ERROR, "{name}: {what} = {found}, off by {error:e}");
}

#[test]
fn reference_motions_have_18_decimals_through_singular_positions() {
    for (name, until, angle, rate) in ENDS {
        let (q, v, error) = motion(name, until);
        check(name, "q1", q[0], angle);
        check(name, "q1'", v[0], rate);
        assert!(error <= ERROR, "{name}: estimated error {error:e}");
    }
}

#[test]
fn the_row_of_parallelograms_follows_the_elliptic_functions() {
    let (q, v, _) = motion("n_four_bar", 10.0);
    for crank in 0..3 {
        let (sine, cosine) = q[crank].sin_cos();
        check("n_four_bar", "x", sine, "0.328458111540815378652164");
        check("n_four_bar", "y", cosine, "0.944518538178600962161285");
        check("n_four_bar", "φ'", v[crank], "1.506642180841829469894272");
    }
}

/// Runs an implicit method and the reference; the largest difference of a coordinate.
struct Implicit {
    until: f64,
    tolerance: f64,
}

impl Visitor<DoubleDouble> for Implicit {
    type Output = f64;

    fn visit<M, const N: usize, const R: usize>(self, mechanism: M) -> f64
    where
        M: Mechanism<DoubleDouble, N, R> + Interface<DoubleDouble, N>,
    {
        let mechanism: &dyn Whole<DoubleDouble, N, R> = &mechanism;
        let until = DoubleDouble::from(self.until);
        let exact: Result<Reference<N>, ReferenceError<N, R>> = reference(mechanism, until);
        let exact = exact.unwrap_or_else(|error| panic!("{error}")).end;
        let start = assemble(mechanism, &mechanism.start(), DoubleDouble::default());
        let start = start.unwrap_or_else(|error| panic!("{error}"));
        let tolerance = DoubleDouble::from(self.tolerance);
        let pace = Pace::Adaptive {
            relative: tolerance,
            absolute: tolerance,
        };
        let options = Options::new(until, Scheme::Radau9, pace);
        let run = simulate(mechanism, &start, &options, &mut []);
        let end = run.unwrap_or_else(|failure| panic!("{failure}")).end;
        (end.q - exact.q)
            .iter()
            .fold(0.0, |most: f64, x| most.max(x.to_f64().abs()))
    }
}

#[test]
fn coefficients_of_the_implicit_method_have_more_digits_than_an_f64() {
    let run = Implicit {
        until: 0.25,
        tolerance: 1e-19,
    };
    let error = bricard::visit("slider_crank", run).expect("a name of the catalogue");
    assert!(error <= 1e-20, "{error:e}");
}
