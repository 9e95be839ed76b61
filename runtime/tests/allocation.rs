//! Nothing allocates: a counting allocator proves it.

use crate::fixtures::{Framed, PLAIN, simulate};
use crate::mechanisms::{FourBars, Passing, SliderCrank};
use allocation_counter::measure;
use bricard_runtime::{
    Form, Mechanism, Method, Options, Settings, Stabilisation, Start, State, StepControl, Stepper,
    Structure, assemble,
};

static CONSERVATIVE: Structure = Structure {
    conservative: true,
    ..PLAIN
};

/// Paces for every method.
const STEP_CONTROLS: [(Method, StepControl<f64>); 7] = [
    (Method::Radau5, StepControl::Fixed { step: 0.01 }),
    (
        Method::Radau5,
        StepControl::Adaptive {
            relative: 1e-7,
            absolute: 1e-7,
        },
    ),
    (Method::Rk4, StepControl::Fixed { step: 0.01 }),
    (Method::Dp5, StepControl::Fixed { step: 0.01 }),
    (
        Method::Dp5,
        StepControl::Adaptive {
            relative: 1e-8,
            absolute: 1e-8,
        },
    ),
    (Method::Dop853, StepControl::Fixed { step: 0.01 }),
    (
        Method::Dop853,
        StepControl::Adaptive {
            relative: 1e-10,
            absolute: 1e-10,
        },
    ),
];

/// Allocations of a function.
fn allocations(function: impl FnOnce()) -> u64 {
    measure(function).count_total
}

#[test]
fn steps_allocate_nothing_with_any_form_method_and_stabilisation() {
    let start = Passing::<5, 4>::state(&FourBars, 0.0, 80.0_f64.to_radians(), 0.0);
    let baumgarte = Stabilisation::Baumgarte {
        alpha: 10.0,
        beta: 10.0,
    };
    for form in Form::ALL {
        for stabilisation in [Stabilisation::Projection, baumgarte] {
            for (method, step_control) in STEP_CONTROLS {
                let settings = Settings {
                    form,
                    stabilisation,
                    ..Settings::default()
                };
                let mut stepper =
                    Stepper::<f64, 5, 4>::new(method, step_control, settings).unwrap();
                let mut copy = stepper.clone();
                let mechanism: &dyn Mechanism<f64, 5, 4> = &FourBars;
                let count = allocations(|| {
                    copy.clone_from(&stepper);
                    let mut state = start;
                    for _ in 0..8 {
                        // Through the first singular position, for those forms
                        // that can; the error of the others is free, too.
                        if stepper.step(mechanism, &mut state, 0.1).is_err() {
                            break;
                        }
                    }
                });
                assert_eq!(count, 0, "{form} {method} {step_control:?}");
            }
        }
    }
}

#[test]
fn whole_runs_with_audits_allocate_nothing() {
    let mechanism = Framed::new(FourBars, &CONSERVATIVE);
    let start = Passing::<5, 4>::state(&FourBars, 0.0, 80.0_f64.to_radians(), 0.0);
    for (method, step_control) in STEP_CONTROLS {
        let count = allocations(|| {
            let options = Options::new(3.0, method, step_control);
            let summary = simulate::<5, 4>(&mechanism, &start, &options, &mut []).unwrap();
            assert_eq!(summary.passages, Some(4));
        });
        assert_eq!(count, 0, "{method} {step_control:?}");
    }
}

#[test]
fn assembly_allocates_nothing() {
    use bricard_runtime::Initial;
    let crank = SliderCrank::default();
    let guess = Initial {
        value: 0.1,
        held: false,
    };
    let held = Initial {
        value: 0.8,
        held: true,
    };
    let start = Start {
        q: [held, guess, guess],
        v: [guess; 3],
    };
    let mut state = State::default();
    let count = allocations(|| state = assemble(&crank, &start, 0.0).unwrap());
    assert_eq!(count, 0);
    assert_eq!(state.q[0], 0.8);
}
