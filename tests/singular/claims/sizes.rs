//! Descriptions of one mechanism in other units, or at another place, are the same mechanism.

use bricard_runtime::{
    Interface, Method, Options, Start, State, StepControl, Summary, Whole, assemble, simulate,
};
use bricard_singular::descriptions::belt_parallelogram::BeltParallelogram;
use bricard_singular::descriptions::far_circle::FarCircle;
use bricard_singular::descriptions::far_parallelogram::FarParallelogram;
use bricard_singular::descriptions::sharp_corner::SharpCorner;
use bricard_singular::descriptions::sized_parallelogram::SizedParallelogram;
use bricard_singular::descriptions::unitless::Unitless;

/// Where a run begins, and what comes of it.
fn ran<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    guess: &Start<f64, N>,
    options: &Options<f64>,
    name: &str,
) -> (State<f64, N>, Summary<f64, N>) {
    let start =
        assemble(mechanism, guess, 0.0).unwrap_or_else(|failure| panic!("{name}: {failure}"));
    let ran = simulate(mechanism, &start, options, &mut []);
    (
        start,
        ran.unwrap_or_else(|failure| panic!("{name}: {failure}")),
    )
}

/// Where it is after some passages, in lengths of its links, and how many those were.
fn moved(l: f64) -> ([f64; 4], Option<u64>) {
    let mut mechanism = Unitless::<f64>::default();
    mechanism.parameters.l = l;
    let control = StepControl::Adaptive {
        relative: 1e-9,
        absolute: 1e-9 * l,
    };
    let options = Options {
        step_control: control,
        ..Options::dop853(5.0, 1e-9)
    };
    let name = format!("length {l:e}");
    let (_, summary) = ran::<4, 3>(&mechanism, &mechanism.start(), &options, &name);
    ((summary.end.q / l).into(), summary.passages)
}

#[test]
fn lengths_without_a_unit_may_be_of_any_size() {
    let (wanted, passages) = moved(1.0);
    assert!(passages > Some(3), "{passages:?}");
    for l in [1e8, 1e4, 1e-2, 1e-5, 1e-8] {
        let (found, count) = moved(l);
        assert_eq!(count, passages, "length {l:e}");
        for (found, wanted) in found.into_iter().zip(wanted) {
            let error = (found - wanted).abs();
            assert!(error < 1e-6, "length {l:e}: {found} instead of {wanted}");
        }
    }
}

/// A bead on a circle of a metre, whose centre is so far from the origin, after four seconds and
/// relative to the centre.
fn bead(far: f64) -> [f64; 2] {
    let mut mechanism = FarCircle::<f64>::default();
    mechanism.parameters.far = far;
    let (options, name) = (Options::dop853(4.0, 1e-12), format!("{far:e} m off"));
    let (_, summary) = ran::<2, 1>(&mechanism, &mechanism.start(), &options, &name);
    assert_eq!(summary.counters.beside_accelerations, 0, "{far:e} m off");
    [summary.end.q[0] - far, summary.end.q[1]]
}

#[test]
fn a_small_circle_may_be_far_from_the_origin() {
    let wanted = bead(0.0);
    for far in [1e2, 3e3, 1e4, 1e5, 1e6] {
        let found = bead(far);
        for (found, wanted) in found.into_iter().zip(wanted) {
            let error = (found - wanted).abs();
            let bound = 1e-9 + 1e3 * f64::EPSILON * far;
            assert!(error < bound, "{far:e} m off: {found} instead of {wanted}");
        }
    }
}

/// It is where it is without being far, and passes as many singular positions.
#[test]
fn a_loop_may_be_far_from_the_origin() {
    let moved = |far: f64, method, tolerance| {
        let mut mechanism = FarParallelogram::<f64>::default();
        mechanism.parameters.far = far;
        let options = Options {
            method,
            ..Options::dop853(3.0, tolerance)
        };
        let name = format!("{far:e} m off");
        let (_, summary) = ran::<4, 3>(&mechanism, &mechanism.start(), &options, &name);
        assert_eq!(summary.passages, Some(6), "{name}");
        summary.end.q.map(|q| q - far)
    };
    let wanted = moved(0.0, Method::Dop853, 1e-12);
    for far in [1e2, 1e3, 1e4, 1e5, 1e6] {
        for (method, tolerance) in [
            (Method::Dop853, 1e-9),
            (Method::Dp5, 1e-9),
            (Method::Dop853, 1e-11 * f64::max(far / 1e3, 1.0)),
        ] {
            let found = moved(far, method, tolerance);
            let error = (found - wanted).amax();
            let bound = 20.0 * tolerance * far.max(1e3);
            assert!(error < bound, "{far:e} m off, {method:?}: {error:e}");
        }
    }
}

