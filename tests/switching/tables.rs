//! Tables and splines, against their closed forms.

use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Interface, Method, Options, State, StepControl, assemble, simulate};
use bricard_switching::knotted::Knotted;
use bricard_switching::shifted::Shifted;
use bricard_switching::tabled::Tabled;

/// Where the mass is after four seconds: the table pushes by 2 t, then 2, then 8 - 2 t.
const SPEED: f64 = 6.0;
const PLACE: f64 = 12.0;

/// The natural spline through (0, 0), (1, 1), (2, 0), and straight on from there.
fn spline(t: f64) -> (f64, f64) {
    let rising = |b: f64| (1.5 * b - 0.5 * b.powi(3), 1.5 - 1.5 * b * b);
    if t < 0.0 {
        (1.5 * t, 1.5)
    } else if t < 1.0 {
        rising(t)
    } else if t < 2.0 {
        let (value, slope) = rising(2.0 - t);
        (value, -slope)
    } else {
        (-1.5 * (t - 2.0), -1.5)
    }
}

#[test]
fn a_mass_pushed_by_a_table_is_where_its_integral_says() {
    let mechanism = Tabled::default();
    let start = State::new(0.0, SVector::zeros(), SVector::from([0.0, 1.5, 0.0]));
    let fixed = StepControl::Fixed { step: 0.13 };
    for method in Method::ALL {
        let options = Options::new(4.0, method, fixed);
        let end = simulate::<_, _, 3, 1>(&mechanism, &start, &options, &mut [])
            .unwrap_or_else(|failure| panic!("{method}: {failure}"))
            .end;
        assert!((end.v[0] - SPEED).abs() < 1e-13, "{method}: {}", end.v[0]);
        assert!((end.q[0] - PLACE).abs() < 1e-12, "{method}: {}", end.q[0]);
    }
}

#[test]
fn a_coordinate_tied_to_a_spline_follows_it_and_its_derivative() {
    let mechanism = Tabled::default();
    let start = State::new(0.0, SVector::zeros(), SVector::from([0.0, 1.5, 0.0]));
    for until in [0.5, 1.25, 1.75, 3.0] {
        let end = simulate::<_, _, 3, 1>(&mechanism, &start, &Options::dp5(until, 1e-9), &mut [])
            .unwrap_or_else(|failure| panic!("{failure}"))
            .end;
        let (value, slope) = spline(until);
        assert!((end.q[1] - value).abs() < 1e-13, "{} at {until}", end.q[1]);
        assert!((end.v[1] - slope).abs() < 1e-13, "{} at {until}", end.v[1]);
        let mut outputs = [0.0];
        mechanism.outputs(&end, &mut outputs);
        assert!(
            (outputs[0] - slope).abs() < 1e-13,
            "{} at {until}",
            outputs[0]
        );
    }
}

#[test]
fn a_mass_on_a_hill_given_by_a_spline_keeps_its_energy() {
    let mechanism = Tabled::default();
    let start = State::new(
        0.0,
        SVector::from([0.0, 0.0, 0.2]),
        SVector::from([0.0, 1.5, -1.0]),
    );
    let energy =
        |state: &State<f64, 3>| 0.5 * state.v[2].powi(2) + 3.0 * spline(state.q[2] + 1.0).0;
    let end = simulate::<_, _, 3, 1>(&mechanism, &start, &Options::dop853(1.0, 1e-12), &mut [])
        .unwrap_or_else(|failure| panic!("{failure}"))
        .end;
    let off = (energy(&end) - energy(&start)).abs();
    assert!(off < 1e-13, "{off:e} at {end:?}");
    assert!((end.q[2] - 0.2).abs() > 0.5, "it has moved");
}

#[test]
fn a_motion_that_stays_at_knots_of_splines_is_not_stopped_by_them() {
    let mechanism = Knotted::default();
    let start = assemble(&mechanism, &mechanism.start(), 0.0).expect("a start");
    let summary = simulate::<_, _, 3, 2>(&mechanism, &start, &Options::dop853(5.0, 1e-9), &mut [])
        .unwrap_or_else(|failure| panic!("{failure}"));
    // With steps that ended wherever round-off crosses a knot, it takes many times as many.
    assert!(summary.steps < 100, "{} steps", summary.steps);
}

/// The end of the run of masses that splines push, with fixed steps.
fn pushed(method: Method, step: f64) -> State<f64, 2> {
    let start = State::new(0.0, SVector::zeros(), SVector::zeros());
    let options = Options::new(2.0, method, StepControl::Fixed { step });
    simulate::<_, _, 2, 0>(&Shifted::default(), &start, &options, &mut [])
        .unwrap_or_else(|failure| panic!("{method}: {failure}"))
        .end
}

#[test]
fn no_step_goes_across_the_knots_of_a_spline_of_the_time() {
    let fine = pushed(Method::Dop853, 0.01);
    for method in [Method::Dp5, Method::Dop853, Method::Radau5, Method::Radau9] {
        // Cubic forces are integrated exactly between knots.
        let coarse = pushed(method, 0.13);
        assert!((coarse.v[0] + 0.125).abs() < 1e-14, "{method}: {coarse:?}");
        let off = (coarse.q - fine.q).abs().max();
        assert!(off < 1e-13, "{method}: {off:e}");
    }
}
