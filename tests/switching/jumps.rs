//! Steps end where forces jump, so that nothing is integrated across.

use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    DynamicsError, EnergyAudit, IntegrateError, Interface, Method, Observer, Options, Probe,
    SimulateError, State, Step, StepControl, Stepper, Summary, Whole, assemble, simulate,
};
use bricard_switching::contact::Contact;
use bricard_switching::friction::Friction;
use bricard_switching::frozen::Frozen;
use bricard_switching::looped::Looped;
use bricard_switching::placed::Placed;
use bricard_switching::timed::Timed;
use std::ops::ControlFlow;

/// Every method with a step control of its own: polynomials of the second degree are exact for all.
fn methods(until: f64) -> Vec<Options<f64>> {
    let fixed = StepControl::Fixed { step: 0.13 };
    let adaptive = StepControl::Adaptive {
        relative: 1e-8,
        absolute: 1e-8,
    };
    let fixed = Method::ALL.map(|method| Options::new(until, method, fixed));
    let adaptive = Method::ALL[1..]
        .iter()
        .map(|method| Options::new(until, *method, adaptive));
    fixed.into_iter().chain(adaptive).collect()
}

pub(crate) fn state<const N: usize>(q: [f64; N], v: [f64; N]) -> State<f64, N> {
    State::new(0.0, SVector::from(q), SVector::from(v))
}

pub(crate) fn run<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    start: &State<f64, N>,
    options: &Options<f64>,
) -> Summary<f64, N> {
    simulate(mechanism, start, options, &mut [])
        .unwrap_or_else(|failure| panic!("{:?}: {failure}", options.method))
}

#[track_caller]
pub(crate) fn near(found: f64, exact: f64, most: f64, what: &Options<f64>) {
    let error = (found - exact).abs();
    assert!(
        error <= most * exact.abs().max(1.0),
        "{found} instead of {exact}, off by {error:e}: {:?} {:?}",
        what.method,
        what.step_control
    );
}

#[test]
fn a_force_that_ends_at_a_time_leaves_the_exact_parabola_and_line() {
    for until in [1.0, 0.7, 1.0 / 3.0] {
        let mut mechanism = Timed::default();
        mechanism.parameters.until = until;
        for options in methods(2.0) {
            let summary = run::<1, 0>(&mechanism, &state([0.0], [0.0]), &options);
            let (v, x) = (5.0 * until, 2.5 * until * until);
            near(summary.end.v[0], v, 2e-14, &options);
            near(summary.end.q[0], x + v * (2.0 - until), 2e-14, &options);
        }
    }
}

/// The acceleration at the start of a run.
struct First(SVector<f64, 2>);

impl Observer<f64, 2> for First {
    fn begin(
        &mut self,
        state: &State<f64, 2>,
        probe: &mut dyn Probe<f64, 2>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        self.0 = probe.acceleration(state, &mut [])?;
        Ok(ControlFlow::Break(()))
    }

    fn step(
        &mut self,
        _: &Step<f64, 2>,
        _: &mut dyn Probe<f64, 2>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        unreachable!("the run is broken off at its start")
    }
}

#[test]
fn a_motion_from_rest_begins_with_the_acceleration_that_friction_leaves() {
    let mechanism = Friction::default();
    for (t, exact) in [
        (0.5, [0.0, 0.0]),
        (1.5, [0.5, 0.0]),
        (3.0, [2.0, 1.0]),
        (-2.5, [-1.5, -0.5]),
    ] {
        let mut first = First(SVector::zeros());
        let start = State::new(t, SVector::zeros(), SVector::zeros());
        let options = Options::dop853(4.0, 1e-9);
        simulate(&mechanism, &start, &options, &mut [&mut first]).expect("a start");
        let error = (first.0 - SVector::from(exact)).amax();
        assert!(error <= 1e-15, "at {t} s: {} instead of {exact:?}", first.0);
    }
}

#[test]
fn whoever_wants_it_goes_across_jumps() {
    let mut mechanism = Timed::default();
    mechanism.parameters.until = 1.0 / 3.0;
    let step = StepControl::Fixed { step: 0.13 };
    let mut options = Options::new(2.0, Method::Rk4, step);
    let exact = run::<1, 0>(&mechanism, &state([0.0], [0.0]), &options);
    options.settings.across_switches = true;
    let across = run::<1, 0>(&mechanism, &state([0.0], [0.0]), &options);
    assert_eq!(across.steps + 1, exact.steps, "no step ends at the jump");
    let off = (across.end.v[0] - exact.end.v[0]).abs();
    assert!(off > 1e-3 && off < 0.65, "{off}: a part of one step");
}

/// Where the mass that is pushed towards the edge from both sides is at a time.
fn placed(t: f64) -> (f64, f64) {
    let quarter = 0.2_f64.sqrt();
    let (turns, rest) = ((t / (2.0 * quarter) - 0.5).floor() + 1.0, t);
    let side = if turns % 2.0 == 0.0 { -1.0 } else { 1.0 };
    // From the middle of an arc, where it is at rest.
    let s = rest - turns * 2.0 * quarter;
    (0.5 + side * (0.5 - 2.5 * s * s), -side * 5.0 * s)
}

#[test]
fn a_force_that_turns_at_a_place_leaves_exact_parabolas() {
    for options in methods(10.0) {
        let summary = run::<1, 0>(&Placed::default(), &state([0.0], [0.0]), &options);
        let (x, v) = placed(10.0);
        near(summary.end.q[0], x, 1e-11, &options);
        near(summary.end.v[0], v, 1e-11, &options);
    }
}

