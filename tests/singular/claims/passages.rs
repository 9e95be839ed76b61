//! Very many passages with two degrees of freedom.

use crate::is_long;
use bricard_runtime::{DynamicsError, Observer, Probe, Step};
use bricard_runtime::{Options, State, Whole, assemble, simulate};
use bricard_singular::descriptions::parallelogram_pendulum::ParallelogramPendulum;
use core::f64::consts::PI;
use core::ops::ControlFlow;

/// Keeps the largest difference of the two cranks and angle of the coupler.
#[derive(Default)]
struct Largest(f64);

impl Observer<f64, 4> for Largest {
    fn step(
        &mut self,
        step: &Step<f64, 4>,
        _probe: &mut dyn Probe<f64, 4>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        let q = step.end().q;
        let off = (q[0] - q[2]).abs().max(q[1].abs());
        // What is not a number stays.
        self.0 = if off <= self.0 { self.0 } else { off };
        Ok(ControlFlow::Continue(()))
    }

    fn looks_inside(&self) -> bool {
        false
    }
}

#[test]
fn a_hundred_thousand_passages_with_two_freedoms_stay_on_their_branch() {
    let wanted = if is_long() { 100_000.0 } else { 1000.0 };
    let mut mechanism = ParallelogramPendulum::<f64>::default();
    let speed = 60.0;
    mechanism.parameters.w0 = speed;
    let mechanism: &dyn Whole<f64, 4, 2> = &mechanism;
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    // The pendulum takes a part of the speed; the crank never turns back.
    let until = 1.2 * wanted * PI / speed;
    let mut largest = Largest::default();
    let options = Options::dop853(until, 1e-9);
    let ran = simulate(mechanism, &start, &options, &mut [&mut largest]);
    let summary = ran.unwrap_or_else(|failure| panic!("{failure}"));
    let half_turns = |state: &State<f64, 4>| (state.q[0] / PI).floor();
    let passed = (half_turns(&summary.end) - half_turns(&start)).abs();
    assert!(passed >= wanted, "only {passed} passages");
    assert_eq!(summary.passages, Some(passed as u64));
    assert!(largest.0 < 1e-5, "the branch was left by {}", largest.0);
}
