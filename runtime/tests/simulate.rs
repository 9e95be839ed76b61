//! Runs: the paper's figures, options, audits, rows, events, forms, the stepper.

use crate::fixtures::{BEAD, Bead, Framed, MOVING_BEAD, Oscillator, PLAIN, distance, simulate};
use crate::mechanisms::{FourBars, Passing, SliderCrank};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Audit, Direction, DynamicsError, Event, Form, IntegrateError, Method, Observer, Occurrence,
    Options, Passage, Probe, Recorder, Sampler, Settings, SimulateError, State, Step, StepControl,
    Stepper, Structure, Whole,
};
use core::ops::ControlFlow;

/// Passages of the double four-bar in its first 8 s, from its exact reduction.
const PASSAGES: [f64; 9] = [
    0.684, 1.095, 2.463, 2.874, 4.242, 4.653, 6.020, 6.432, 7.799,
];

static CONSERVATIVE: Structure = Structure {
    conservative: true,
    ..PLAIN
};

/// The double four-bar of the paper, released at 80°.
fn four_bar() -> (Framed<FourBars, 5>, State<f64, 5>) {
    let start = Passing::<5, 4>::state(&FourBars, 0.0, 80.0_f64.to_radians(), 0.0);
    (Framed::new(FourBars, &CONSERVATIVE), start)
}

/// The slider–crank of the paper, released at 45°.
fn slider_crank() -> (Framed<SliderCrank, 3>, State<f64, 3>) {
    let crank = SliderCrank::default();
    let start = crank.state(0.0, core::f64::consts::FRAC_PI_4, 0.0);
    (Framed::new(crank, &CONSERVATIVE), start)
}

/// An oscillator at its largest displacement.
fn oscillator(damping: f64) -> (Framed<Oscillator, 1>, State<f64, 1>) {
    let start = State::new(0.0, SVector::from([1.0]), SVector::from([0.0]));
    (Framed::new(Oscillator { damping }, &PLAIN), start)
}

/// Collects what a run reports.
#[derive(Default)]
struct Diary<const N: usize> {
    events: Vec<Occurrence<f64, N>>,
    passages: Vec<Passage<f64>>,
    ends: Vec<f64>,
    stop_at_event: Option<usize>,
}

impl<const N: usize> Observer<f64, N> for Diary<N> {
    fn step(
        &mut self,
        step: &Step<f64, N>,
        _probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        self.ends.push(step.end().t);
        Ok(ControlFlow::Continue(()))
    }

