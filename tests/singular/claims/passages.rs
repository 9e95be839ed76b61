//! Very many passages with two degrees of freedom, and the time of one.

use crate::is_long;
use crate::largest::Largest;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{DynamicsError, Observer, Occurrence, Passage, Probe, Step};
use bricard_runtime::{Method, Options, State, StepControl, Whole, assemble, simulate};
use bricard_singular::descriptions::driven_lines::DrivenLines;
use bricard_singular::descriptions::halting::Halting;
use bricard_singular::descriptions::many_lines::ManyLines;
use bricard_singular::descriptions::parallelogram_pendulum::ParallelogramPendulum;
use bricard_singular::descriptions::sarrus::Sarrus;
use bricard_singular::descriptions::spinning::Spinning;
use bricard_singular::descriptions::tied_lines::TiedLines;
use bricard_singular::descriptions::two_lines::TwoLines;
use bricard_singular::{find, run_all};
use core::f64::consts::PI;
use core::ops::ControlFlow;

/// The difference of the two cranks, or the angle of the coupler.
fn skew(q: &SVector<f64, 4>) -> f64 {
    (q[0] - q[2]).abs().max(q[1].abs())
}

/// The speed at which its cranks begin (rad/s).
const SPEED: f64 = 60.0;

/// A parallelogram with a pendulum whose cranks turn fast, and have turned so many times.
fn fast(turns: f64) -> ParallelogramPendulum<f64> {
    let mut mechanism = ParallelogramPendulum::default();
    mechanism.parameters.w0 = SPEED;
    mechanism.parameters.a0 += turns * 2.0 * PI;
    mechanism
}

#[test]
fn a_hundred_thousand_passages_with_two_freedoms_stay_on_their_branch() {
    let wanted = if is_long() { 100_000.0 } else { 1000.0 };
    let mechanism: &dyn Whole<f64, 4, 2> = &fast(0.0);
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    // The pendulum takes a part of the speed; the crank never turns back.
    let until = 1.2 * wanted * PI / SPEED;
    let mut largest = Largest::of(skew);
    let options = Options::dop853(until, 1e-9);
    let ran = simulate(mechanism, &start, &options, &mut [&mut largest]);
    let summary = ran.unwrap_or_else(|failure| panic!("{failure}"));
    let half_turns = |state: &State<f64, 4>| (state.q[0] / PI).floor();
    let passed = (half_turns(&summary.end) - half_turns(&start)).abs();
    assert!(passed >= wanted, "only {passed} passages");
    assert_eq!(summary.passages, Some(passed as u64));
    assert!(
        largest.value < 1e-5,
        "the branch was left by {}",
        largest.value
    );
}

/// Both chains of Sarrus' linkage are stretched at once. The inside of a step is off by its
/// error, and so is the time at which either is.
#[test]
fn chains_that_are_stretched_at_once_are_passed_once_at_any_tolerance() {
    for tolerance in [1e-3, 1e-4, 1e-9] {
        let mechanism: &dyn Whole<f64, 6, 5> = &Sarrus::<f64>::default();
        let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
        let options = Options::dop853(20.0, tolerance);
        let ran = simulate(mechanism, &start, &options, &mut []);
        let summary = ran.unwrap_or_else(|failure| panic!("{failure}"));
        // The first hinge never turns back.
        let passed = (summary.end.q[0] / PI).floor();
        assert!(passed > 100.0, "only {passed} passages");
        let counted = summary.passages;
        assert_eq!(counted, Some(passed as u64), "{tolerance:e}");
    }
}

/// What happens at an angle does not depend on the turns that were made before, but for their
/// round-off.
#[test]
fn passages_after_very_many_turns_are_those_after_none() {
    let run = |turns: f64| {
        let mechanism: &dyn Whole<f64, 4, 2> = &fast(turns);
        let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
        let mut largest = Largest::of(skew);
        let options = Options::dop853(1.0, 1e-9);
        let ran = simulate(mechanism, &start, &options, &mut [&mut largest]);
        let summary = ran.unwrap_or_else(|failure| panic!("after {turns} turns: {failure}"));
        assert!(
            largest.value < 1e-8,
            "after {turns} turns, off by {}",
            largest.value
        );
        summary
    };
    let first = run(0.0);
    for turns in [1.0, 100.0, 12_000.0, 1e5, 1e6] {
        assert_eq!(run(turns).passages, first.passages, "after {turns} turns");
    }
}

/// Keeps the times of passages.
#[derive(Default)]
struct Times {
    passages: Vec<f64>,
    /// Whether the run ends at an event.
    stops: bool,
}