#[test]
fn a_block_with_dry_friction_stops_and_stays() {
    let mut mechanism = Friction::default();
    mechanism.parameters.rise = 0.0;
    for options in methods(5.0) {
        let summary = run::<2, 0>(&mechanism, &state([0.0; 2], [1.0, -1.0]), &options);
        // v²/2F.
        near(summary.end.q[0], 0.5, 1e-13, &options);
        near(summary.end.q[1], -0.25, 1e-13, &options);
        assert!(summary.end.v.amax() < 1e-14, "{:?}", summary.end);
        assert!(summary.steps < 200, "{} steps", summary.steps);
    }
}

#[test]
fn a_block_at_rest_is_held_by_dry_friction_until_the_force_exceeds_it() {
    for options in methods(3.0) {
        let summary = run::<2, 0>(&Friction::default(), &state([0.0; 2], [0.0; 2]), &options);
        for (i, begins) in [1.0, 2.0].into_iter().enumerate() {
            let moving: f64 = 3.0 - begins;
            near(summary.end.q[i], moving.powi(3) / 6.0, 1e-12, &options);
            near(summary.end.v[i], moving.powi(2) / 2.0, 1e-12, &options);
        }
    }
}

#[test]
fn a_mass_that_bounces_on_a_spring_returns_when_it_should() {
    let (g, w) = (9.81_f64, 1000.0_f64.sqrt());
    let fall = (2.0 / g).sqrt();
    let pressed = 2.0 * (std::f64::consts::PI - (g * fall * w / g).atan()) / w;
    let until = 5.0 * (2.0 * fall + pressed);
    let start = state([1.0, 0.0], [0.0; 2]);
    for (options, most) in [
        (Options::dp5(until, 1e-9), 2e-8),
        (Options::dop853(until, 1e-12), 2e-11),
    ] {
        let summary = run::<2, 0>(&Contact::default(), &start, &options);
        near(summary.end.q[0], 1.0, most, &options);
        near(summary.end.v[0], 0.0, 20.0 * most, &options);
    }
}

#[test]
fn the_work_of_a_push_that_ends_at_a_place_is_exact_in_a_loop() {
    let mechanism = Looped::default();
    let start = assemble::<f64, _, 2, 1>(&mechanism, &mechanism.start(), 0.0).expect("a start");
    let energy = |state: &State<f64, 2>| 0.5 * state.v.norm_squared() + 9.81 * state.q[1];
    for options in [Options::dp5(3.0, 1e-9), Options::dop853(3.0, 1e-12)] {
        let summary = run::<2, 1>(&mechanism, &start, &options);
        let end = summary.end;
        let work = 2.0 * (end.q[0].min(0.25) - 0.2);
        let off = energy(&end) - energy(&start) - work;
        let most = if options.method == Method::Dp5 {
            1e-8
        } else {
            1e-11
        };
        assert!(off.abs() < most, "{off:e}: {:?}", options.method);
    }
}

#[test]
fn a_stepper_and_a_run_end_alike() {
    let mut stepper = Stepper::<f64, 1, 0>::new(
        Method::Dp5,
        StepControl::Fixed { step: 0.13 },
        bricard_runtime::Settings::default(),
    )
    .expect("the step is positive");
    let mut state = state([0.0], [0.0]);
    for _ in 0..100 {
        stepper
            .step(&Placed::default(), &mut state, 0.1)
            .expect("a step");
    }
    let (x, v) = placed(10.0);
    assert!(
        (state.q[0] - x).abs() < 1e-11 && (state.v[0] - v).abs() < 1e-11,
        "{state:?}"
    );
}

#[test]
fn a_place_that_both_sides_push_back_to_from_rest_is_an_error_that_names_the_condition() {
    let mechanism = Frozen::default();
    let short = Options::rk4(1.0, 0.01);
    for options in methods(1.0).into_iter().chain([short]) {
        let failure = simulate::<_, _, 1, 0>(&mechanism, &state([0.5], [0.0]), &options, &mut [])
            .expect_err("time can't go on");
        let SimulateError::Integrate(IntegrateError::Dynamics(DynamicsError::Sticks {
            t,
            condition,
        })) = failure.error
        else {
            panic!("{failure:?}");
        };
        assert!(t < 1e-3, "{t}");
        assert_eq!(condition.line, 5);
        assert!(
            condition.text.starts_with("if x < 1/2"),
            "{}",
            condition.text
        );
    }
}

/// Friction that holds a block on a belt takes exactly what the force brings in, and does not do
/// the work of friction that slides.
#[test]
fn the_power_of_friction_that_holds_is_that_of_the_force_it_holds_against() {
    let mut mechanism = Friction::default();
    mechanism.parameters.belt = 0.3;
    for options in methods(1.8) {
        let mut audit = EnergyAudit::new();
        let start = state([0.0, 0.0], [0.3, 0.3]);
        let ran = simulate(&mechanism, &start, &options, &mut [&mut audit]);
        let summary = ran.unwrap_or_else(|failure| panic!("{:?}: {failure}", options.method));
        // The first block breaks away after a second, the second one is held all the time.
        near(summary.end.v[0], 0.3 + 0.32, 1e-12, &options);
        near(summary.end.v[1], 0.3, 1e-15, &options);
        near(audit.largest(), 0.0, 1e-12, &options);
    }
}
