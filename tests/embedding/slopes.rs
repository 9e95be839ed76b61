//! Derivatives that the interface provides, held against central differences; and states of the
//! first order, which stand behind the velocities.

use bricard_capi::{Engine, List, Quantity, Status};
use bricard_embedding::engine::Engine as SliderCrank;
use bricard_embedding::motor::Motor;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Initial, State};

/// How far is varied, and what differences are off by: its square, and round-off over it.
const VARIATION: f64 = 1e-5;
const NEAR: f64 = 1e-7;

type Crank = Engine<SliderCrank<f64>, 3, 2>;
type Turned = Engine<Motor<f64>, 2, 0>;

/// An engine at a state, and what its input is held at.
fn crank() -> (Crank, State<f64, 3>, f64) {
    let mut engine = Crank::new().expect("the default options are some");
    let input = 0.3;
    engine.hold_input(0, input).expect("there is an input");
    let state = State {
        t: 0.2,
        q: SVector::from([0.4, 0.5, 0.9]),
        v: SVector::from([1.0, -0.4, 0.7]),
    };
    (engine, state, input)
}

/// An engine of a motor at a state, and what its input is held at.
fn motor() -> (Turned, State<f64, 2>, f64) {
    let mut engine = Turned::new().expect("the default options are some");
    let input = 1.5;
    engine.hold_input(0, input).expect("there is an input");
    let state = State {
        t: 0.2,
        q: SVector::from([0.4, 0.0]),
        v: SVector::from([1.0, 0.8]),
    };
    (engine, state, input)
}

/// Holds the derivatives of a quantity against differences, column by column.
macro_rules! assert_slopes {
    ($made:expr, $slope:expr, $of:expr, $freedoms:literal, $n:literal) => {{
        let (mut engine, state, input) = $made;
        let width = $freedoms + $n + 1;
        let (size, rows) = (engine.size($slope), engine.size($of));
        assert_eq!(size, rows * width);
        let mut slopes = vec![0.0; size];
        engine
            .evaluate($slope, Some(state), &mut slopes)
            .expect("a regular position");
        for column in 0..width {
            let mut at = |side: f64| {
                let (mut near, mut values) = (state, vec![0.0; rows]);
                match column {
                    c if c < $freedoms => near.q[c] += side,
                    c if c < $freedoms + $n => near.v[c - $freedoms] += side,
                    _ => engine.hold_input(0, input + side).expect("an input"),
                }
                let done = engine.evaluate($of, Some(near), &mut values);
                done.expect("a regular position");
                engine.hold_input(0, input).expect("an input");
                values
            };
            let (ahead, behind) = (at(VARIATION), at(-VARIATION));
            for row in 0..rows {
                let difference = (ahead[row] - behind[row]) / (2.0 * VARIATION);
                let slope = slopes[row * width + column];
                let most = NEAR * difference.abs().max(1.0);
                assert!(
                    (slope - difference).abs() < most,
                    "row {row}, column {column}: {slope} {difference}"
                );
            }
        }
    }};
}

#[test]
fn accelerations_change_as_their_derivatives_say() {
    assert_slopes!(crank(), Quantity::Slope, Quantity::Acceleration, 3, 3);
    assert_slopes!(motor(), Quantity::Slope, Quantity::Acceleration, 1, 2);
}

#[test]
fn outputs_and_events_change_as_their_derivatives_say() {
    assert_slopes!(crank(), Quantity::OutputSlope, Quantity::Outputs, 3, 3);
    assert_slopes!(motor(), Quantity::OutputSlope, Quantity::Outputs, 1, 2);
    assert_slopes!(crank(), Quantity::EventSlope, Quantity::Events, 3, 3);
    assert_slopes!(motor(), Quantity::EventSlope, Quantity::Events, 1, 2);
}

#[test]
fn where_accelerations_have_no_derivatives_that_is_said() {
    let (mut engine, ..) = crank();
    let half = core::f64::consts::FRAC_PI_2;
    let singular = State {
        t: 0.5,
        q: SVector::from([half, half, 0.0]),
        v: SVector::from([1.0, 1.0, -1.0]),
    };
    let mut slopes = [0.0; 21];
    let refused = engine.evaluate(Quantity::Slope, Some(singular), &mut slopes);
    assert_eq!(refused, Err(Status::Run));
    // The outputs of this one have nothing to do with accelerations.
    let mut outputs = [0.0; 21];
    let done = engine.evaluate(Quantity::OutputSlope, Some(singular), &mut outputs);
    assert_eq!(done, Ok(()));
}

#[test]
fn states_are_started_behind_the_velocities() {
    let (mut engine, ..) = motor();
    assert_eq!(List::of(7), Some(List::States));
    let held = |value| Initial { value, held: true };
    assert_eq!(engine.start_of(1, true), Ok(held(0.5)));
    assert_eq!(engine.start_of(1, false), Err(Status::Index));
    assert_eq!(engine.start_of(2, true), Err(Status::Index));
    engine.set_start(1, true, held(-0.25)).expect("it is there");
    let refused = engine.set_start(1, true, held(f64::NAN));
    assert_eq!(refused, Err(Status::NotFinite));
    engine.assemble(0.0).expect("it assembles");
    assert_eq!(engine.state().expect("it is there").v[1], -0.25);
}
