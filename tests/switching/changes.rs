//! Conditions that decide other conditions, change very often, or are left after a while.

use crate::jumps::{near, run, state};
use bricard_runtime::{Interface, Method, Options, StepControl, assemble, simulate};
use bricard_switching::kicked::Kicked;
use bricard_switching::parallelogram::Parallelogram;
use bricard_switching::pulsed::Pulsed;
use bricard_switching::released::Released;
use bricard_switching::saturated::Saturated;

/// Every method with this tolerance.
fn methods(until: f64, tolerance: f64) -> impl Iterator<Item = Options<f64>> {
    let control = StepControl::Adaptive {
        relative: tolerance,
        absolute: tolerance,
    };
    Method::ALL[1..]
        .iter()
        .map(move |method| Options::new(until, *method, control))
}

/// The speed of the cart: towards the wanted one with all force there is, then exponentially.
fn saturated_speed(t: f64) -> f64 {
    // Full force changes the speed by 0.75 m/s each second, until 0.375 m/s are lacking.
    let part = |from: f64, wanted: f64, t: f64| {
        let gap: f64 = wanted - from;
        let full = (gap.abs() - 0.375) / 0.75;
        match t <= full {
            true => from + 0.75 * gap.signum() * t,
            false => wanted - 0.375 * gap.signum() * (-2.0 * (t - full)).exp(),
        }
    };
    match t <= 2.0 {
        true => part(0.0, 0.6, t),
        false => part(part(0.0, 0.6, 2.0), -0.6, t - 2.0),
    }
}

#[test]
fn a_condition_inside_of_another_is_held_with_it() {
    for tolerance in [1e-5, 1e-7, 1e-9, 1e-11] {
        for until in [1.0, 2.0, 2.5, 6.0] {
            for options in methods(until, tolerance) {
                let summary = run::<1, 0>(&Saturated::default(), &state([0.0], [0.0]), &options);
                near(
                    summary.end.v[0],
                    saturated_speed(until),
                    20.0 * tolerance,
                    &options,
                );
            }
        }
    }
}

#[test]
fn what_friction_held_is_let_go_by_every_method() {
    let start = state([0.6, 0.0], [0.0, 0.0]);
    for w in [0.7, 1.0, 1.9] {
        let mut mechanism = Released::default();
        mechanism.parameters.w = w;
        let exact = run::<2, 0>(&mechanism, &start, &Options::dop853(20.0, 1e-13)).end;
        for tolerance in [1e-5, 1e-7, 1e-8, 1e-10, 1e-11, 1e-12] {
            for options in methods(20.0, tolerance) {
                let end = run::<2, 0>(&mechanism, &start, &options).end;
                let most = (1e3 * tolerance).max(1e-10);
                near(end.q[0], exact.q[0], most, &options);
                near(end.v[1], exact.v[1], most, &options);
            }
        }
    }
}

/// Some 12,700 changes, of which a step would go over all.
#[test]
fn a_clock_may_change_a_force_as_often_as_it_does() {
    let period = std::f64::consts::TAU / 1e3;
    let half = period / 2.0;
    let periods = 6366.0;
    let options = Options::dp5(periods * period, 1e-6);
    let end = run::<1, 0>(&Pulsed::default(), &state([0.0], [0.0]), &options).end;
    near(end.q[0], periods * half * half, 1e-9, &options);
    near(end.v[0], 0.0, 1e-9, &options);
}

/// A state in a singular configuration is put onto its sheet, by which either function may get
/// back to its other side.
#[test]
fn two_conditions_change_at_the_same_instant_in_a_singular_configuration() {
    let mechanism = Parallelogram::default();
    let start = assemble::<f64, _, 3, 2>(&mechanism, &mechanism.start(), 0.0).expect("a start");
    for tolerance in [1e-6, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12] {
        for options in methods(3.0, tolerance) {
            let run = simulate::<_, _, 3, 2>(&mechanism, &start, &options, &mut []);
            let done = run.unwrap_or_else(|failure| panic!("{:?}: {failure}", options.method));
            let error = done.energy_error.expect("it is audited");
            assert!(
                error < 50.0 * tolerance,
                "{:?} {tolerance:e}: {error}",
                options.method
            );
            let counted = (done.passages, done.events);
            assert_eq!(counted, (Some(5), 5), "{:?} {tolerance:e}", options.method);
        }
    }
}

/// A push that sets in and is weaker than friction again before the step ends lets the block go.
#[test]
fn a_push_that_fades_within_a_step_sets_a_block_in_motion() {
    let mechanism = Kicked::default();
    let start = assemble::<f64, _, 1, 0>(&mechanism, &mechanism.start(), 0.0).expect("a start");
    let fixed = Options::new(6.5, Method::Dop853, StepControl::Fixed { step: 3.0 });
    for options in methods(6.5, 1e-9).chain(methods(6.5, 1e-6)).chain([fixed]) {
        let done = simulate::<_, _, 1, 0>(&mechanism, &start, &options, &mut [])
            .unwrap_or_else(|failure| panic!("{failure}"));
        // 2 s − 2 s² from 5 s on, until friction and push are 1.5 s later.
        let off = (done.end.q[0] - 1.125)
            .abs()
            .max((done.end.v[0] - 0.75).abs());
        assert!(off < 1e-6, "{:?}: {}", options.method, done.end.q[0]);
    }
}
