//! Coordinates with hardly any inertia.

use bricard_runtime::{Interface, Mechanism, Position, assemble};
use bricard_singular::descriptions::hinged_body::HingedBody;

/// A few hundred roundings of numbers of size one.
const ROUND_OFF: f64 = 1e-13;

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
