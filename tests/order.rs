//! Observed order of convergence on the paper's runs, singular positions included.
//!
//! Over eight seconds the energy error of a Runge–Kutta method, which is of one order
//! more than the method, outgrows all others; the method on the exact reduction shows
//! the same. So the order is that of the largest error in the first second, in which
//! every run passes a singular position.

use crate::motion::{end, run};
use crate::reduction::Reduction;
use bricard_runtime::{Method, Options, StepControl};
use std::ops::RangeInclusive;

/// Times at which errors are taken (s), multiples of every step.
const TIMES: [f64; 10] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];

/// The largest error of q₁ in the first second.
fn error(reduction: Reduction, method: Method, step: f64) -> f64 {
    let from = (reduction.start(), 0.0);
    let at = |t: f64| {
        let options = Options::new(t, method, StepControl::Fixed { step });
        let (exact, _) = reduction.after(t, from);
        (run(reduction.name(), &options).q[0] - exact).abs()
    };
    TIMES.into_iter().map(at).fold(0.0, f64::max)
}

/// The order from the coarsest step to the finest.
fn check(reduction: Reduction, method: Method, steps: &[f64], orders: RangeInclusive<f64>) {
    let errors: Vec<f64> = steps
        .iter()
        .map(|step| error(reduction, method, *step))
        .collect();
    let halvings = (steps[0] / steps[steps.len() - 1]).log2();
    let observed = (errors[0] / errors[errors.len() - 1]).log2() / halvings;
    assert!(
        orders.contains(&observed),
        "{}, {method}: order {observed:.2} from errors {errors:?}",
        reduction.name()
    );
}

#[test]
fn rk4_converges_with_order_four_through_singular_positions() {
    for reduction in Reduction::ALL {
        check(
            reduction,
            Method::Rk4,
            &[0.02, 0.01, 0.005, 0.0025],
            3.8..=4.2,
        );
    }
}

#[test]
fn dp5_converges_with_order_five_through_singular_positions() {
    for reduction in Reduction::ALL {
        // On the exact reduction these steps show 4.9 to 5.3.
        check(reduction, Method::Dp5, &[0.01, 0.005, 0.0025], 4.8..=5.4);
    }
}

#[test]
fn redundant_coordinates_cost_no_accuracy_against_the_exact_reduction() {
    for reduction in Reduction::ALL {
        let exact = end(reduction.name(), 8.0).q1;
        let from = (reduction.start(), 0.0);
        for (step, steps) in [(0.02, 400), (0.01, 800), (0.005, 1600)] {
            let reduced = (0..steps)
                .fold(from, |motion, _| reduction.step(motion, step))
                .0;
            let found = run(reduction.name(), &Options::rk4(8.0, step)).q[0];
            let (found, allowed) = ((found - exact).abs(), 2.0 * (reduced - exact).abs());
            let name = reduction.name();
            assert!(
                found <= allowed,
                "{name}, h = {step}: {found:e}, reduced {allowed:e} / 2"
            );
        }
    }
}