    fn event(&mut self, occurrence: &Occurrence<f64, N>) -> ControlFlow<()> {
        self.events.push(*occurrence);
        match self.stop_at_event {
            Some(index) if index == occurrence.index => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    }

    fn passage(&mut self, passage: &Passage<f64>) -> ControlFlow<()> {
        self.passages.push(*passage);
        ControlFlow::Continue(())
    }
}

#[test]
fn the_double_four_bar_passes_nine_singular_positions_in_eight_seconds() {
    let (mechanism, start) = four_bar();
    for options in [
        Options::rk4(8.0, 0.01),
        Options::dp5(8.0, 1e-9),
        Options::dop853(8.0, 1e-11),
    ] {
        let mut diary = Diary::default();
        let summary = simulate::<5, 4>(&mechanism, &start, &options, &mut [&mut diary])
            .unwrap_or_else(|failure| panic!("{failure}"));
        let times: Vec<f64> = diary.passages.iter().map(|passage| passage.t).collect();
        assert_eq!(
            times.len(),
            PASSAGES.len(),
            "{:?}: {times:?}",
            options.method
        );
        assert_eq!(summary.passages, Some(9));
        for (passage, exact) in diary.passages.iter().zip(PASSAGES) {
            assert!(
                (passage.t - exact).abs() < 1e-3,
                "{passage:?} instead of {exact}"
            );
            assert_eq!((passage.rank, passage.regular), (2, 4), "{passage:?}");
        }
        let constraints = summary.constraint_error.unwrap();
        println!("{:?} {constraints:?}", options.method);
        assert!(constraints.position <= 1e-13, "{constraints:?}");
        assert!(
            summary.energy_error.unwrap() < 1e-4,
            "{:?}",
            summary.energy_error
        );
    }
}

#[test]
fn observers_and_audits_change_no_bit_of_a_run() {
    let (mechanism, start) = four_bar();
    let mut options = Options::dp5(3.0, 1e-8);
    let mut recorder = Recorder::new(0.01).unwrap();
    let watched = simulate::<5, 4>(&mechanism, &start, &options, &mut [&mut recorder]).unwrap();
    options.audit = Audit::NONE;
    let alone = simulate::<5, 4>(&mechanism, &start, &options, &mut []).unwrap();
    assert_eq!(watched.end, alone.end);
    assert_eq!(
        (watched.steps, watched.rejected),
        (alone.steps, alone.rejected)
    );
    assert_eq!(alone.passages, None);
}

#[test]
fn forms_that_cannot_pass_end_in_a_typed_error_before_they_are_wrong() {
    let (mechanism, start) = four_bar();
    for form in [Form::Multipliers, Form::Partitioning] {
        for step in [0.1, 0.03, 0.01, 0.0077, 0.001] {
            let mut options = Options::rk4(8.0, step);
            options.settings.form = form;
            options.audit = Audit::NONE;
            let failure = simulate::<5, 4>(&mechanism, &start, &options, &mut []).unwrap_err();
            let SimulateError::Integrate(IntegrateError::Dynamics(
                DynamicsError::SingularPosition { t, form: named, .. },
            )) = failure.error
            else {
                panic!("{failure} at step {step}")
            };
            assert_eq!(named, form);
            assert!(
                (t - PASSAGES[0]).abs() < 0.05 + step,
                "{failure} at step {step}"
            );
            assert!(
                failure.summary.end.t <= PASSAGES[0] + step,
                "{failure} at step {step}"
            );
            assert!(failure.summary.end.t > 0.5, "{failure} at step {step}");
        }
    }
}

#[test]
fn fixed_steps_end_at_multiples_of_the_step_and_at_the_end() {
    let (mechanism, start) = oscillator(0.0);
    let mut diary = Diary::default();
    let options = Options::rk4(1.05, 0.1);
    let summary = simulate::<1, 0>(&mechanism, &start, &options, &mut [&mut diary]).unwrap();
    assert_eq!(summary.steps, 11);
    for (i, t) in diary.ends[..10].iter().enumerate() {
        assert_eq!(*t, (i + 1) as f64 * 0.1);
    }
    assert_eq!(diary.ends[10], 1.05);
}

#[test]
fn a_step_that_divides_the_run_leaves_no_sliver() {
    let (mechanism, start) = oscillator(0.0);
    for (until, step, steps) in [
        (8.0, 0.01, 800),
        (1.0, 0.1, 10),
        (0.3, 0.1, 3),
        (20.0, 0.7, 29),
    ] {
        let options = Options::rk4(until, step);
        let summary = simulate::<1, 0>(&mechanism, &start, &options, &mut []).unwrap();
        assert_eq!(summary.steps, steps, "{until} in steps of {step}");
        assert_eq!(summary.end.t, until);
    }
}

#[test]
fn bad_options_are_typed_errors() {
    let (mechanism, start) = oscillator(0.0);
    let run = |options: Options<f64>, start: &State<f64, 1>| {
        simulate::<1, 0>(&mechanism, start, &options, &mut []).map_err(|f| f.error)
    };
    for step in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        let error = run(Options::rk4(1.0, step), &start).unwrap_err();
        let expected = matches!(
            error,
            SimulateError::StepNotPositive { .. } | SimulateError::StepLost { .. }
        );
        assert!(expected, "{step}: {error}");
    }
    let error = run(Options::rk4(1.0, 1e-18), &start).unwrap_err();
    assert!(matches!(error, SimulateError::StepLost { .. }), "{error}");
    for until in [-1.0, f64::NAN, f64::INFINITY] {
        let error = run(Options::rk4(until, 0.01), &start).unwrap_err();
        assert!(matches!(error, SimulateError::BadEnd { .. }), "{error}");
    }
    for tolerance in [0.0, -1e-9, f64::NAN] {
        let error = run(Options::dp5(1.0, tolerance), &start).unwrap_err();
        let expected = IntegrateError::ToleranceNotPositive { value: tolerance };
        assert_eq!(error.to_string(), expected.to_string());
    }
    let error = run(Options::dop853(1.0, 1e-17), &start).unwrap_err();
    assert!(
        matches!(
            error,
            SimulateError::Integrate(IntegrateError::ToleranceTooSmall { .. })
        ),
        "{error}"
    );
    let step_control = StepControl::Adaptive {
        relative: 1e-6,
        absolute: 1e-6,
    };
    let error = run(Options::new(1.0, Method::Rk4, step_control), &start).unwrap_err();
    assert_eq!(
        error,
        SimulateError::NoErrorEstimate {
            method: Method::Rk4
        }
    );
    let nan = State::new(0.0, SVector::from([f64::NAN]), SVector::from([0.0]));
    let error = run(Options::rk4(1.0, 0.1), &nan).unwrap_err();
    assert_eq!(error, SimulateError::StartNotFinite { t: 0.0 });
    let mut options = Options::rk4(1.0, 0.1);
    options.most_steps = Some(4);
    let error = run(options, &start).unwrap_err();
    assert!(
        matches!(error, SimulateError::TooManySteps { steps: 4, .. }),
        "{error}"
    );
}

