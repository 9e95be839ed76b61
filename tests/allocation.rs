//! Running a generated mechanism allocates nothing: a counting allocator proves it.

use crate::library::{Inspect, inspect, step_scale};
use allocation_counter::measure;
use bricard::double_four_bar::DoubleFourBar;
use bricard::heavy_top::HeavyTop;
use bricard::rolling_disc::RollingDisc;
use bricard_runtime::{
    Method, Options, Settings, State, StepControl, Stepper, Whole, assemble, simulate,
};

const ADAPTIVE: StepControl<f64> = StepControl::Adaptive {
    relative: 1e-8,
    absolute: 1e-8,
};

/// Each method, with steps that suit a mechanism of usual speed.
const METHODS: [(Method, StepControl<f64>); 5] = [
    (Method::Rk4, StepControl::Fixed { step: 0.01 }),
    (Method::Dp5, ADAPTIVE),
    (Method::Dop853, ADAPTIVE),
    (Method::Radau5, ADAPTIVE),
    (Method::Radau9, ADAPTIVE),
];

/// Counts the allocations of a whole run with all audits.
struct Count {
    method: Method,
    /// As for a mechanism of usual speed.
    step_control: StepControl<f64>,
    step_scale: f64,
}

impl Inspect<f64> for Count {
    /// Allocations while assembling and running.
    type Output = [u64; 2];

    fn inspect<const N: usize, const R: usize>(
        self,
        mechanism: &mut dyn Whole<f64, N, R>,
    ) -> Self::Output {
        let mechanism = &*mechanism;
        let step_control = match self.step_control {
            StepControl::Fixed { step } => StepControl::Fixed {
                step: step * self.step_scale,
            },
            adaptive => adaptive,
        };
        let mut start = State::default();
        let assembling = measure(|| {
            start = assemble(mechanism, &mechanism.start(), 0.0).expect("the start assembles");
        });
        let options = Options::new(self.step_scale, self.method, step_control);
        let running = measure(|| {
            let run = simulate(mechanism, &start, &options, &mut []);
            assert!(run.is_ok(), "the run ends well");
        });
        [assembling, running].map(|counted| counted.count_total)
    }
}

#[test]
fn running_a_mechanism_allocates_nothing() {
    for (method, step_control) in METHODS {
        for name in bricard::NAMES {
            let count = Count {
                method,
                step_control,
                step_scale: step_scale(name),
            };
            let counted = inspect(name, count);
            assert_eq!(counted, [0; 2], "{name}, {method}: assembling, running");
        }
    }
}

/// Allocations of a hundred steps on demand.
fn stepping<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    (method, step_control): (Method, StepControl<f64>),
) -> u64 {
    let mut state = assemble(mechanism, &mechanism.start(), 0.0).expect("the start assembles");
    let mut stepper: Stepper<f64, N, R> =
        Stepper::new(method, step_control, Settings::default()).expect("a step control that fits");
    let counted = measure(|| {
        for _ in 0..100 {
            let stepped = stepper.step(mechanism, &mut state, 0.01);
            stepped.expect("a step");
        }
    });
    counted.count_total
}

#[test]
fn stepping_on_demand_allocates_nothing() {
    for method in METHODS {
        assert_eq!(stepping(&DoubleFourBar::default(), method), 0, "{method:?}");
        assert_eq!(stepping(&RollingDisc::default(), method), 0, "{method:?}");
        assert_eq!(stepping(&HeavyTop::default(), method), 0, "{method:?}");
    }
}
