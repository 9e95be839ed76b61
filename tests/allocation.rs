//! Running a generated mechanism allocates nothing: a counting allocator proves it.

use crate::library::step_scale;
use allocation_counter::measure;
use bricard_runtime::{
    Interface, Mechanism, Method, Options, Settings, State, StepControl, Stepper, Visitor, Whole,
    assemble, simulate,
};

/// Counts the allocations of steps on demand and of a whole run with all audits.
struct Count {
    method: Method,
    /// As for a mechanism of usual speed.
    step_control: StepControl<f64>,
    step_scale: f64,
}

impl Visitor<f64> for Count {
    /// Allocations while assembling, stepping, and running.
    type Output = [u64; 3];

    fn visit<M, const N: usize, const R: usize>(self, mechanism: M) -> Self::Output
    where
        M: Mechanism<f64, N, R> + Interface<f64, N>,
    {
        let mechanism: &dyn Whole<f64, N, R> = &mechanism;
        let Count {
            method,
            step_control,
            step_scale,
        } = self;
        let step_control = match step_control {
            StepControl::Fixed { step } => StepControl::Fixed {
                step: step * step_scale,
            },
            adaptive => adaptive,
        };
        let mut state = State::default();
        let assembling = measure(|| {
            state = assemble(mechanism, &mechanism.start(), 0.0).expect("the start assembles");
        });
        let start = state;
        let settings = Settings::default();
        let mut stepper: Stepper<f64, N, R> =
            Stepper::new(method, step_control, settings).expect("a step control that fits");
        let stepping = measure(|| {
            for _ in 0..100 {
                stepper
                    .step(mechanism, &mut state, 0.01 * step_scale)
                    .expect("a step");
            }
        });
        let options = Options::new(step_scale, method, step_control);
        let running = measure(|| {
            let run = simulate(mechanism, &start, &options, &mut []);
            assert!(run.is_ok(), "the run ends well");
        });
        [assembling, stepping, running].map(|counted| counted.count_total)
    }
}

#[test]
fn running_a_mechanism_allocates_nothing() {
    let adaptive = StepControl::Adaptive {
        relative: 1e-8,
        absolute: 1e-8,
    };
    let fixed = StepControl::Fixed { step: 0.01 };
    for (method, step_control) in [
        (Method::Rk4, fixed),
        (Method::Dp5, adaptive),
        (Method::Dop853, adaptive),
        (Method::Radau5, adaptive),
        (Method::Radau9, adaptive),
    ] {
        for name in bricard::NAMES {
            let step_scale = step_scale(name);
            let count = Count {
                method,
                step_control,
                step_scale,
            };
            let counted = bricard::visit::<f64, _>(name, count);
            assert_eq!(
                counted,
                Some([0; 3]),
                "{name}, {method}: assembling, stepping, running"
            );
        }
    }
}