#[test]
fn a_run_of_no_time_is_its_start() {
    let (mechanism, start) = oscillator(0.0);
    let summary = simulate::<1, 0>(&mechanism, &start, &Options::rk4(0.0, 0.1), &mut []).unwrap();
    assert_eq!((summary.steps, summary.end), (0, start));
}

#[test]
fn rows_are_at_decimal_multiples_and_on_the_constraints() {
    let (mechanism, start) = slider_crank();
    for options in [
        Options::rk4(2.0, 0.007),
        Options::dp5(2.0, 1e-8),
        Options::dop853(2.0, 1e-10),
    ] {
        let mut recorder = Recorder::new(0.01).unwrap();
        simulate::<3, 2>(&mechanism, &start, &options, &mut [&mut recorder]).unwrap();
        assert_eq!(recorder.rows().len(), 201, "{:?}", options.method);
        for (i, row) in recorder.rows().iter().enumerate() {
            assert_eq!(row.t, i as f64 / 100.0);
            let gap = 0.5 * (row.q[0].sin() - row.q[1].sin());
            assert!(gap.abs() < 1e-14, "row {i} is {gap:e} off");
        }
    }
}

#[test]
fn rows_agree_between_methods() {
    let (mechanism, start) = slider_crank();
    let rows = |options| {
        let mut recorder = Recorder::new(0.01).unwrap();
        simulate::<3, 2>(&mechanism, &start, &options, &mut [&mut recorder]).unwrap();
        recorder.into_rows()
    };
    let best = rows(Options::dop853(2.0, 1e-12));
    for (options, bound) in [
        (Options::rk4(2.0, 0.005), 1e-6),
        (Options::dp5(2.0, 1e-9), 1e-6),
        (Options::dop853(2.0, 1e-9), 1e-6),
    ] {
        for (row, exact) in rows(options).iter().zip(&best) {
            let error = distance(row, exact);
            assert!(
                error < bound,
                "{:?} is {error:e} off at {}",
                options.method,
                row.t
            );
        }
    }
}

#[test]
fn an_interval_between_rows_that_is_not_positive_is_refused() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Recorder::<f64, 1>::new(bad).is_err());
    }
}

#[test]
fn what_was_recorded_before_a_failure_is_kept() {
    let (mechanism, start) = four_bar();
    let mut options = Options::rk4(8.0, 0.01);
    options.settings.form = Form::Multipliers;
    let mut recorder = Recorder::new(0.1).unwrap();
    let failure = simulate::<5, 4>(&mechanism, &start, &options, &mut [&mut recorder]).unwrap_err();
    assert!(recorder.rows().len() >= 7, "{} rows", recorder.rows().len());
    assert!(failure.summary.steps > 60, "{:?}", failure.summary);
    assert!(failure.summary.end.is_finite());
}

#[test]
fn a_sink_that_breaks_off_ends_the_run_at_the_step() {
    let (mechanism, start) = oscillator(0.0);
    let mut rows = 0;
    let mut sampler = Sampler::new(0.1, |_: &State<f64, 1>| {
        rows += 1;
        if rows == 5 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    })
    .unwrap();
    let options = Options::rk4(10.0, 0.1);
    let summary = simulate::<1, 0>(&mechanism, &start, &options, &mut [&mut sampler]).unwrap();
    assert!(summary.stopped);
    assert_eq!((rows, summary.steps), (5, 4));
}

static WATCHED: Structure = Structure {
    events: &[
        Event {
            name: "up",
            direction: Direction::Rising,
        },
        Event {
            name: "down",
            direction: Direction::Falling,
        },
        Event {
            name: "both",
            direction: Direction::Crossing,
        },
    ],
    ..PLAIN
};

/// An oscillator whose zeros are watched in all three directions.
fn watched() -> (Framed<Oscillator, 1>, State<f64, 1>) {
    let (mut mechanism, start) = oscillator(0.0);
    mechanism.structure = &WATCHED;
    mechanism.events = |state, values| {
        for value in values.iter_mut().take(3) {
            *value = state.q[0];
        }
    };
    (mechanism, start)
}

