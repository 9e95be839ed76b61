//! Tables of a thousand and of ten thousand points, against their closed forms.

use crate::points::{SPAN, points};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Interface, Method, Options, State, StepControl, simulate};
use bricard_switching::measured::Measured;

/// The value of a table, its integral from zero and the integral of that, both zero at
/// zero.
fn integrals(points: &[[f64; 2]], at: f64) -> [f64; 3] {
    let (mut sum, mut twice) = (0.0, 0.0);
    let mut from = [0.0, points[0][1]];
    for to in points {
        let end = to[0].min(at);
        let run = (end - from[0]).max(0.0);
        let slope = match to[0] > from[0] {
            true => (to[1] - from[1]) / (to[0] - from[0]),
            false => 0.0,
        };
        twice += run * (sum + run * (from[1] / 2.0 + run * slope / 6.0));
        sum += run * (from[1] + run * slope / 2.0);
        if to[0] >= at {
            return [from[1] + run * slope, sum, twice];
        }
        from = *to;
    }
    let run = at - from[0];
    [
        from[1],
        sum + run * from[1],
        twice + run * (sum + run * from[1] / 2.0),
    ]
}

/// At rest, but for the one that moves through its table and the one that is tied.
fn start(mechanism: &Measured<f64>) -> State<f64, 4> {
    let [_, first] = points(10_000)[0];
    let mut state = State::new(
        0.0,
        SVector::from([0.0, 0.0, 0.0, first]),
        SVector::from([0.0, 0.0, 2.0, 0.0]),
    );
    let mut slope = [0.0];
    mechanism.outputs(&state, &mut slope);
    state.v[3] = slope[0];
    state
}

fn near(found: f64, exact: f64, most: f64, what: &str) {
    let error = (found - exact).abs();
    assert!(
        error < most,
        "{what}: {found} instead of {exact}, off by {error:e}"
    );
}

/// How far runs go in some seconds: every day over hundreds of points, with `BRICARD_LONG=1`
/// over thousands.
fn ends(every_day: f64, long: f64) -> Vec<f64> {
    match std::env::var_os("BRICARD_LONG") {
        None => vec![every_day],
        Some(_) => vec![every_day, long],
    }
}

/// Steps that pass hundreds of points each.
const STEP: f64 = 0.06;

#[test]
fn masses_pushed_by_long_tables_are_where_their_integrals_say() {
    for until in ends(0.1, 0.4) {
        pushed(until);
    }
}

fn pushed(until: f64) {
    let mechanism = Measured::default();
    let (thousand, many) = (points(1_000), points(10_000));
    let fixed = |method| Options::new(until, method, StepControl::Fixed { step: STEP });
    for (options, most) in [
        (fixed(Method::Rk4), 1e-11),
        (fixed(Method::Radau5), 1e-11),
        (Options::dp5(until, 1e-6), 1e-11),
    ] {
        let what = options.method.to_string();
        let end = simulate::<_, _, 4, 1>(&mechanism, &start(&mechanism), &options, &mut [])
            .unwrap_or_else(|failure| panic!("{what}: {failure}"))
            .end;
        let [_, speed, place] = integrals(&thousand, until);
        near(end.v[0], speed, most, &what);
        near(end.q[0], place, most, &what);
        let [_, speed, place] = integrals(&many, until);
        near(end.v[1], speed, most, &what);
        near(end.q[1], place, most, &what);
    }
}

#[test]
fn a_mass_that_moves_along_a_long_table_has_the_energy_of_its_integral() {
    let mechanism = Measured::default();
    for until in ends(0.2, 0.6) {
        let options = Options::dp5(until, 1e-10);
        let end = simulate::<_, _, 4, 1>(&mechanism, &start(&mechanism), &options, &mut [])
            .unwrap_or_else(|failure| panic!("{failure}"))
            .end;
        let [_, work, _] = integrals(&points(1_000), end.q[2]);
        assert!(end.q[2] > 0.3 && end.q[2] < SPAN, "within the table");
        near(end.v[2].powi(2) / 2.0 - 2.0, work, 1e-9, "energy");
    }
}

#[test]
fn a_coordinate_tied_to_a_long_spline_passes_its_points() {
    let mechanism = Measured::default();
    let many = points(10_000);
    for index in [17, 300, 301] {
        let [place, value] = many[index];
        let end = simulate::<_, _, 4, 1>(
            &mechanism,
            &start(&mechanism),
            &Options::dp5(place, 1e-9),
            &mut [],
        )
        .unwrap_or_else(|failure| panic!("{failure}"))
        .end;
        near(end.q[3], value, 1e-12, "value");
        let mut slope = [0.0];
        mechanism.outputs(&end, &mut slope);
        near(end.v[3], slope[0], 1e-9, "slope");
    }
}
