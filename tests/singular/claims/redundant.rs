//! Constraints of which some follow from the others: where those that were chosen become
//! dependent and all of them together do not, nothing is singular.

use bricard_runtime::{
    DynamicsError, Form, IntegrateError, Interface, Options, SimulateError, Singularity, Whole,
    assemble, simulate,
};
use bricard_singular::descriptions::four_rods::FourRods;
use bricard_singular::descriptions::gate::Gate;
use bricard_singular::descriptions::spatial_parallelogram::SpatialParallelogram;
use bricard_singular::descriptions::three_cranks::ThreeCranks;
use bricard_singular::descriptions::turned_parallelogram::TurnedParallelogram;
use bricard_singular::{Score, Trial, judge};

const N: usize = 21;
const R: usize = 23;

/// The angle of the crank after a time, by Runge and Kutta's method on the reduction: a pendulum
/// in the plane of the mechanism.
fn angle_after(until: f64, a0: f64, w: f64) -> f64 {
    let (mass, length) = (1.2, 0.6);
    let inertia = 2.0 * (0.04 + mass * length * length / 4.0) + 2.0 * mass * length * length;
    let ((sa, ca), (sb, cb)) = (0.7_f64.sin_cos(), (-0.4_f64).sin_cos());
    let gravity = [2.0, -7.0, -6.0];
    let (x, y) = ([cb, sa * sb, -ca * sb], [0.0, ca, sa]);
    let along = |axis: [f64; 3]| -> f64 { gravity.iter().zip(axis).map(|(g, a)| g * a).sum() };
    let (gx, gy) = (along(x), along(y));
    let rate = |[a, v]: [f64; 2]| {
        let torque = 3.0 * mass * length * (gy * a.cos() - gx * a.sin());
        [v, torque / inertia]
    };
    let steps = 30_000;
    let h = until / f64::from(steps);
    let add = |[a, v]: [f64; 2], [da, dv]: [f64; 2], h: f64| [a + h * da, v + h * dv];
    let mut state = [a0, w];
    for _ in 0..steps {
        let k1 = rate(state);
        let k2 = rate(add(state, k1, h / 2.0));
        let k3 = rate(add(state, k2, h / 2.0));
        let k4 = rate(add(state, k3, h));
        for (rate, part) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            state = add(state, rate, part * h / 6.0);
        }
    }
    state[0]
}

fn options(until: f64, form: Form, tolerance: f64) -> Options<f64> {
    let mut options = Options::dop853(until, tolerance);
    options.settings.form = form;
    options
}

#[test]
fn passages_are_those_of_all_rows() {
    const UNTIL: f64 = 3.0;
    for (form, tolerance, a0, w) in [
        (Form::Reduced, 1e-6, 0.3, 6.0),
        (Form::Reduced, 1.2e-7, 0.83, -7.1),
        (Form::Reduced, 5e-6, 0.26, -8.4),
        (
            Form::Reduced,
            1.139516145259756e-9,
            1.3476614300115783,
            -2.562406828940989,
        ),
        (
            Form::Reduced,
            5.419891704606612e-8,
            1.437151862295032,
            2.489838708855075,
        ),
        (Form::Full, 5.2e-8, 0.64, 2.8),
        (
            Form::Full,
            1.0302085916093142e-9,
            1.0342016910160887,
            -3.6933673281845207,
        ),
        (Form::Full, 1e-5, -1.2, 7.0),
    ] {
        let name = format!("{form:?} {tolerance:e} {a0} {w}");
        let mut mechanism = SpatialParallelogram::default();
        (mechanism.parameters.a0, mechanism.parameters.w) = (a0, w);
        let mechanism: &dyn Whole<f64, N, R> = &mechanism;
        let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
        let ran = simulate(mechanism, &start, &options(UNTIL, form, tolerance), &mut []);
        let summary = ran.unwrap_or_else(|failure| panic!("{name}: {failure}"));
        assert!(summary.events > 0, "{name}");
        assert_eq!(summary.passages, Some(summary.events), "{name}");
        let mut crank = [0.0; 2];
        mechanism.outputs(&summary.end, &mut crank);
        let exact = angle_after(UNTIL, a0, w);
        let off = (crank[1] * exact.cos() - crank[0] * exact.sin()).abs();
        assert!(off < 2e3 * tolerance, "{name}: off by {off} rad");
    }
}

/// Friction stops the crank, and a motion at rest begins there: its velocity is nothing but
/// round-off, along which redundant rows would look independent.
#[test]
fn what_friction_stops_stays() {
    let mut mechanism = SpatialParallelogram::default();
    mechanism.parameters.f = 20.0;
    for a0 in [-1.4, -1.2, -0.9, 0.4, 1.4] {
        mechanism.parameters.a0 = a0;
        for tolerance in [1e-5, 1e-8] {
            let mechanism: &dyn Whole<f64, N, R> = &mechanism;
            let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
            let options = options(3.0, Form::Reduced, tolerance);
            let ran = simulate(mechanism, &start, &options, &mut []);
            let summary = ran.unwrap_or_else(|failure| panic!("{a0} {tolerance:e}: {failure}"));
            assert!(summary.end.v.amax() < 1e-9, "{a0} {tolerance:e}");
        }
    }
}