#[test]
fn events_are_located_to_round_off_in_each_direction() {
    use core::f64::consts::PI;
    let (mechanism, start) = watched();
    for (options, accuracy) in [
        (Options::rk4(10.0, 0.05), 1e-6),
        (Options::dp5(10.0, 1e-10), 1e-8),
        (Options::dop853(10.0, 1e-12), 1e-10),
    ] {
        let mut diary = Diary::default();
        let summary = simulate::<1, 0>(&mechanism, &start, &options, &mut [&mut diary]).unwrap();
        // cos t falls at π/2 and 5π/2, rises at 3π/2.
        let at = |index: usize| -> Vec<f64> {
            let times = diary.events.iter().filter(|event| event.index == index);
            times.map(|event| event.state.t).collect()
        };
        let close = |times: Vec<f64>, exact: &[f64]| {
            assert_eq!(times.len(), exact.len(), "{times:?}");
            for (t, exact) in times.iter().zip(exact) {
                assert!((t - exact).abs() < accuracy, "{t} instead of {exact}");
            }
        };
        close(at(0), &[1.5 * PI]);
        close(at(1), &[0.5 * PI, 2.5 * PI]);
        close(at(2), &[0.5 * PI, 1.5 * PI, 2.5 * PI]);
        assert_eq!(summary.events, 6);
        for event in &diary.events {
            assert!(event.state.q[0].abs() < 4.0 * f64::EPSILON, "{event:?}");
            assert_eq!(event.rising, event.state.v[0] > 0.0);
        }
        let ordered = diary
            .events
            .windows(2)
            .all(|pair| pair[0].state.t <= pair[1].state.t);
        assert!(ordered, "events out of order");
    }
}

/// Zero to round-off wherever the oscillator is within 1e-13 of its middle, positive elsewhere.
fn touching(q: f64) -> f64 {
    let (sin, cos) = (q + 1.0).sin_cos();
    1e10 * q * q + (sin * sin + cos * cos - 1.0)
}

#[test]
fn a_function_that_touches_zero_happens_once_whatever_round_off_makes_of_its_sign() {
    let (mut mechanism, start) = watched();
    mechanism.events = |state, values| values[..3].fill(touching(state.q[0]));
    let mut diary = Diary::default();
    let options = Options::dop853(10.0, 1e-12);
    simulate::<1, 0>(&mechanism, &start, &options, &mut [&mut diary]).unwrap();
    let count = |index: usize| {
        diary
            .events
            .iter()
            .filter(|event| event.index == index)
            .count()
    };
    // It falls to zero three times, and is never on the other side to come back from.
    assert_eq!([0, 1, 2].map(count), [0, 3, 3]);
}

#[test]
fn breaking_off_at_an_event_ends_the_run_there() {
    let (mechanism, start) = watched();
    let mut diary = Diary {
        stop_at_event: Some(0),
        ..Diary::default()
    };
    let mut recorder = Recorder::new(0.5).unwrap();
    let summary = simulate::<1, 0>(
        &mechanism,
        &start,
        &Options::dop853(10.0, 1e-10),
        &mut [&mut diary, &mut recorder],
    )
    .unwrap();
    assert!(summary.stopped);
    assert!(
        (summary.end.t - 1.5 * core::f64::consts::PI).abs() < 1e-8,
        "{:?}",
        summary.end
    );
    let last = recorder.rows().last().unwrap();
    assert_eq!(last.t, 4.5, "a row after the end of the run");
    assert!((last.q[0] - 4.5_f64.cos()).abs() < 1e-8);
}

#[test]
fn the_energy_of_a_damped_motion_falls_by_what_the_damping_takes() {
    let (mechanism, start) = oscillator(0.3);
    for (options, bound) in [
        (Options::rk4(20.0, 0.02), 1e-8),
        (Options::dp5(20.0, 1e-9), 1e-8),
        (Options::dop853(20.0, 1e-11), 1e-10),
    ] {
        let summary = simulate::<1, 0>(&mechanism, &start, &options, &mut []).unwrap();
        let error = summary.energy_error.unwrap();
        assert!(error < bound, "{:?}: {error:e}", options.method);
    }
}

