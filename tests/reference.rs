//! The paper's runs against their exact ends, with its step and its method; the Stewart
//! platform of the library against independent equations.

use crate::motion::{Outcome, end, run, run_comparing};
use bricard_runtime::{DynamicsError, Form, IntegrateError, Options, SimulateError};

/// The Stewart platform, by `reference/stewart_platform.py`.
const STEWART: &str = include_str!("reference/stewart_platform.csv");

/// The paper's step (s).
const STEP: f64 = 0.01;

/// What the velocities may break the constraints by (m/s). Next to a singular position
/// a row that vanishes says nothing about velocities, and the branch it stands for says
/// it to the accuracy of the step.
const SPEED_ERROR: f64 = 1e-9;

/// How far the forms may differ after 8 s (rad): a tenth of what the step may be off.
const FORMS_APART: f64 = 2e-6;

/// When the double four-bar passes a singular position within 8 s: zeros of sin q₁
/// of the exact reduction, to the millisecond.
const PASSAGES: [f64; 9] = [
    0.684, 1.095, 2.463, 2.874, 4.242, 4.653, 6.020, 6.432, 7.799,
];

/// A run of the paper; checks the end and the constraints.
fn check(name: &str, until: f64, angle_bound: f64, constraint_bound: f64) -> Outcome {
    let outcome = run_comparing(name, &Options::rk4(until, STEP), equal(name));
    let exact = end(name, until);
    assert_eq!(outcome.error, None, "{name}");
    let error = (outcome.q[0] - exact.q1).abs();
    assert!(
        error <= angle_bound,
        "{name}, {until} s: q1 is off by {error:e}"
    );
    let error = (outcome.v[0] - exact.dq1).abs();
    assert!(
        error <= 10.0 * angle_bound,
        "{name}, {until} s: q1' is off by {error:e}"
    );
    let found = outcome.constraint_error;
    assert!(
        found.position <= constraint_bound,
        "{name}: constraints are off by {found:?}"
    );
    assert!(found.velocity <= SPEED_ERROR, "{name}: {found:?}");
    outcome
}

/// Coordinates that stay equal.
fn equal(name: &str) -> &'static [usize] {
    if name == "double_four_bar" {
        &[0, 2, 4]
    } else {
        &[0, 1]
    }
}

#[test]
fn the_free_slider_crank_ends_where_it_should() {
    let outcome = check("slider_crank", 8.0, 2e-5, 1e-14);
    assert!(
        outcome.apart <= 1e-12,
        "q1 and q2 come apart by {:e}",
        outcome.apart
    );
}

#[test]
fn the_driven_slider_crank_ends_where_it_should() {
    check("slider_crank_driven", 8.0, 1e-5, 1e-13);
    check("slider_crank_driven", 20.0, 5e-5, 1e-13);
}

#[test]
fn the_double_four_bar_ends_where_it_should_with_its_cranks_parallel() {
    let outcome = check("double_four_bar", 8.0, 2e-5, 1e-14);
    assert!(
        outcome.apart <= 1e-12,
        "the cranks come apart by {:e}",
        outcome.apart
    );
    assert!(
        outcome.q[1].abs() <= 1e-12 && outcome.q[3].abs() <= 1e-12,
        "{:?}",
        outcome.q
    );
}

#[test]
fn the_double_four_bar_passes_nine_singular_positions_at_the_exact_times() {
    let outcome = run("double_four_bar", &Options::rk4(8.0, STEP));
    let times: Vec<f64> = outcome.passages.iter().map(|passage| passage.t).collect();
    assert_eq!(times.len(), PASSAGES.len(), "{times:?}");
    for (found, exact) in times.iter().zip(PASSAGES) {
        assert!(
            (found - exact).abs() <= 6e-4,
            "{found} s should be {exact} s"
        );
    }
    for passage in &outcome.passages {
        assert_eq!(
            (passage.rank, passage.regular),
            (2, 4),
            "at {} s",
            passage.t
        );
    }
}

#[test]
fn most_accelerations_take_the_cheap_path() {
    for (name, until) in [
        ("slider_crank", 8.0),
        ("slider_crank_driven", 20.0),
        ("double_four_bar", 8.0),
    ] {
        let counters = run(name, &Options::rk4(until, STEP)).counters;
        let cheap = counters.cheap_accelerations;
        let robust = counters.beside_accelerations + counters.robust_accelerations;
        let share = cheap as f64 / (cheap + robust) as f64;
        assert!(
            share >= 0.95,
            "{name}: {cheap} cheap and {robust} robust accelerations"
        );
    }
}

#[test]
fn the_full_form_gives_the_motion_of_the_reduced_one() {
    for name in ["slider_crank", "slider_crank_driven", "double_four_bar"] {
        let mut options = Options::rk4(8.0, STEP);
        let reduced = run(name, &options);
        options.settings.form = Form::Full;
        let full = run(name, &options);
        assert_eq!(full.error, None, "{name}");
        for (a, b) in full.q.iter().zip(&reduced.q) {
            assert!(
                (a - b).abs() <= FORMS_APART,
                "{name}: {:?} and {:?}",
                full.q,
                reduced.q
            );
        }
    }
}

/// The slider passes over the bearing, and the links of the four-bars lie in a line.
#[test]
fn multipliers_and_partitioning_end_at_the_first_singular_position() {
    for (name, first) in [("slider_crank", 0.6), ("double_four_bar", PASSAGES[0])] {
        let passes = run(name, &Options::rk4(8.0, STEP)).passages;
        let exact = passes.first().expect("a singular position is passed").t;
        assert!(name == "slider_crank" || (exact - first).abs() <= 6e-4);
        for form in [Form::Multipliers, Form::Partitioning] {
            let mut options = Options::rk4(8.0, STEP);
            options.settings.form = form;
            let outcome = run(name, &options);
            let Some(SimulateError::Integrate(IntegrateError::Dynamics(
                error @ DynamicsError::SingularPosition { form: named, .. },
            ))) = outcome.error
            else {
                panic!("{name}, {form}: {:?} at {} s", outcome.error, outcome.t);
            };
            assert_eq!(named, form);
            let away = (error.time() - exact).abs();
            assert!(
                away <= 3.0 * STEP,
                "{name}, {form}: {} s, not {exact} s",
                error.time()
            );
            assert!(
                outcome.t <= exact + 2.0 * STEP,
                "{name}, {form}: went on to {} s",
                outcome.t
            );
        }
    }
}

/// Positions, angles and velocities of the Stewart platform by Newton's and Euler's
/// equations, computed by a program of its own.
#[test]
fn the_stewart_platform_moves_as_newton_and_euler_say() {
    let rows = STEWART.lines().filter(|line| !line.starts_with('#'));
    let mut compared = 0;
    for row in rows.skip(1) {
        let row: Vec<f64> = row.split(',').filter_map(|x| x.parse().ok()).collect();
        let &[t, .., error] = &row[..] else {
            panic!("{row:?}");
        };
        let outcome = run("stewart_platform", &Options::dop853(t, 1e-12));
        assert_eq!(outcome.error, None);
        let ours = outcome.q.iter().chain(&outcome.v);
        for (ours, exact) in ours.zip(&row[1..10]) {
            let off = (ours - exact).abs();
            assert!(off <= 1e-11 + error, "{t} s: {ours} and {exact}");
        }
        compared += 1;
    }
    assert_eq!(compared, 4);
}
