//! Our runs.

use crate::problem::Problem;
use crate::run::{End, Failed};
use bricard_runtime::{Interface, Mechanism, Pace, Scheme, Settings, State, Stepper};
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
pub fn run(problem: Problem, start: f64, scheme: Scheme, pace: Pace<f64>) -> Result<End, Failed> {
    let q = problem.coordinates(start);
    let (scheme, until) = ((scheme, pace), problem.end());
    match problem {
        Problem::Free => end::<_, 3, 2>(&SliderCrank::default(), &q, scheme, until),
        Problem::Driven => end::<_, 3, 2>(&SliderCrankDriven::default(), &q, scheme, until),
        Problem::FourBar => end::<_, 5, 4>(&DoubleFourBar::default(), &q, scheme, until),
    }
}

fn end<M, const N: usize, const R: usize>(
    mechanism: &M,
    q: &[f64],
    (scheme, pace): (Scheme, Pace<f64>),
    until: f64,
) -> Result<End, Failed>
where
    M: Mechanism<f64, N, R> + Interface<f64, N>,
{
    let mut state = State::<f64, N>::default();
    state.q.copy_from_slice(q);
    let mut stepper = Stepper::<f64, N, R>::new(scheme, pace, Settings::default())?;
    stepper.step(mechanism, &mut state, until)?;
    Ok(state.q.as_slice().to_vec())
}