/// A linkage of a thousandth of a millimetre turns as one of a metre does.
#[test]
fn loops_may_be_small_and_light() {
    let powers = |l: i32, m: i32| (2_f64.powi(l), 2_f64.powi(m));
    for (l, m) in [(0, 0), (-20, 0), (0, -40), (-20, -40), (-33, -86), (37, 80)] {
        let (length, mass) = powers(l, m);
        let mut mechanism = SizedParallelogram::<f64>::default();
        (mechanism.parameters.l, mechanism.parameters.m) = (length, mass);
        for method in [Method::Dop853, Method::Dp5, Method::Radau5] {
            let name = format!("length 2^{l}, mass 2^{m}, {method:?}");
            let options = Options {
                method,
                ..Options::dop853(0.02, 1e-9)
            };
            let (start, summary) = ran::<3, 2>(&mechanism, &mechanism.start(), &options, &name);
            assert_eq!(summary.passages, Some(6), "{name}");
            let turned = summary.end.q[0] - start.q[0];
            assert!((turned - 20.0).abs() < 1e-6, "{name}: {turned}");
        }
    }
}

/// Derivatives by differences vary an angle by part of a turn, however many it has made.
#[test]
fn implicit_methods_pass_after_many_turns() {
    let mechanism: &dyn Whole<f64, 3, 2> = &SizedParallelogram::<f64>::default();
    for turns in [0.0, 1e3, 1e5] {
        let mut guess = mechanism.start();
        for j in [0, 1] {
            guess.q[j].value += core::f64::consts::TAU * turns;
        }
        for method in [Method::Radau5, Method::Radau9] {
            let options = Options {
                method,
                ..Options::dop853(0.02, 1e-8)
            };
            let name = format!("{turns} turns, {method:?}");
            let (start, summary) = ran(mechanism, &guess, &options, &name);
            assert_eq!(summary.passages, Some(6), "{name}");
            let turned = summary.end.q[0] - start.q[0];
            assert!((turned - 20.0).abs() < 1e-5, "{turns} turns: {turned}");
        }
    }
}

/// Velocities at the start satisfy the constraints of a small loop, however far away it is, and
/// though a coordinate without inertia moves it.
#[test]
fn a_loop_on_a_belt_begins_and_goes_on_as_one_at_rest() {
    let moved = |far: f64| {
        let mut mechanism = BeltParallelogram::<f64>::default();
        mechanism.parameters.far = far;
        let (options, name) = (Options::dop853(3.0, 1e-9), format!("{far:e} m off"));
        let (start, summary) = ran::<6, 5>(&mechanism, &mechanism.start(), &options, &name);
        let crank = [start.v[2] - 10.0, start.v[3]];
        let (sin, cos) = 0.5_f64.sin_cos();
        let off = (crank[0] - 3.0 * cos)
            .abs()
            .max((crank[1] - 3.0 * sin).abs());
        assert!(off < 1e-7, "{far:e} m off: {crank:?}");
        let same = (start.v[2] - start.v[4]).abs() + (start.v[3] - start.v[5]).abs();
        assert!(same < 1e-7, "{far:e} m off: {}", start.v);
        summary.passages
    };
    for far in [0.0, 3.6e3, 3.6e4, 1e5] {
        assert_eq!(moved(far), Some(25), "{far:e} m off");
    }
}

/// How sharply constraints turn where a motion begins says nothing of where it goes.
#[test]
fn a_motion_may_begin_in_a_sharp_bend() {
    let mechanism: &dyn Whole<f64, 2, 1> = &SharpCorner::<f64>::default();
    for method in [Method::Dop853, Method::Radau5] {
        let options = Options {
            method,
            ..Options::dop853(3.0, 1e-9)
        };
        let (_, summary) = ran(
            mechanism,
            &mechanism.start(),
            &options,
            &format!("{method:?}"),
        );
        assert_eq!(summary.passages, Some(1), "{method:?}");
        let [x, y] = summary.end.q.into();
        let (along, aside) = (x.hypot(y) - 3.0, y - x.hypot(1e-6));
        assert!(
            along.abs() < 1e-5 && aside.abs() < 1e-9,
            "{method:?}: {x}, {y}"
        );
    }
}
