//! The reference motion of a mechanism.
//!
//! In:  a mechanism, its state at the start, the time of the end.
//! Out: [`Reference`]: the state there, and an estimate of its error.
//!
//! Two runs of the method of order 8, whose coefficients have 30 digits, at two
//! tolerances: the finer is the result, the difference says what the coarser one is
//! off by, which the result is well below.

use crate::DoubleDouble;
use bricard_runtime::{
    AssemblyError, Audit, Interface, Mechanism, Options, Pace, Real, Scheme, Settings,
    SimulateError, Start, State, Stepper, assemble, simulate,
};
use core::fmt::{Display, Formatter, Result as FmtResult};

/// Tolerance of the finer run.
const FINE: f64 = 1e-23;

/// Tolerance of the coarser run.
const COARSE: f64 = 1e-21;

/// A motion that other runs can be compared with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference<const N: usize> {
    /// The state at the end.
    pub end: State<DoubleDouble, N>,
    /// How far the coarser run ended from there, the largest difference of a
    /// coordinate (m, rad) or velocity (m/s, rad/s).
    pub error: f64,
    /// Steps of the finer run.
    pub steps: u64,
}

/// Why there is no reference motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReferenceError<const N: usize, const R: usize> {
    /// The mechanism could not be assembled at its start.
    Assembly(AssemblyError<DoubleDouble, N, R>),
    /// The run could not be made.
    Run(SimulateError<DoubleDouble>),
}

impl<const N: usize, const R: usize> Display for ReferenceError<N, R> {
    fn fmt(&self, f: &mut Formatter<'_>) -> FmtResult {
        match self {
            Self::Assembly(error) => error.fmt(f),
            Self::Run(error) => error.fmt(f),
        }
    }
}

impl<const N: usize, const R: usize> core::error::Error for ReferenceError<N, R> {}

/// Computes where a mechanism is at the time `until` (s), having started at `t = 0`
/// as its description says, with the parameters and inputs that are set: good to about
/// 20 digits, singular positions or not, unless the motion is chaotic.
///
/// # Errors
///
/// [`ReferenceError`] if the mechanism does not assemble, or if a run fails.
pub fn reference<M, const N: usize, const R: usize>(
    mechanism: &M,
    until: DoubleDouble,
) -> Result<Reference<N>, ReferenceError<N, R>>
where
    M: Mechanism<DoubleDouble, N, R> + Interface<DoubleDouble, N> + ?Sized,
{
    reference_from(mechanism, &mechanism.start(), until)
}

/// As [`reference()`], from another start than the description's.
///
/// # Errors
///
/// As [`reference()`].
pub fn reference_from<M, const N: usize, const R: usize>(
    mechanism: &M,
    start: &Start<DoubleDouble, N>,
    until: DoubleDouble,
) -> Result<Reference<N>, ReferenceError<N, R>>
where
    M: Mechanism<DoubleDouble, N, R> + Interface<DoubleDouble, N> + ?Sized,
{
    let start =
        assemble(mechanism, start, DoubleDouble::default()).map_err(ReferenceError::Assembly)?;
    let run = |tolerance: f64| {
        let options = Options {
            audit: Audit::NONE,
            ..Options::dop853(until, DoubleDouble::from(tolerance))
        };
        simulate(mechanism, &start, &options, &mut [])
            .map_err(|failure| ReferenceError::Run(failure.error))
    };
    let (coarse, fine) = (run(COARSE)?, run(FINE)?);
    let changes = (fine.end.q - coarse.end.q)
        .iter()
        .chain((fine.end.v - coarse.end.v).iter())
        .fold(0.0, |most: f64, x| most.max(x.to_f64().abs()));
    Ok(Reference {
        end: fine.end,
        error: changes,
        steps: fine.steps,
    })
}

/// The states at some times, in their order, on the way from a state.
///
/// # Errors
///
/// [`SimulateError`] if the run could not be made, with the time.
pub fn states_at<M, const N: usize, const R: usize>(
    mechanism: &M,
    start: &State<DoubleDouble, N>,
    times: &[DoubleDouble],
) -> Result<Vec<State<DoubleDouble, N>>, SimulateError<DoubleDouble>>
where
    M: Mechanism<DoubleDouble, N, R> + ?Sized,
{
    let tolerance = DoubleDouble::from(FINE);
    let pace = Pace::Adaptive {
        relative: tolerance,
        absolute: tolerance,
    };
    let mut stepper: Stepper<DoubleDouble, N, R> =
        Stepper::new(Scheme::Dop853, pace, Settings::default())?;
    let mut state = *start;
    let mut states = Vec::with_capacity(times.len());
    for time in times {
        if *time > state.t {
            let span = *time - state.t;
            stepper.step(mechanism, &mut state, span)?;
        }
        states.push(state);
    }
    Ok(states)
}
