//! Coordinates with hardly any inertia.

use bricard_fixtures::hinged_body::HingedBody;
use bricard_runtime::{Form, Interface, Mechanism, Options, Position, assemble, simulate};

/// A few hundred roundings of numbers of size one.
const ROUND_OFF: f64 = 1e-13;
/// More steps than a tenth of a turn takes.
const STEPS: u64 = 50;

/// How little the last of the Euler parameters is, so is the inertia of the first one: down to
/// none at all, which is no matter of the velocities.
#[test]
fn velocities_hold_where_a_coordinate_has_hardly_any_inertia() {
    for turned in [
        0.0, 1e-34, 1e-17, 1e-12, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3,
    ] {
        let mechanism = HingedBody::<f64>::default();
        let mut start = mechanism.start();
        start.q[6].value = turned;
        let state = assemble(&mechanism, &start, 0.0).expect("it can be met");
        let mut position = Position::default();
        mechanism.position(&state, &mut position);
        let opening = (position.jacobian * state.v).amax();
        assert!(opening < ROUND_OFF, "{turned}: {opening}");
        let mut turning = [0.0];
        mechanism.outputs(&state, &mut turning);
        // The hinge turns by twice the angle whose sine the last parameter is.
        let error = (turning[0] * (1.0 - 2.0 * turned * turned) - 1.0).abs();
        assert!(error < ROUND_OFF, "{turned}: {error}");
    }
}

/// What has no inertia in one coordinate is no heavier in any form, and no form takes more than
/// a few steps of it.
#[test]
fn all_forms_agree_where_a_coordinate_has_hardly_any_inertia() {
    for turned in [0.0, 1e-160, 1e-34, 1e-17, 1e-9] {
        let mut ends = Form::ALL.iter().map(|form| {
            let mechanism = HingedBody::<f64>::default();
            let mut start = mechanism.start();
            start.q[6].value = turned;
            let state = assemble(&mechanism, &start, 0.0).expect("it can be met");
            let mut options = Options::dop853(0.2, 1e-10);
            options.settings.form = *form;
            let ran = simulate(&mechanism, &state, &options, &mut []);
            let summary = ran.unwrap_or_else(|failure| panic!("{form}, {turned}: {failure}"));
            assert!(
                summary.steps < STEPS,
                "{form}, {turned}: {} steps",
                summary.steps
            );
            summary.end.q
        });
        let reduced = ends.next().expect("the first form");
        for q in ends {
            assert!((q - reduced).amax() < 1e-9, "{turned}: {}", q - reduced);
        }
    }
}
