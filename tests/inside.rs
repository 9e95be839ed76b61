//! What observers are told of the inside of a step that passes a singular configuration is
//! the same in both forms that pass one.

use crate::library::{Inspect, REDUNDANT, inspect};
use bricard_runtime::{
    DynamicsError, Form, Observer, Options, OtherBranch, Probe, Step, Whole, assemble, simulate,
};
use std::ops::ControlFlow;

/// How far the observed states are apart (s): some lie in every passage.
const EVERY: f64 = 0.01;
/// How far accelerations of the two forms may differ, relative to their size.
const APART: f64 = 1e-7;

/// Observes accelerations at equal distances.
struct Observed {
    form: Form,
}

impl Inspect<f64> for Observed {
    type Output = Vec<Vec<f64>>;

    fn inspect<const N: usize, const R: usize>(
        self,
        mechanism: &mut dyn Whole<f64, N, R>,
    ) -> Vec<Vec<f64>> {
        let mechanism = &*mechanism;
        let mut options = Options::dop853(5.0, 1e-11);
        options.settings.form = self.form;
        let start = assemble(mechanism, &mechanism.start(), 0.0).expect("the start assembles");
        let mut accelerations = Accelerations { rows: Vec::new() };
        let result = simulate(mechanism, &start, &options, &mut [&mut accelerations]);
        result.unwrap_or_else(|failure| panic!("{}: {}", self.form, failure.error));
        accelerations.rows
    }
}

struct Accelerations {
    rows: Vec<Vec<f64>>,
}

impl<const N: usize> Observer<f64, N> for Accelerations {
    fn step(
        &mut self,
        step: &Step<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        loop {
            let t = self.rows.len() as f64 * EVERY;
            if t >= step.end().t {
                return Ok(ControlFlow::Continue(()));
            }
            let mut state = step.at(t);
            probe.project(&mut state, OtherBranch::Refused)?;
            let acceleration = probe.acceleration(&state, &mut [])?;
            self.rows.push(acceleration.as_slice().to_vec());
        }
    }
}

#[test]
fn states_within_a_passage_are_observed_in_both_forms_that_pass() {
    let passing = ["slider_crank", "slider_crank_driven", "double_four_bar"];
    for name in passing.into_iter().chain(REDUNDANT) {
        let of = |form| inspect(name, Observed { form });
        let (full, reduced) = (of(Form::Full), of(Form::Reduced));
        assert_eq!(full.len(), reduced.len(), "{name}");
        for (row, (a, b)) in full.iter().zip(&reduced).enumerate() {
            for (a, b) in a.iter().zip(b) {
                assert!(
                    (a - b).abs() <= APART * b.abs().max(1.0),
                    "{name} at {} s: {a} and {b}",
                    row as f64 * EVERY
                );
            }
        }
    }
}