impl<const N: usize> Observer<f64, N> for Times {
    fn step(
        &mut self,
        _step: &Step<f64, N>,
        _probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        Ok(ControlFlow::Continue(()))
    }

    fn passage(&mut self, passage: &Passage<f64>) -> ControlFlow<()> {
        self.passages.push(passage.t);
        ControlFlow::Continue(())
    }

    fn event(&mut self, _occurrence: &Occurrence<f64, N>) -> ControlFlow<()> {
        match self.stops {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

/// The determinant is linear in time here, so that its zero is hit to the last digit, where
/// nothing can be evaluated.
#[test]
fn a_passage_is_reported_when_it_is_wherever_steps_end() {
    for speed in [0.3, 1.0, 1.3, 5.0] {
        for after in [0.01, 0.05, 0.1, 0.5, 1.0] {
            let mut mechanism = TwoLines::<f64>::default();
            mechanism.parameters.speed = speed;
            let mechanism: &dyn Whole<f64, 2, 1> = &mechanism;
            let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
            let exact = 1.0 / speed;
            let options = Options::dop853(exact * (1.0 + after), 1e-9);
            let mut times = Times::default();
            let ran = simulate(mechanism, &start, &options, &mut [&mut times]);
            ran.unwrap_or_else(|failure| panic!("{failure}"));
            let [time] = times.passages[..] else {
                panic!("{:?} instead of one passage at {exact}", times.passages);
            };
            let error = (time - exact).abs() / exact;
            assert!(error < 1e-9, "{time} instead of {exact}");
        }
    }
}

/// The sign of the determinant in a singular configuration is that of round-off.
#[test]
fn a_step_that_ends_in_a_singular_configuration_takes_and_invents_no_passage() {
    let fixed = [0.125, 0.1].map(|step| StepControl::Fixed { step });
    let adaptive = [1e-6, 1e-9, 1e-12].map(|tolerance| StepControl::Adaptive {
        relative: tolerance,
        absolute: tolerance,
    });
    for method in Method::ALL {
        for control in fixed {
            assert_eq!(halted(method, control, 1.0), Some(1));
            assert_eq!(halted(method, control, 0.0), Some(0));
        }
        // A motion that turns in a singular configuration may cross it twice by its error.
        for control in adaptive.iter().filter(|_| method != Method::Rk4) {
            assert_eq!(halted(method, *control, 1.0), Some(1));
        }
    }
}

/// The determinant is zero to the last digit where the first run ends and the second begins.
#[test]
fn two_runs_that_meet_in_a_singular_configuration_count_no_passage() {
    let mechanism: &dyn Whole<f64, 2, 1> = &TwoLines::<f64>::default();
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    let run = |from: &State<f64, 2>, until: f64| {
        let ran = simulate(mechanism, from, &Options::dop853(until, 1e-9), &mut []);
        ran.unwrap_or_else(|failure| panic!("{until}: {failure}"))
    };
    let before = run(&start, 1.0);
    let after = run(&before.end, 2.0);
    let whole = run(&start, 2.0);
    let passages = [before, after, whole].map(|summary| summary.passages);
    assert_eq!(passages, [Some(0), Some(0), Some(1)]);
}

/// Passages of a crank that halts in its dead centre, and goes on or back.
fn halted(method: Method, control: StepControl<f64>, goes: f64) -> Option<u64> {
    let mut mechanism = Halting::<f64>::default();
    mechanism.parameters.goes = goes;
    let mechanism: &dyn Whole<f64, 4, 3> = &mechanism;
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    let options = Options::new(2.0, method, control);
    let ran = simulate(mechanism, &start, &options, &mut []);
    let summary = ran.unwrap_or_else(|failure| panic!("{method:?} {control:?} {goes}: {failure}"));
    summary.passages
}

/// A motion that turns beyond a singular configuration passes it twice, and its steps may end
/// in the second passage.
#[test]
fn a_step_that_ends_in_a_singular_configuration_keeps_the_passage_before_it() {
    let series = find("slow").expect("it is a series");
    for place in [23, 51] {
        for ran in run_all(series.trials(77, place..place + 1, &[])) {
            assert_eq!(ran.verdict.passages, Some((2, 2)), "{}", ran.trial);
        }
    }
}

#[test]
fn a_mechanism_without_a_degree_of_freedom_passes_on_its_branch() {
    let mechanism: &dyn Whole<f64, 2, 2> = &DrivenLines::<f64>::default();
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let options = Options::dop853(2.0, tolerance);
        let ran = simulate(mechanism, &start, &options, &mut []);
        let end = ran.unwrap_or_else(|failure| panic!("{failure}")).end;
        let error = (end.q[0] + 1.0).abs().max((end.q[1] + 1.0).abs());
        assert!(error < 1e-9, "{:?}", end.q);
    }
}

/// However many passages there are in one step, each is reported once, when it is.
#[test]
fn many_passages_in_one_step_are_all_reported() {
    for lag in [0.001, 0.01, 0.05] {
        let mut mechanism = ManyLines::<f64>::default();
        mechanism.parameters.lag = lag;
        let mechanism: &dyn Whole<f64, 24, 12> = &mechanism;
        let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
        let options = Options::dop853(2.0, 1e-9);
        let mut times = Times::default();
        let ran = simulate(mechanism, &start, &options, &mut [&mut times]);
        let summary = ran.unwrap_or_else(|failure| panic!("{failure}"));
        assert_eq!(summary.passages, Some(12), "{:?}", times.passages);
        for (i, t) in times.passages.iter().enumerate() {
            let exact = 1.0 + i as f64 * lag;
            assert!((t - exact).abs() < 1e-12, "{t} instead of {exact}");
        }
    }
}

/// Loops that become singular at once are one passage, however many they are and however far
/// from it steps begin; an even number of them leaves the sign of the determinant as it was.
#[test]
fn loops_that_pass_at_once_are_seen_wherever_steps_begin() {
    for (lag, passages) in [(0.0, 1), (0.001, 12), (0.05, 12)] {
        for distance in [0.0, 0.3, 0.7, 0.9] {
            let mut mechanism = TiedLines::<f64>::default();
            mechanism.parameters.lag = lag;
            let mechanism: &dyn Whole<f64, 24, 12> = &mechanism;
            let mut start = mechanism.start();
            (0..12).for_each(|i| start.q[i].value += distance);
            let start = assemble(mechanism, &start, 0.0).expect("it can be assembled");
            let options = Options::dop853(2.0, 1e-9);
            let mut times = Times::default();
            let ran = simulate(mechanism, &start, &options, &mut [&mut times]);
            let summary = ran.unwrap_or_else(|failure| panic!("{failure}"));
            assert_eq!(
                summary.passages,
                Some(passages),
                "{lag}, {distance}: {:?}",
                times.passages
            );
            for (i, t) in times.passages.iter().enumerate() {
                let exact = 1.0 - distance + i as f64 * lag;
                assert!((t - exact).abs() < 1e-6, "{t} instead of {exact}");
            }
        }
    }
}

/// What lies behind the event that ends a run does not happen.
#[test]
fn no_passage_behind_the_end_is_reported() {
    let mechanism: &dyn Whole<f64, 24, 12> = &ManyLines::<f64>::default();
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    let mut times = Times {
        stops: true,
        ..Times::default()
    };
    let options = Options::dop853(2.0, 1e-9);
    let ran = simulate(mechanism, &start, &options, &mut [&mut times]);
    let summary = ran.unwrap_or_else(|failure| panic!("{failure}"));
    assert!((summary.end.t - 0.5).abs() < 1e-12, "{}", summary.end.t);
    assert_eq!(summary.passages, Some(0), "{:?}", times.passages);
}

/// Where no force acts, steps are as long as several turns, and none of the states that they
/// are made of need be near a singular configuration that they pass.
#[test]
fn passages_of_steps_that_take_several_turns_are_all_reported() {
    let until = 2.5;
    for method in &Method::ALL[1..] {
        for (place, tolerance) in [1e-3, 3e-5, 2e-7, 6e-9, 1e-10, 1e-12].iter().enumerate() {
            for w in [4.2, 6.7, 9.1, 12.3, 16.7, 19.8] {
                let mut mechanism = Spinning::default();
                mechanism.parameters.w = w;
                mechanism.parameters.a0 = 0.4 + 0.3 * place as f64;
                let turned = mechanism.parameters.a0 + w * until;
                let wanted = (turned / PI).floor() as u64;
                let mechanism: &dyn Whole<f64, 3, 2> = &mechanism;
                let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be made");
                let control = StepControl::Adaptive {
                    relative: *tolerance,
                    absolute: *tolerance,
                };
                let options = Options::new(until, *method, control);
                let ran = simulate(mechanism, &start, &options, &mut []);
                let name = format!("{method:?} {tolerance:e} {w}");
                let summary = ran.unwrap_or_else(|failure| panic!("{name}: {failure}"));
                assert_eq!(summary.passages, Some(wanted), "{name}");
                assert_eq!(summary.events, wanted, "{name}");
            }
        }
    }
}
