//! Runs of a million steps every day, of a thousand million with `BRICARD_LONG=1`.

use crate::judge::start;
use bricard_runtime::{
    Audit, Interface, Mechanism, Method, Options, StepControl, Visitor, Whole, simulate,
};

/// Runs with the energy kept, and returns what the energy is off by, relative to its
/// size, with the number of steps.
struct Long {
    options: Options<f64>,
}

impl Visitor<f64> for Long {
    type Output = Result<(f64, u64), String>;

    fn visit<M, const N: usize, const R: usize>(self, mechanism: M) -> Self::Output
    where
        M: Mechanism<f64, N, R> + Interface<f64, N> + Clone + 'static,
    {
        let mechanism: &dyn Whole<f64, N, R> = &mechanism;
        let state = start(mechanism, &[])?;
        let size = 9.81;
        let ran = simulate(mechanism, &state, &self.options, &mut []);
        let summary = ran.map_err(|failure| failure.error.to_string())?;
        let off = mechanism.energy(&summary.end).balance - mechanism.energy(&state).balance;
        Ok((off.abs() / size, summary.steps))
    }
}

fn run(name: &str, method: Method, step_control: StepControl<f64>, until: f64) -> (f64, u64) {
    let mut options = Options::new(until, method, step_control);
    options.keep_energy = true;
    options.audit = Audit::NONE;
    let visited = bricard_stress::visit(name, Long { options });
    visited
        .expect("it is in the catalogue")
        .expect("the run ends")
}

fn is_long() -> bool {
    std::env::var_os("BRICARD_LONG").is_some()
}

#[test]
fn a_thousand_million_steps_keep_the_energy() {
    let steps = if is_long() { 1_000_000_000 } else { 1_000_000 };
    let step = 1e-3;
    let step_control = StepControl::Fixed { step };
    let (off, done) = run("pendulum", Method::Rk4, step_control, step * steps as f64);
    assert_eq!(done, steps);
    assert!(off < 1e-9, "the energy is off by {off:e} of itself");
}

#[test]
fn a_million_seconds_keep_the_energy() {
    let until = if is_long() { 1e6 } else { 1e3 };
    let step_control = StepControl::Adaptive {
        relative: 1e-9,
        absolute: 1e-9,
    };
    for name in ["pendulum", "point_pendulum"] {
        let (off, steps) = run(name, Method::Dop853, step_control, until);
        assert!(
            off < 1e-7,
            "{name}: the energy is off by {off:e} of itself after {steps} steps"
        );
    }
}
