//! Starts that are given by formulas: they hold to round-off, together with the
//! constraints, or the start is refused.

use bricard::slider_crank::SliderCrank;
use bricard_fixtures::placed::Placed;
use bricard_fixtures::three_cranks::ThreeCranks;
use bricard_runtime::{AssemblyError, Interface, Mechanism, Position, State, assemble};

/// A few hundred roundings of numbers of size one.
const ROUND_OFF: f64 = 1e-13;

fn off_by(mechanism: &Placed<f64>, state: &State<f64, 7>) -> f64 {
    let mut outputs = [0.0; 8];
    mechanism.outputs(state, &mut outputs);
    let spin = 30.0_f64.to_radians();
    let wanted = [
        0.8,
        mechanism.parameters.height,
        0.3,
        0.5,
        -0.2,
        0.0,
        1.0,
        spin,
    ];
    let mut at = Position::default();
    mechanism.position(state, &mut at);
    let errors = outputs
        .iter()
        .zip(wanted)
        .map(|(x, wanted)| (x - wanted).abs());
    let constraint = [at.residual[0], (at.jacobian * state.v + at.drift)[0]];
    let all = errors.chain(constraint.map(f64::abs));
    all.fold(0.0, f64::max)
}

#[test]
fn equations_of_a_start_hold_to_round_off_and_follow_their_parameters() {
    for height in [-1.6, -1.2, 0.4] {
        let mut mechanism = Placed::default();
        mechanism.parameters.height = height;
        let state = assemble(&mechanism, &mechanism.start(), 0.0).expect("it can be met");
        let error = off_by(&mechanism, &state);
        assert!(error < ROUND_OFF, "off by {error} at {height}");
        assert_eq!(state.q[3], 0.8, "a held value stays");
    }
}

#[test]
fn equations_that_can_not_hold_are_named() {
    let mut mechanism = Placed::default();
    mechanism.parameters.height = -3.0;
    let error = assemble(&mechanism, &mechanism.start(), 0.0).expect_err("out of reach");
    assert!(matches!(error, AssemblyError::Start(_)), "{error:?}");
    let text = error.to_string();
    assert!(text.contains("no position near the start"), "{text}");
    assert!(
        text.contains("`tip = [0.8, height] [y]` (line 24) is off by 1"),
        "{text}"
    );
}

#[test]
fn held_values_that_contradict_equations_are_named() {
    let mechanism = Placed::<f64>::default();
    let mut start = mechanism.start();
    for (i, value) in [(0, 0.0), (1, 0.0), (2, 3.0)] {
        (start.v[i].held, start.v[i].value) = (true, value);
    }
    let text = assemble(&mechanism, &start, 0.0)
        .expect_err("it slides faster")
        .to_string();
    assert!(text.contains("no velocities near the start"), "{text}");
    assert!(
        text.contains("`der(knee.x) = 0.3` (line 25) is off by 2.7"),
        "{text}"
    );
    assert!(
        text.contains("contradict each other or the parameters: der(a), der(b), der(x)"),
        "{text}"
    );
    start.q[0].value = f64::NAN;
    let error = assemble(&mechanism, &start, 1.5).expect_err("no number");
    assert_eq!(error, AssemblyError::NotFinite { t: 1.5 });
}

#[test]
fn equations_for_velocities_hold_where_rows_are_the_same() {
    for speed in [4.0_f64, -0.7, 0.0, 30.0] {
        let mut mechanism = ThreeCranks::default();
        mechanism.parameters.speed = speed;
        let state = assemble(&mechanism, &mechanism.start(), 0.0).expect("it can be met");
        for crank in 0..3 {
            let error = (state.v[crank] - speed / 2.0).abs();
            assert!(
                error < ROUND_OFF * speed.abs().max(1.0),
                "{error} of {speed}"
            );
        }
    }
}

/// Nothing can be moved then, which is not to be taken for a singular position.
#[test]
fn an_infinite_inertia_is_told() {
    let mut mechanism = SliderCrank::<f64>::default();
    mechanism.parameters.j2 = f64::INFINITY;
    let assembled = assemble::<f64, _, 3, 2>(&mechanism, &mechanism.start(), 0.0);
    assert_eq!(assembled, Err(AssemblyError::NotFinite { t: 0.0 }));
}
