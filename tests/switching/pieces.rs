//! Runs that go on from where an event ended another tell each event once.

use crate::events::Diary;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Interface, Method, Options, State, StepControl, Whole, assemble, simulate};
use bricard_switching::contact::Contact;
use bricard_switching::paused::Paused;
use bricard_switching::stopping::Stopping;

/// Every method, with fixed steps and with tolerances.
fn ways(until: f64) -> Vec<Options<f64>> {
    let methods = [Method::Dp5, Method::Dop853, Method::Radau5, Method::Radau9];
    let fixed = StepControl::Fixed { step: 0.003 };
    let mut ways = vec![Options::rk4(until, 0.003)];
    for method in methods {
        ways.push(Options::new(until, method, fixed));
        for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
            ways.push(Options {
                method,
                ..Options::dop853(until, tolerance)
            });
        }
    }
    ways
}

/// The events of a motion, of which each ends a run, and something is done before the next; at
/// most so many.
fn in_pieces<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    start: State<f64, N>,
    options: &Options<f64>,
    most: usize,
    between: fn(&mut State<f64, N>),
) -> Vec<(usize, f64, bool)> {
    let mut state = start;
    let mut diary = Diary {
        ends: true,
        ..Diary::default()
    };
    while diary.told.len() < most && state.t < options.until {
        let run = simulate(mechanism, &state, options, &mut [&mut diary]);
        state = run.unwrap_or_else(|failure| panic!("{failure}")).end;
        // Nothing happens after the end, at the same instant or not.
        assert!(diary.told.iter().all(|(_, t, _)| *t <= state.t));
        between(&mut state);
    }
    diary.told
}

/// Compares the events of a motion in one piece with those in pieces.
fn check<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    start: State<f64, N>,
    options: &Options<f64>,
) {
    let name = format!("{:?} {:?}", options.method, options.step_control);
    let mut whole = Diary::default();
    simulate(mechanism, &start, options, &mut [&mut whole])
        .unwrap_or_else(|failure| panic!("{name}: {failure}"));
    let most = 2 * whole.told.len();
    let pieces = in_pieces(mechanism, start, options, most, |_| {});
    assert!(whole.told.len() > 3, "{name}: {:?}", whole.told);
    for event in 0..mechanism.structure().events.len() {
        // The order of those that happen at once is that of round-off.
        let of = |told: &[(usize, f64, bool)]| -> Vec<f64> {
            let told = told.iter().filter(|(index, ..)| *index == event);
            told.map(|(_, t, _)| *t).collect()
        };
        let [pieces, whole] = [of(&pieces), of(&whole.told)];
        assert_eq!(pieces.len(), whole.len(), "{name}: {pieces:?} {whole:?}");
        for (piece, whole) in pieces.iter().zip(whole) {
            assert!((piece - whole).abs() < 1e-3, "{name}: {piece} {whole}");
        }
    }
}

#[test]
fn each_event_is_told_once_if_each_ends_a_run() {
    let mut oscillator = Contact::default();
    let mut crank = Paused::default();
    for k in 0..4_u8 {
        let shift = f64::from(k) / 7.0;
        oscillator.parameters.d = 0.3 + shift;
        let start = State::new(
            1e3 * shift,
            SVector::from([0.2 + shift, 1.0]),
            SVector::zeros(),
        );
        (crank.parameters.q0, crank.parameters.w0) = (0.1 + shift, 5.0 + shift);
        let closed = assemble::<f64, _, 3, 2>(&crank, &crank.start(), 0.0).expect("a start");
        for options in ways(start.t + 2.0) {
            check::<2, 0>(&oscillator, start, &options);
        }
        for options in ways(2.0) {
            check::<3, 2>(&crank, closed, &options);
        }
    }
}

#[test]
fn a_block_bounces_as_often_as_it_comes_to_a_stop() {
    for k in 1..6_u8 {
        let d = f64::from(k) / 6.0;
        let mut oscillator = Contact::default();
        oscillator.parameters.d = d;
        let start = State::new(0.0, [1e3, 0.0].into(), [0.0, 10.0].into());
        for options in ways(2.0) {
            let back = |state: &mut State<f64, 2>| state.v[1] = -state.v[1];
            let told = in_pieces::<2, 0>(&oscillator, start, &options, 100, back);
            let crossing = 2.0 * d.asin() / 10.0;
            let name = format!("{d} {:?} {:?}", options.method, options.step_control);
            assert_eq!(told.len(), (2.0 / crossing + 0.5) as usize, "{name}");
            for (i, (_, t, _)) in told.iter().enumerate() {
                let exact = (i as f64 + 0.5) * crossing;
                assert!((t - exact).abs() < 1e-3, "{name}: {t} instead of {exact}");
            }
        }
    }
}

/// What stopped stays: its velocity doesn't come to zero again.
#[test]
fn what_friction_stopped_is_told_once() {
    let mut block = Stopping::default();
    block.parameters.rise = 0.0;
    let start = State::new(0.0, [0.0].into(), [1.0].into());
    for options in ways(2.0) {
        let told = in_pieces::<1, 0>(&block, start, &options, 100, |_| {});
        let name = format!("{:?} {:?}", options.method, options.step_control);
        assert_eq!(told.len(), 1, "{name}: {told:?}");
    }
}
