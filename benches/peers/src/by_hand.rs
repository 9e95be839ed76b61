//! The chain by hand, in diffsol and, for the exact motion, in an integrator of order 8.

use crate::chain::Chain;
use crate::{Failed, UNTIL};
use beside::tsit45;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Dop853, DynamicsError, Integrator, State, System, Tolerance};

/// Tolerance of what errors are measured against.
const EXACT: f64 = 1e-13;

/// The angles at the end of a run of diffsol's explicit method of order 5.
///
/// # Errors
///
/// A solver that stops.
pub fn diffsol(n: usize, closed: bool, tolerance: f64) -> Result<Vec<f64>, Failed> {
    let mut chain = Chain::new(n, closed);
    let start = chain.start();
    tsit45(&start, UNTIL, tolerance, |angles, rates, out| {
        chain.accelerations(angles, rates, out);
    })
}

/// The angles at the end, by a method of order 8 near round-off.
///
/// # Errors
///
/// A run that stops.
pub fn exact<const N: usize>(closed: bool) -> Result<Vec<f64>, Failed> {
    let mut system = ByHand(Chain::new(N, closed));
    let q = SVector::from_vec(system.0.start());
    let mut state = State::<f64, N>::new(0.0, q, SVector::zeros());
    let mut method = Dop853::adaptive(Tolerance::uniform(EXACT, EXACT)?);
    while state.t < UNTIL {
        let step = method.step(&mut system, &state, UNTIL);
        state = *step.map_err(|error| error.to_string())?.end();
    }
    Ok(state.q.as_slice().to_vec())
}

struct ByHand(Chain);

impl<const N: usize> System<f64, N> for ByHand {
    fn acceleration(
        &mut self,
        state: &State<f64, N>,
    ) -> Result<SVector<f64, N>, DynamicsError<f64>> {
        let mut out = SVector::<f64, N>::zeros();
        let (angles, rates) = (state.q.as_slice(), state.v.as_slice());
        self.0.accelerations(angles, rates, out.as_mut_slice());
        Ok(out)
    }

    fn project(&mut self, _state: &mut State<f64, N>) -> Result<(), DynamicsError<f64>> {
        Ok(())
    }
}
