//! Forces that jump in closed loops: what holds them, and what draws them to dead centres.

use crate::events::Diary;
use bricard_runtime::{
    Interface, Method, Options, StepControl, Summary, Whole, assemble, simulate,
};
use bricard_switching::cranked::Cranked;
use bricard_switching::drawn::Drawn;
use bricard_switching::jointed::Jointed;
use bricard_switching::jointed_reduced::JointedReduced;
use bricard_switching::warmed::Warmed;
use bricard_testkit::Random;
use core::f64::consts::{FRAC_PI_2, PI};

fn run<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    (until, tolerance): (f64, f64),
) -> Summary<f64, N> {
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    let options = Options::dop853(until, tolerance);
    simulate(mechanism, &start, &options, &mut []).unwrap_or_else(|failure| panic!("{failure}"))
}

/// Their functions all vanish with the only velocity there is.
#[test]
fn friction_in_every_joint_of_a_loop_brings_it_to_rest() {
    let mut random = Random::seeded(0x0F41);
    for round in 0..40 {
        let mut loops = Jointed::<f64>::default();
        let parameters = &mut loops.parameters;
        // A rod as long as the crank has dead centres where both could fold.
        parameters.r = [1.0, 1.2, 1.5][round % 3];
        parameters.f = [1.0, 2.0, 5.0, 10.0][round % 4];
        parameters.g = f64::from(u8::from(round % 2 == 0));
        (parameters.q0, parameters.w0) = (random.within(1.2), random.within(4.0));
        let tolerance = [1e-6, 1e-8, 1e-10][round % 3];
        let name = format!("{round}: {:?}", loops.parameters);
        let end = run::<3, 2>(&loops, (6.0, tolerance)).end;
        if loops.parameters.f >= 5.0 || loops.parameters.g == 0.0 {
            assert!(end.v.amax() < 1e-7, "{name}: {}", end.v);
        }
        if loops.parameters.r > 1.0 {
            let mut reduced = JointedReduced::<f64>::default();
            let parameters = &mut reduced.parameters;
            (parameters.r, parameters.f) = (loops.parameters.r, loops.parameters.f);
            parameters.g = loops.parameters.g;
            (parameters.q0, parameters.w0) = (loops.parameters.q0, loops.parameters.w0);
            let exact = run::<1, 0>(&reduced, (6.0, 1e-11)).end.q[0];
            let off = end.q[0] - exact;
            assert!(off.abs() < 1e4 * tolerance, "{name}: off by {off:e}");
        }
    }
}

/// What the friction of all joints can bear, by virtual work, beside what gravity asks of it.
fn hold(q: f64, r: f64) -> f64 {
    let a = (-q.sin() / r).asin();
    let (turned, moved) = (-q.cos() / (r * a.cos()), -q.sin());
    let moved = moved + q.sin() * turned;
    let borne = 1.0 + (1.0 - turned).abs() + moved.abs();
    (0.65 * 9.81 * q.cos()).abs() / borne
}

/// All functions are zero from the start, and one of the forces alone is enough to say how the
/// motion goes on.
#[test]
fn friction_in_every_joint_holds_a_loop_that_begins_at_rest() {
    for k in 0..30 {
        let q0 = -3.1 + 0.21 * f64::from(k);
        for part in [0.9, 1.1, 1.5, 4.0] {
            let mut loops = Jointed::<f64>::default();
            let parameters = &mut loops.parameters;
            (parameters.q0, parameters.w0) = (q0, 0.0);
            parameters.f = part * hold(q0, parameters.r);
            let summary = run::<3, 2>(&loops, (1.0, 1e-9));
            let moved = (summary.end.q[0] - q0).abs();
            let name = format!(
                "{q0} {part}: moved by {moved:e}, {} rejected",
                summary.rejected
            );
            assert_eq!(part > 1.0, moved < 1e-12, "{name}");
            assert!(summary.rejected < 100, "{name}");
        }
    }
}

/// A load that is not enough to move it leaves velocities of round-off, whose signs are no events,
/// wherever a run begins.
#[test]
fn what_friction_holds_in_a_loop_does_not_stop_again() {
    for q0 in [-2.0, -1.1, 0.3, 0.9, 1.4, 2.5] {
        let mut loops = Jointed::<f64>::default();
        let parameters = &mut loops.parameters;
        (parameters.q0, parameters.w0) = (q0, 3.0);
        parameters.f = 3.0 * hold(q0, parameters.r) + 3.0;
        parameters.a = 2.0;
        let held = run::<3, 2>(&loops, (4.0, 1e-9)).end;
        for options in [Options::rk4(5.0, 5e-4), Options::rk4(5.0, 2e-3)] {
            let mut diary = Diary::default();
            let mechanism: &dyn Whole<f64, 3, 2> = &loops;
            let ran = simulate(mechanism, &held, &options, &mut [&mut diary]);
            let summary = ran.unwrap_or_else(|failure| panic!("{q0}: {failure}"));
            assert!((summary.end.q - held.q).amax() < 1e-9, "{q0}");
            assert!(diary.told.is_empty(), "{q0}: {} events", diary.told.len());
        }
    }
}

/// A run of the crank, and how often each of its events happened.
fn cranked(mechanism: &Cranked<f64>, options: &Options<f64>) -> (Summary<f64, 4>, [Vec<f64>; 2]) {
    let start = assemble::<f64, _, 4, 2>(mechanism, &mechanism.start(), 0.0).expect("a start");
    let mut diary = Diary::default();
    let name = format!("{:?} {:?}", options.method, options.step_control);
    let summary = simulate::<_, _, 4, 2>(mechanism, &start, options, &mut [&mut diary])
        .unwrap_or_else(|failure| panic!("{name}: {failure}"));
    let times = |event: usize| {
        let happened = diary.told.iter().filter(|(index, ..)| *index == event);
        happened.map(|(_, t, _)| *t).collect()
    };
    (summary, [times(0), times(1)])
}

