//! Steps as long as a caller wants, however short what is left is.

use crate::mechanisms::{Passing, SliderCrank};
use bricard_runtime::{Method, Settings, State, StepControl, Stepper};

const METHODS: [Method; 4] = [Method::Dp5, Method::Dop853, Method::Radau5, Method::Radau9];

fn stepper(method: Method) -> Stepper<f64, 3, 2> {
    let step_control = StepControl::Adaptive {
        relative: 1e-9,
        absolute: 1e-9,
    };
    Stepper::new(method, step_control, Settings::default()).unwrap()
}

fn started() -> (SliderCrank, State<f64, 3>) {
    let mechanism = SliderCrank::default();
    let (angle, rate) = mechanism.singular();
    let start = mechanism.state(0.0, angle - 0.5 * rate, rate);
    (mechanism, start)
}

/// The loop that most programs have: the last step is what sums of `h` leave.
#[test]
fn a_loop_of_sums_comes_to_its_end() {
    for method in METHODS {
        for (h, stop) in [(0.1, 1.0), (0.2, 2.0), (0.3, 3.0)] {
            let (mechanism, start) = started();
            let mut whole = start;
            stepper(method).step(&mechanism, &mut whole, stop).unwrap();
            let (mut stepper, mut state, mut t) = (stepper(method), start, 0.0);
            let mut last = h;
            while t < stop {
                last = f64::min(h, stop - t);
                stepper.step(&mechanism, &mut state, last).unwrap();
                t += last;
            }
            assert!(last < 1e-15, "{method:?}: no part was left of {stop} s");
            let apart = (state.q - whole.q).amax();
            assert!(apart < 1e-6, "{method:?}, {h} s: {apart:e}");
        }
    }
}

/// A span that is lost in the round-off of a later time tells nothing of the next step.
#[test]
fn a_tiny_span_leaves_the_next_step_as_it_was() {
    for method in METHODS {
        for tiny in [1e-300, 1e-20, 1e-17] {
            let (mechanism, mut state) = started();
            let mut stepper = stepper(method);
            stepper.step(&mechanism, &mut state, tiny).unwrap();
            assert_eq!(state.t, tiny, "{method:?}");
            stepper.step(&mechanism, &mut state, 0.1).unwrap();
            assert_eq!(state.t, tiny + 0.1, "{method:?}");
        }
    }
}