/// Where a step of fixed length ends beside a singular configuration, the acceleration at its
/// end is that of other rows than those that it was verified by.
#[test]
fn fixed_steps_of_all_lengths_pass() {
    let mut mechanism = SpatialParallelogram::default();
    mechanism.parameters.w = 8.0;
    let mechanism: &dyn Whole<f64, N, R> = &mechanism;
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    for step in [0.01, 0.005, 0.004, 0.003, 0.002, 0.001] {
        let ran = simulate(mechanism, &start, &Options::rk4(1.5, step), &mut []);
        let summary = ran.unwrap_or_else(|failure| panic!("{step}: {failure}"));
        assert!(summary.events > 1, "{step}");
        assert_eq!(summary.passages, Some(summary.events), "{step}");
    }
}

/// One loop alone becomes singular, all together do not, however little is left.
#[test]
fn a_pivot_beside_the_line_of_the_others_leaves_no_passage() {
    for beside in [0.0, 0.1, 0.03, 0.01, 1e-3] {
        for (form, tolerance, a0, w0, jc) in [
            (Form::Reduced, 5.64e-7, 0.305, -5.549, 0.02),
            (Form::Reduced, 2.7e-11, 0.809, 6.625, 0.02),
            (Form::Reduced, 2.67e-6, -1.192, -8.442, 0.02),
            (Form::Full, 1.47e-7, 2.793, -1.149, 0.0),
            (Form::Full, 3e-9, -0.555, -4.817, 0.0),
        ] {
            let name = format!("{beside} {form:?} {tolerance:e}");
            let mut mechanism = ThreeCranks::default();
            let parameters = &mut mechanism.parameters;
            (parameters.beside, parameters.jc) = (beside, jc);
            (parameters.a0, parameters.w0) = (a0, w0);
            let mechanism: &dyn Whole<f64, 5, 4> = &mechanism;
            let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
            let ran = simulate(mechanism, &start, &options(3.0, form, tolerance), &mut []);
            let summary = ran.unwrap_or_else(|failure| panic!("{name}: {failure}"));
            assert!(summary.events > 0, "{name}");
            let passages = if beside == 0.0 { summary.events } else { 0 };
            assert_eq!(summary.passages, Some(passages), "{name}");
        }
    }
}

/// In a plane that a law of time turns, what follows from what changes with time, and rows that are
/// zero at the start are needed later.
#[test]
fn hinges_in_a_plane_that_turns_are_as_good_as_those_in_one_that_stands() {
    let (mechanism, reduced) = ("turned_parallelogram", "turned_parallelogram_reduced");
    for (tolerance, nod, turn) in [(1e-6, 0.7, 0.6), (1e-9, -1.9, 0.8), (1e-11, 1.0, 1.0)] {
        for (a0, w0) in [(0.7, 6.0), (-0.4, -8.0), (1.2, 2.0)] {
            let set = vec![("nod", nod), ("turn", turn), ("a0", a0), ("w0", w0)];
            let trial = Trial::short(mechanism, reduced, set).until(4.0);
            let trial = Trial { tolerance, ..trial };
            let verdict = judge(&trial);
            assert_eq!(verdict.score, Score::Right, "{trial}\n    {}", verdict.why);
            assert!(!verdict.miscounted(), "{trial}: {:?}", verdict.passages);
        }
    }
}

#[test]
fn so_they_are_for_least_squares() {
    let mechanism = TurnedParallelogram::default();
    let start = assemble(&mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    let ended = |form| {
        let options = options(4.0, form, 1e-9);
        simulate(&mechanism, &start, &options, &mut []).expect("the run ends")
    };
    let (reduced, full) = (ended(Form::Reduced), ended(Form::Full));
    assert!(full.passages.is_some_and(|passages| passages > 4));
    assert_eq!(reduced.passages, full.passages);
    assert!((reduced.end.q - full.end.q).amax() < 1e-6);
}

/// Velocities that are nothing but round-off contradict nothing.
#[test]
fn what_cannot_move_stays() {
    for h in [0.1, 0.3, 1.0] {
        let mut rods = FourRods::default();
        rods.parameters.h = h;
        let start = assemble(&rods, &rods.start(), 0.0).expect("it can be assembled");
        let ran = simulate(&rods, &start, &options(1.0, Form::Reduced, 1e-9), &mut []);
        let end = ran.unwrap_or_else(|failure| panic!("{h}: {failure}")).end;
        assert!((end.q - start.q).amax() < 1e-12, "{h}: {}", end.q);
    }
}

/// Where a small distance is all that keeps something from moving, it stays; if the distance is
/// too small for that to be sure, nothing moves off as if there were none.
#[test]
fn two_axes_next_to_one_another_are_not_one() {
    for apart in [0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-7, 1e-8] {
        let mut gate = Gate::default();
        gate.parameters.apart = apart;
        let start = assemble(&gate, &gate.start(), 0.0).expect("it can be assembled");
        let ran = simulate(&gate, &start, &options(1.0, Form::Reduced, 1e-8), &mut []);
        match ran.map_err(|failure| failure.error) {
            Ok(ran) => {
                assert!(apart > 1e-6, "{apart:e} decides nothing");
                assert!(
                    (ran.end.q - start.q).amax() < 1e-9,
                    "{apart:e}: {}",
                    ran.end.q
                );
            }
            Err(SimulateError::Integrate(IntegrateError::Dynamics(
                DynamicsError::SingularConfiguration { t, kind, .. },
            ))) => {
                assert!(apart < 1e-6, "{apart:e}");
                assert_eq!((t, kind), (0.0, Singularity::Unresolved), "{apart:e}");
            }
            Err(error) => panic!("{apart:e}: {error}"),
        }
    }
}