/// Every method that controls its steps.
const METHODS: [Method; 4] = [Method::Dop853, Method::Dp5, Method::Radau5, Method::Radau9];

/// The pendulum goes on for hundreds of steps, each of which is off by something.
#[test]
fn a_crank_that_friction_holds_stopped_once_and_does_not_creep() {
    let mut mechanism = Cranked::default();
    let parameters = &mut mechanism.parameters;
    (parameters.f, parameters.g) = (5.0, 0.0);
    (parameters.q0, parameters.w0) = (0.023, 3.2);
    (parameters.p0, parameters.v0) = (-1.46, -0.21);
    let options = |method, until, tolerance| Options {
        method,
        ..Options::dop853(until, tolerance)
    };
    let (_, [exact, _]) = cranked(&mechanism, &options(Method::Dop853, 1.0, 1e-13));
    for method in METHODS {
        for tolerance in [1e-6, 1e-9, 1e-10, 1e-12] {
            let (stopped, _) = cranked(&mechanism, &options(method, 2.0, tolerance));
            let (summary, [stops, _]) = cranked(&mechanism, &options(method, 200.0, tolerance));
            let name = format!("{method:?} {tolerance:e}: {stops:?}");
            assert_eq!(stops.len(), 1, "{name}");
            assert!((stops[0] - exact[0]).abs() < 100.0 * tolerance, "{name}");
            let crept = summary.end.q[0] - stopped.end.q[0];
            assert!(crept.abs() < 10.0 * tolerance, "{name}: crept by {crept:e}");
            assert!(summary.end.v[0].abs() < 1e-15, "{name}: {}", summary.end.v);
        }
    }
}

/// The functions of two conditions and of an event all vanish in the dead centre, each at a time of
/// its own by round-off.
#[test]
fn an_event_in_a_dead_centre_where_conditions_change_happens_once() {
    let mut mechanism = Cranked::default();
    let parameters = &mut mechanism.parameters;
    (parameters.m, parameters.h) = (20.0, 1.0);
    (parameters.q0, parameters.w0) = (1.1060144206029698, -1.712250361351148);
    (parameters.p0, parameters.v0) = (-0.8456297555884431, -0.04514074473102481);
    for method in METHODS {
        for k in 0..20 {
            let options = Options {
                method,
                ..Options::dop853(6.0, 10f64.powf(0.4 * f64::from(k) - 12.0))
            };
            let (summary, [_, dead_centres]) = cranked(&mechanism, &options);
            let name = format!("{method:?} {:?}", options.step_control);
            assert_eq!(dead_centres.len(), 4, "{name}: {dead_centres:?}");
            assert_eq!(summary.passages, Some(4), "{name}");
        }
    }
}

/// The energy that a sliding motion loses is that of the mean force, not of either side's.
#[test]
fn a_motion_that_slides_to_a_dead_centre_gets_there() {
    // It reaches the line at this time and angle, and follows it: the closed form of the latter.
    let begin = run::<3, 2>(&Drawn::default(), (0.5, 1e-12)).end;
    for (until, tolerance) in [(3.0, 1e-6), (6.0, 1e-9), (20.0, 1e-8)] {
        let end = run::<3, 2>(&Drawn::default(), (until, tolerance)).end;
        let left = (FRAC_PI_2 - begin.q[0]) * (begin.t - until).exp();
        let off = [
            end.q[0] - FRAC_PI_2 + left,
            end.v[0] - left,
            end.q[1] + end.q[0],
        ];
        let most = 1e3 * tolerance;
        assert!(off.iter().all(|off| off.abs() < most), "{until}: {off:?}");
    }
}

/// States of the first order have rates, but no power.
#[test]
fn a_state_that_friction_changes_takes_no_energy() {
    let mut random = Random::seeded(0x0EA7);
    for round in 0..40 {
        let mut warmed = Warmed::default();
        // The crank comes to rest this far from where both cranks lie on the line of the base.
        let beside = 10.0_f64.powf(-3.0 + random.within(1.0)) * [1.0, -1.0][round % 2];
        let inertia = 2.0 * 0.02 + 0.3 * 0.3;
        warmed.parameters.w0 = (2.0 * 0.8 / inertia * (PI / 9.0 + beside)).sqrt();
        let start = assemble::<f64, _, 4, 2>(&warmed, &warmed.start(), 0.0).expect("a start");
        let method = [Method::Rk4, Method::Dop853, Method::Radau9][round % 3];
        let step = 10.0_f64.powf(-2.8 + random.within(0.4));
        let options = Options::new(3.0, method, StepControl::Fixed { step });
        let name = format!("{:?} {method:?} {step}", warmed.parameters);
        let summary = simulate::<_, _, 4, 2>(&warmed, &start, &options, &mut [])
            .unwrap_or_else(|failure| panic!("{name}: {failure}"));
        let (lost, end) = (summary.energy_supplied.unwrap_or(0.0), summary.end);
        assert!((end.q[0] - PI - beside).abs() < 1e-5, "{name}: {}", end.q);
        assert!(
            (lost + end.v[3]).abs() < 1e-5,
            "{name}: {lost} {}",
            end.v[3]
        );
        let error = summary.energy_error.unwrap_or(1.0);
        assert!(error < 1e-5, "{name}: {error:e}");
    }
}
