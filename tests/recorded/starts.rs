//! Guesses of formulas at the start.

use bricard_recorded::guessed::{Guessed, Parameters};
use bricard_runtime::{Interface, Mechanism, assemble};

fn begun(height: f64) -> (f64, f64, f64) {
    let mechanism = Guessed {
        parameters: Parameters {
            height,
            ..Parameters::default()
        },
    };
    let start = mechanism.start();
    let state =
        assemble::<f64, _, 3, 2>(&mechanism, &start, 0.0).unwrap_or_else(|error| panic!("{error}"));
    assert!((state.q[2] - 0.6).abs() < 1e-15, "it is held");
    let mut position = Default::default();
    Mechanism::<f64, 3, 2>::position(&mechanism, &state, &mut position);
    let off = position.residual.amax();
    assert!(off < 1e-14, "{off} at {state:?}");
    (0.5 * state.q[0].sin(), state.v[0], state.v[2])
}

#[test]
fn a_guess_of_a_formula_tells_the_branch_and_does_not_hold() {
    // Of the two ways in which the loop closes, the one whose joint is nearer. By the law of
    // cosines the joint is 0.49 above or below the line.
    let reach: f64 = (0.5_f64.powi(2) + 0.6_f64.powi(2) - 0.7_f64.powi(2)) / (2.0 * 0.6);
    let exact = (0.25 - reach * reach).sqrt();
    let (above, ..) = begun(0.3);
    assert!((above - exact).abs() < 1e-14, "{above}");
    let (below, ..) = begun(-0.3);
    assert!((below + exact).abs() < 1e-14, "{below}");
}

#[test]
fn a_guess_that_can_not_be_met_is_none() {
    let (height, w, v) = begun(5.0);
    assert!(height.abs() > 0.3 && w.is_finite() && v.is_finite());
}
