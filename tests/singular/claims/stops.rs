//! Laws of time that turn back beside a dead centre, and in it: states there need not lose
//! more digits than round-off takes. A kink, at which no smooth motion goes on.

use bricard_runtime::{
    DynamicsError, IntegrateError, Method, Options, SimulateError, Singularity, Whole, assemble,
    simulate,
};
use bricard_singular::descriptions::driven_crank::DrivenCrank;
use bricard_singular::descriptions::pulled_over::PulledOver;
use bricard_singular::{Score, find, run_all};
use core::f64::consts::FRAC_PI_2;

fn right(places: &[(u64, usize)]) {
    let series = find("driven_stops").expect("it is a series");
    let trial = |(seed, place): &(u64, usize)| series.trials(*seed, *place..place + 1, &[]);
    for ran in run_all(places.iter().flat_map(trial).collect()) {
        let why = &ran.verdict.why;
        assert_eq!(ran.verdict.score, Score::Right, "{}\n    {why}", ran.trial);
    }
}

/// Between nodes that are nearly singular themselves an interpolation has fewer digits than
/// the equations at the state, or a velocity that is not the sheet's.
#[test]
fn states_between_poor_nodes_are_as_good_as_without_any() {
    right(&[(77, 334), (77, 825), (77, 1094), (902, 51)]);
}

/// Where the sine hardly changes, nodes of a spacing that is kept as a change of the sine move
/// together, until round-off is all that lies between them.
#[test]
fn nodes_do_not_move_together_where_the_law_of_time_stops() {
    right(&[(7, 22), (101, 272), (104, 198), (104, 498)]);
}

/// A law that stops a little beyond a dead centre crosses it twice; what it does at an instant
/// between does not say where.
#[test]
fn a_law_of_time_that_turns_between_two_crossings_is_followed() {
    right(&[(1, 71), (1, 91), (1, 103)]);
}

/// A law that turns exactly in a dead centre passes nothing there: the inside of a step may be
/// beyond it by a part of the tolerance all the same. One that turns a little beyond passes twice.
#[test]
fn a_law_of_time_that_turns_in_a_dead_centre_passes_nothing() {
    let methods = [Method::Dop853, Method::Dp5, Method::Radau5, Method::Radau9];
    for (place, beyond) in (0..24).zip([0.0, 1e-6, 0.0, -1e-6, 0.0].into_iter().cycle()) {
        let mut mechanism = DrivenCrank::<f64>::default();
        // It turns at t = w/a.
        let (w, a) = (
            1.5 + 0.05 * f64::from(place),
            2.3 + 0.31 * f64::from(place % 7),
        );
        let parameters = &mut mechanism.parameters;
        (parameters.w, parameters.al) = (w, -a);
        parameters.p0 = FRAC_PI_2 + beyond - w * w / (2.0 * a);
        let mechanism: &dyn Whole<f64, 4, 3> = &mechanism;
        let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
        for tolerance in [1e-6, 1e-8, 1e-10, 1e-11] {
            let options = Options {
                method: methods[place as usize % methods.len()],
                ..Options::dop853(1.9 * w / a, tolerance)
            };
            let name = format!("{:?} {tolerance:e} {w} {a} {beyond:e}", options.method);
            let ran = simulate(mechanism, &start, &options, &mut []);
            let summary = ran.unwrap_or_else(|failure| panic!("{name}: {failure}"));
            let expected = if beyond > 0.0 { 2 } else { 0 };
            assert_eq!(summary.passages, Some(expected), "{name}");
        }
    }
}

/// The length of a rope's part has a kink where it becomes zero. The run ends there, with the
/// energy that it began with: no projection takes the velocity away.
#[test]
fn a_run_ends_where_a_constraint_has_a_kink() {
    let mechanism = PulledOver::<f64>::default();
    let mechanism: &dyn Whole<f64, 5, 2> = &mechanism;
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    // Both are accelerated by half of g.
    let (arrival, speed) = ((4.0_f64 / 9.81).sqrt(), (4.0 * 9.81 / 4.0_f64).sqrt());
    for method in [Method::Dop853, Method::Dp5, Method::Radau5, Method::Radau9] {
        for tolerance in [1e-4, 1e-6, 1e-9, 1e-11] {
            let options = Options {
                method,
                ..Options::dop853(1.0, tolerance)
            };
            let name = format!("{method:?} {tolerance:e}");
            let failure = simulate(mechanism, &start, &options, &mut []).expect_err(&name);
            let end = failure.summary.end;
            let SimulateError::Integrate(IntegrateError::Dynamics(
                DynamicsError::SingularConfiguration { kind, .. },
            )) = failure.error
            else {
                panic!("{name}: {failure}");
            };
            assert_eq!(kind, Singularity::Kink, "{name}");
            let (late, fast) = ((end.t - arrival).abs(), (end.v[1] - speed).abs());
            assert!(late < 10.0 * tolerance + 1e-8, "{name}: {}", end.t);
            assert!(fast < 50.0 * tolerance + 1e-7, "{name}: {}", end.v);
            assert!(
                failure.summary.steps < 2000,
                "{name}: {}",
                failure.summary.steps
            );
        }
    }
}

/// So does a run of steps of one length, which are halved there to no avail.
#[test]
fn a_run_of_fixed_steps_ends_where_a_constraint_has_a_kink() {
    let mechanism = PulledOver::<f64>::default();
    let mechanism: &dyn Whole<f64, 5, 2> = &mechanism;
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    let arrival = (4.0_f64 / 9.81).sqrt();
    let methods = [
        Method::Rk4,
        Method::Dop853,
        Method::Dp5,
        Method::Radau5,
        Method::Radau9,
    ];
    for method in methods {
        for step in [0.05, 0.02, 1e-2, 4e-3, 1.7e-3, 1e-3, 3e-4] {
            let options = Options {
                method,
                ..Options::rk4(1.0, step)
            };
            let name = format!("{method:?} {step:e}");
            let failure = simulate(mechanism, &start, &options, &mut []).expect_err(&name);
            let end = failure.summary.end;
            let too_early = arrival - end.t;
            assert!((0.0..1.01 * step).contains(&too_early), "{name}: {}", end.t);
            let off = end.v[1] - 9.81 / 2.0 * end.t;
            assert!(off.abs() < 1e-9, "{name}: {off:e}");
        }
    }
}
