//! Our runs.

use crate::problem::{End, Failed, Problem};
use bricard_runtime::{Interface, Mechanism, Method, Settings, State, StepControl, Stepper};
use instructions::mechanism::double_four_bar_folded::double_four_bar::DoubleFourBar;
use instructions::mechanism::slider_crank_folded::slider_crank::SliderCrank;

#[expect(dead_code, reason = "a run asks for less than a description gives")]
mod driven {
    include!(concat!(env!("OUT_DIR"), "/slider_crank_driven.rs"));
}
use driven::slider_crank_driven::SliderCrankDriven;

/// Runs a problem from a start angle at rest.
///
/// # Errors
///
/// A run that fails.
pub fn run(
    problem: Problem,
    start: f64,
    method: Method,
    step_control: StepControl<f64>,
) -> Result<End, Failed> {
    let q = problem.coordinates(start);
    let (method, until) = ((method, step_control), problem.end());
    match problem {
        Problem::Free => end::<_, 3, 2>(&SliderCrank::default(), &q, method, until),
        Problem::Driven => end::<_, 3, 2>(&SliderCrankDriven::default(), &q, method, until),
        Problem::FourBar => end::<_, 5, 4>(&DoubleFourBar::default(), &q, method, until),
    }
}

fn end<M, const N: usize, const R: usize>(
    mechanism: &M,
    q: &[f64],
    (method, step_control): (Method, StepControl<f64>),
    until: f64,
) -> Result<End, Failed>
where
    M: Mechanism<f64, N, R> + Interface<f64, N>,
{
    let mut state = State::<f64, N>::default();
    state.q.copy_from_slice(q);
    let mut stepper = Stepper::<f64, N, R>::new(method, step_control, Settings::default())?;
    stepper.step(mechanism, &mut state, until)?;
    Ok(state.q.as_slice().to_vec())
}
