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
    AssemblyError, Dop853, IntegrateError, Integrator, Interface, Mechanism, Real, Settings,
    SimulateError, Solver, Start, State, Tolerance, assemble,
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
    if until < start.t {
        let start = start.t;
        return Err(ReferenceError::Run(SimulateError::BadEnd { start, until }));
    }
    let run = |tolerance: f64| -> Result<_, SimulateError<DoubleDouble>> {
        let mut run = Run::new(mechanism, start, tolerance)?;
        run.go_on(until)?;
        Ok((run.state, run.steps))
    };
    let ((coarse, _), (fine, steps)) = (
        run(COARSE).map_err(ReferenceError::Run)?,
        run(FINE).map_err(ReferenceError::Run)?,
    );
    let changes = (fine.q - coarse.q)
        .iter()
        .chain((fine.v - coarse.v).iter())
        .fold(0.0, |most: f64, x| Real::max(most, x.to_f64().abs()));
    Ok(Reference {
        end: fine,
        error: changes,
        steps,
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
    let mut run = Run::new(mechanism, *start, FINE)?;
    let states = times.iter().map(|time| {
        run.go_on(*time)?;
        Ok(run.state)
    });
    states.collect()
}

/// A run by the method of order 8 and nothing else: what a mechanism can do besides
/// would be compiled a second time for these numbers.
struct Run<'a, M: ?Sized, const N: usize, const R: usize> {
    mechanism: &'a M,
    solver: Solver<DoubleDouble, N, R>,
    method: Dop853<DoubleDouble, N>,
    state: State<DoubleDouble, N>,
    steps: u64,
}

impl<'a, M, const N: usize, const R: usize> Run<'a, M, N, R>
where
    M: Mechanism<DoubleDouble, N, R> + ?Sized,
{
    /// A run that begins at a state near the constraints.
    fn new(
        mechanism: &'a M,
        mut state: State<DoubleDouble, N>,
        tolerance: f64,
    ) -> Result<Self, SimulateError<DoubleDouble>> {
        let tolerance = DoubleDouble::from(tolerance);
        let mut solver = Solver::new(Settings::default());
        let projected = solver.on(mechanism).project(&mut state);
        projected.map_err(IntegrateError::Dynamics)?;
        Ok(Self {
            mechanism,
            solver,
            method: Dop853::adaptive(Tolerance::uniform(tolerance, tolerance)?),
            state,
            steps: 0,
        })
    }

    /// Moves on to a time, in as many steps as the tolerance demands.
    fn go_on(&mut self, until: DoubleDouble) -> Result<(), SimulateError<DoubleDouble>> {
        let mut system = self.solver.on(self.mechanism);
        while self.state.t < until {
            let step = self.method.step(&mut system, &self.state, until)?;
            self.state = *step.end();
            self.steps += 1;
        }
        Ok(())
    }
}