#[test]
fn a_moving_constraint_supplies_the_work_it_does() {
    // A bead of weight 2 on a wire that rises with 3 m/s: 6 W.
    let bead = Bead {
        radius: 0.0,
        rise: 3.0,
        weight: 2.0,
    };
    let mechanism = Framed::new(bead, &MOVING_BEAD);
    let start = State::new(0.0, SVector::from([0.0, 0.0]), SVector::from([1.0, 3.0]));
    let summary = simulate::<2, 1>(&mechanism, &start, &Options::rk4(5.0, 0.01), &mut []).unwrap();
    assert!((summary.end.q[1] - 15.0).abs() < 1e-12, "{:?}", summary.end);
    let error = summary.energy_error.unwrap();
    assert!(error < 1e-11, "{error:e} of 30 J");
}

#[test]
fn a_bead_on_a_circle_stays_there() {
    let bead = Bead {
        radius: 2.0,
        rise: 0.0,
        weight: 9.81,
    };
    let mechanism = Framed::new(bead, &BEAD);
    let start = State::new(0.0, SVector::from([2.0, 0.0]), SVector::from([0.0, 0.0]));
    let summary =
        simulate::<2, 1>(&mechanism, &start, &Options::dop853(50.0, 1e-11), &mut []).unwrap();
    assert!(
        summary.constraint_error.unwrap().position < 1e-14,
        "{summary:?}"
    );
    assert!(summary.energy_error.unwrap() < 1e-8, "{summary:?}");
    assert_eq!(summary.passages, Some(0));
}

#[test]
fn a_stepper_lets_a_program_act_between_steps() {
    // A thermostat of an oscillator: push against the velocity.
    let (mut mechanism, mut state) = oscillator(0.0);
    let step_control = StepControl::Fixed { step: 0.001 };
    let mut stepper = Stepper::new(Method::Rk4, step_control, Settings::default()).unwrap();
    for _ in 0..400 {
        mechanism.input = -2.0 * state.v[0];
        let pushed: &dyn Whole<f64, 1, 0> = &mechanism;
        stepper.step(pushed, &mut state, 0.05).unwrap();
    }
    assert!((state.t - 20.0).abs() < 1e-9);
    assert!(state.q[0].abs() < 1e-3, "{state:?}");
}

#[test]
fn a_stepper_begins_where_it_is_told_and_a_run_on_the_constraints() {
    let bead = Bead {
        radius: 1.0,
        rise: 0.0,
        weight: 9.81,
    };
    let bead = Framed::new(bead, &BEAD);
    let told = State::new(0.0, SVector::from([1.001, 0.0]), SVector::from([0.0, 1.0]));
    let options = Options::rk4(0.01, 0.01);
    let ran = simulate::<2, 1>(&bead, &told, &options, &mut []).unwrap();
    let mut stepper =
        Stepper::<f64, 2, 1>::new(Method::Rk4, options.step_control, Settings::default()).unwrap();
    let mut stepped = told;
    stepper.step(&bead, &mut stepped, 0.01).unwrap();
    assert!((stepped.q.norm() - 1.0).abs() < 1e-14, "{stepped:?}");
    assert!((stepped.q - ran.end.q).norm() > 1e-6, "{stepped:?}");
    let mut placed = told;
    stepper.solver().on(&bead).project(&mut placed).unwrap();
    stepper.step(&bead, &mut placed, 0.01).unwrap();
    assert!((placed.q - ran.end.q).norm() < 1e-15, "{placed:?}");
    assert!((placed.v - ran.end.v).norm() < 1e-15, "{placed:?}");
}

#[test]
fn a_stepper_and_a_run_agree() {
    let (mechanism, start) = four_bar();
    for (method, step_control) in [
        (Method::Rk4, StepControl::Fixed { step: 0.01 }),
        (
            Method::Dp5,
            StepControl::Adaptive {
                relative: 1e-10,
                absolute: 1e-10,
            },
        ),
        (
            Method::Dop853,
            StepControl::Adaptive {
                relative: 1e-11,
                absolute: 1e-11,
            },
        ),
    ] {
        let mut stepper =
            Stepper::<f64, 5, 4>::new(method, step_control, Settings::default()).unwrap();
        let mut state = start;
        for _ in 0..20 {
            let mechanism: &dyn Whole<f64, 5, 4> = &mechanism;
            stepper.step(mechanism, &mut state, 0.1).unwrap();
        }
        let options = Options::new(2.0, method, step_control);
        let run = simulate::<5, 4>(&mechanism, &start, &options, &mut []).unwrap();
        let error = distance(&state, &run.end);
        assert!(error < 1e-7, "{method}: {error:e}");
    }
}
