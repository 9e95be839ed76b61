//! Events that come in pairs within a step are found.

use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    DynamicsError, Interface, Method, Observer, Occurrence, Options, Probe, State, Step,
    StepControl, assemble, simulate,
};
use bricard_switching::contact::Contact;
use bricard_switching::gripped::Gripped;
use bricard_switching::slowing::Slowing;
use bricard_switching::stopping::Stopping;
use bricard_switching::timed::Timed;
use core::ops::ControlFlow;

/// Collects when events happen, and breaks the run off at each if it is to.
#[derive(Default)]
pub(crate) struct Diary {
    pub(crate) told: Vec<(usize, f64, bool)>,
    pub(crate) ends: bool,
}

impl<const N: usize> Observer<f64, N> for Diary {
    fn step(
        &mut self,
        _step: &Step<f64, N>,
        _probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        Ok(ControlFlow::Continue(()))
    }

    fn event(&mut self, found: &Occurrence<f64, N>) -> ControlFlow<()> {
        self.told.push((found.index, found.state.t, found.rising));
        match self.ends {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

/// When `cos(10 t)` passes `±d`, with whether its square grows there, until a time.
fn passages(d: f64, until: f64) -> Vec<(f64, bool)> {
    let mut times = Vec::new();
    for half_turn in 0..1000 {
        for (angle, grows) in [(d.acos(), false), ((-d).acos(), true)] {
            times.push((
                (std::f64::consts::PI * f64::from(half_turn) + angle) / 10.0,
                grows,
            ));
        }
    }
    times.retain(|(t, _)| *t < until);
    times
}

/// Runs the oscillator beside the bouncing mass and compares its events.
#[track_caller]
fn check(d: f64, options: &Options<f64>, most: f64) {
    let mut mechanism = Contact::default();
    mechanism.parameters.d = d;
    let start = State::new(0.0, SVector::from([1.0, 1.0]), SVector::zeros());
    let mut diary = Diary::default();
    simulate::<_, _, 2, 0>(&mechanism, &start, options, &mut [&mut diary])
        .unwrap_or_else(|failure| panic!("{failure}"));
    let found: Vec<_> = diary
        .told
        .iter()
        .filter(|(index, ..)| *index == 0)
        .collect();
    let exact = passages(d, options.until);
    assert_eq!(found.len(), exact.len(), "d = {d:e} {:?}", options.method);
    for ((_, t, rising), (wanted, grows)) in found.iter().zip(&exact) {
        assert!((t - wanted).abs() < most, "{t} instead of {wanted}");
        assert_eq!(rising, grows, "at {t}");
    }
    let times: Vec<f64> = diary.told.iter().map(|(_, t, _)| *t).collect();
    assert!(times.is_sorted(), "in the order of time");
}

#[test]
fn a_function_that_dips_below_zero_for_a_moment_is_seen_eleven_times() {
    let fixed = Options::new(3.5, Method::Dop853, StepControl::Fixed { step: 0.02 });
    for options in [Options::dp5(3.5, 1e-9), Options::dop853(3.5, 1e-10), fixed] {
        check(1e-5, &options, 1e-8);
    }
}

#[test]
fn pairs_of_any_distance_are_found_where_they_are() {
    // Multiples of the golden ratio, modulo one, as exponents.
    for i in 1..60 {
        let exponent = 6.0 * ((0.618_033_988_749_894_9 * f64::from(i)) % 1.0);
        check(10.0_f64.powf(-exponent), &Options::dop853(7.0, 1e-11), 1e-9);
    }
}

#[test]
fn a_function_that_only_just_misses_zero_has_no_event() {
    // The largest displacement is one.
    let mut mechanism = Contact::default();
    mechanism.parameters.d = 1.0 + 1e-7;
    let start = State::new(0.0, SVector::from([1.0, 1.0]), SVector::zeros());
    let mut diary = Diary::default();
    let options = Options::dop853(7.0, 1e-11);
    simulate::<_, _, 2, 0>(&mechanism, &start, &options, &mut [&mut diary])
        .unwrap_or_else(|failure| panic!("{failure}"));
    assert!(
        diary.told.iter().all(|(index, ..)| *index == 1),
        "{:?}",
        diary.told
    );
}

#[test]
fn what_stays_within_round_off_of_zero_for_a_while_happens_once() {
    let start = State::new(0.0, SVector::from([0.0]), SVector::zeros());
    let fixed = Options::new(8.0, Method::Rk4, StepControl::Fixed { step: 0.05 });
    for options in [Options::dp5(8.0, 1e-6), Options::dop853(8.0, 1e-9), fixed] {
        for until in [0.31, 0.65, 0.7, 1.3, 2.2, 3.7, 7.3] {
            let mut mechanism = Timed::default();
            mechanism.parameters.until = until;
            let mut diary = Diary::default();
            simulate::<_, _, 1, 0>(&mechanism, &start, &options, &mut [&mut diary])
                .unwrap_or_else(|failure| panic!("{failure}"));
            let [(_, t, rising)] = diary.told[..] else {
                panic!("{:?} until {until}: {:?}", options.method, diary.told);
            };
            // The cube root of round-off.
            assert!(rising && (t - until).abs() < 1e-4, "{t} instead of {until}");
        }
    }
}

/// The velocity of a block that friction holds is round-off, and its sign tells nothing: it
/// stopped once, whether it is drawn back later or stays.
#[test]
fn a_block_that_friction_stops_stops_once_and_there() {
    for (rise, stops) in [(4.0, (17f64.sqrt() - 3.0) / 4.0), (0.0, 1.0 / 3.0)] {
        let mut mechanism = Stopping::default();
        mechanism.parameters.rise = rise;
        let start = State::new(0.0, SVector::zeros(), SVector::from([1.0]));
        for method in [Method::Dop853, Method::Dp5, Method::Radau9, Method::Radau5] {
            for tolerance in [1e-6, 1e-8, 1e-9, 1e-11, 1e-12, 1e-13] {
                let options = Options {
                    method,
                    ..Options::dop853(2.0, tolerance)
                };
                let mut diary = Diary::default();
                simulate::<_, _, 1, 0>(&mechanism, &start, &options, &mut [&mut diary])
                    .unwrap_or_else(|failure| panic!("{failure}"));
                let [(0, t, false)] = diary.told[..] else {
                    panic!("{method:?} {tolerance:e}: {:?}", diary.told);
                };
                assert!((t - stops).abs() < 1e-9, "{method:?} {tolerance:e}: {t}");
            }
        }
    }
}

/// A velocity that friction holds at zero is zero where all coordinates are zero, too.
#[test]
fn a_block_held_at_the_origin_does_not_turn() {
    let mechanism = Gripped::default();
    let start = assemble::<f64, _, 1, 0>(&mechanism, &mechanism.start(), 0.0).expect("a start");
    for method in Method::ALL {
        let control = match method {
            Method::Rk4 => StepControl::Fixed { step: 1e-3 },
            _ => StepControl::Adaptive {
                relative: 1e-9,
                absolute: 1e-9,
            },
        };
        let mut diary = Diary::default();
        let options = Options::new(0.01, method, control);
        simulate::<_, _, 1, 0>(&mechanism, &start, &options, &mut [&mut diary])
            .unwrap_or_else(|failure| panic!("{failure}"));
        assert_eq!(diary.told, [], "{method:?}");
    }
}

/// A step that ends where friction stops a loop ends there but for the round-off of time.
#[test]
fn a_loop_that_friction_stops_is_said_to_stop_when_it_does() {
    let mut mechanism = Slowing::default();
    for w0 in [2.0, 3.0] {
        mechanism.parameters.w0 = w0;
        let start = assemble::<f64, _, 3, 2>(&mechanism, &mechanism.start(), 0.0).expect("a start");
        for method in Method::ALL {
            for step in [0.02, 0.05] {
                let mut diary = Diary::default();
                let options = Options::new(15.0, method, StepControl::Fixed { step });
                simulate::<_, _, 3, 2>(&mechanism, &start, &options, &mut [&mut diary])
                    .unwrap_or_else(|failure| panic!("{failure}"));
                let [(0, t, false)] = diary.told[..] else {
                    panic!("{method:?} {step} {w0}: {:?}", diary.told);
                };
                let off = t - w0 * 0.45 / 0.11;
                assert!(off.abs() < 1e-5, "{method:?} {step} {w0}: off by {off:e}");
            }
        }
    }
}
