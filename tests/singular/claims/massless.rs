//! A mass matrix that is singular, at some positions or at all of them.

use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Form, Interface, Options, Summary, assemble, simulate};
use bricard_singular::descriptions::guided_body::GuidedBody;
use bricard_singular::descriptions::leg::Leg;
use bricard_singular::descriptions::two_slots::TwoSlots;
use bricard_singular::{Score, Trial, judge};

/// Demands right rows, and the right number of passages.
fn is_right(trial: Trial) {
    let verdict = judge(&trial);
    assert_eq!(verdict.score, Score::Right, "{trial}\n    {}", verdict.why);
    assert!(!verdict.miscounted(), "{trial}: {:?}", verdict.passages);
}

/// A slider on a coupler without inertia runs across the coupler's joint, while the linkage
/// passes its singular positions.
#[test]
fn a_slider_runs_across_the_joint_of_a_coupler_without_inertia() {
    for (tolerance, speed) in [(1e-6, -4.0), (1e-9, -4.0), (1e-12, -4.0), (1e-9, 3.0)] {
        let set = vec![("vu", speed)];
        let trial = Trial::short("massless_coupler", "massless_coupler_reduced", set).until(1.5);
        is_right(Trial { tolerance, ..trial });
    }
}

/// Where rods could fold without kinetic energy, it is the metric that degenerates.
#[test]
fn rods_without_inertia_pass_where_they_could_fold() {
    for tolerance in [1e-6, 1e-9, 1e-12] {
        for speed in [-7.0, 1.0, 2.0, 4.0, 9.0, 15.0] {
            let (mechanism, reduced) = ("massless_parallelogram", "massless_parallelogram_reduced");
            let trial = Trial::short(mechanism, reduced, vec![("wa", speed)]).until(2.0);
            is_right(Trial { tolerance, ..trial });
        }
    }
}

/// So it is where a mass matrix is singular along a motion of several coordinates.
#[test]
fn crank_and_coupler_with_a_mass_at_their_end_pass_where_they_could_fold() {
    for tolerance in [1e-4, 1e-6, 1e-9, 1e-12] {
        for speed in [-7.0, 1.0, 3.0, 6.0, 15.0] {
            let set = vec![("wa", speed)];
            let trial = Trial::short("end_mass", "end_mass_reduced", set).until(2.0);
            is_right(Trial { tolerance, ..trial });
        }
    }
}

/// A ratio that is one at the start has no inertia there, though it has some everywhere else: rows
/// weigh as much as what they connect elsewhere.
#[test]
fn a_length_without_inertia_costs_no_steps() {
    let leg = Leg::default();
    let start = assemble(&leg, &leg.start(), 0.0).expect("the start assembles");
    let of = |form| -> Summary<f64, 5> {
        let mut options = Options::dop853(0.1, 1e-9);
        options.settings.form = form;
        simulate(&leg, &start, &options, &mut []).expect("the run ends")
    };
    let (reduced, full) = (of(Form::Reduced), of(Form::Full));
    assert!(
        reduced.steps <= full.steps + full.steps / 2,
        "{} steps, and {} in the other form",
        reduced.steps,
        full.steps
    );
    let apart = (reduced.end.q - full.end.q).amax();
    assert!(apart < 1e-8, "{apart:e}");
}

/// However a guess of Euler parameters is off, they are assembled where three are zero, and the
/// fourth has no inertia. What little the assembly leaves of the others must not count.
#[test]
fn a_body_on_a_slide_is_guided_from_every_guess() {
    for first in [0.9, 1.0, 1.1] {
        for [x, y, z] in [
            [0.0, 0.0, 0.0],
            [0.01, 0.0, 0.001],
            [-0.02, 0.03, 0.0],
            [0.001, 0.001, -0.05],
            [0.0, 0.1, 0.0],
            [1e-160, 0.0, 1e-30],
        ] {
            let mut load = GuidedBody::default();
            let guess = &mut load.parameters;
            (guess.guess_0, guess.guess_1) = (first, x);
            (guess.guess_2, guess.guess_3) = (y, z);
            let start = assemble(&load, &load.start(), 0.0).expect("the start assembles");
            let ran = simulate(&load, &start, &Options::dop853(1.0, 1e-9), &mut []);
            let end = ran.unwrap_or_else(|failure| panic!("{first} {x} {y} {z}: {failure}"));
            let guided = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
            let off = (end.end.q - SVector::from(guided)).amax();
            assert!(off < 1e-9, "{first} {x} {y} {z}: off by {off}");
        }
    }
}

/// Where a constraint restricts hardly anything but a coordinate without inertia, it weighs no more
/// than what it connects elsewhere: wherever the motion starts, no configuration looks singular.
#[test]
fn a_constraint_of_a_length_without_inertia_alone_looks_regular() {
    for beside in [-1.5, -0.1, -1e-3, -1e-7, 0.0, 1e-5, 0.02] {
        let angle = core::f64::consts::FRAC_PI_2 + beside;
        let mut slots = TwoSlots::<f64>::default();
        slots.parameters.angle = angle;
        let start = assemble(&slots, &slots.start(), 0.0).expect("the start assembles");
        let ran = simulate(&slots, &start, &Options::dop853(5.0, 1e-9), &mut []);
        let Summary { end, counters, .. } = ran.unwrap_or_else(|error| panic!("{beside}: {error}"));
        let late = end.q[0] - angle - 10.0 * end.t;
        assert!(late.abs() < 1e-6, "{beside}: {late:e}");
        assert_eq!(counters.beside_accelerations, 0, "{beside}");
    }
}
