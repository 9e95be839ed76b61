//! Steps on demand, for programs that act between them.
//!
//! In:  a mechanism, a state, how far to go.
//! Out: the state there.
//!
//! Not here: observers and audits ([`super::simulate`]).

use super::driver::{Driver, tolerance};
use super::evaluation_limit::LimitedEvaluations;
use super::options::StepControl;
use super::{Grid, SimulateError};
use crate::integrator::Inside;
use crate::stack::{MaybeBoxed, maybe_boxed, with_room};
use crate::{Counters, Integrator, Mechanism, Method, Real, Settings, Solver, State, System};

/// Makes steps on demand and does not hold the mechanism in between, so that a
/// program can set its inputs.
///
/// Steps begin at the state as it is given: other than [`simulate`](crate::simulate), which
/// projects its start, a step from a state that is off the constraints is off until its end.
/// [`ConstrainedSystem::project`](crate::ConstrainedSystem::project), of
/// [`solver`](Self::solver), brings a state back after lengths have changed, say, and
/// [`assemble`](crate::assemble) finds one anew.
///
/// After a step that failed it may be used again from any state; the length of its next step
/// is then a choice of its own, as at its beginning.
///
/// What it needs is taken when it is made, and nothing after that.
#[derive(Debug)]
pub struct Stepper<T, const N: usize, const R: usize> {
    solver: Solver<T, N, R>,
    driver: MaybeBoxed<Driver<T, N>>,
    step_control: StepControl<T>,
}

impl<T: Clone, const N: usize, const R: usize> Clone for Stepper<T, N, R> {
    fn clone(&self) -> Self {
        with_room::<T, _, N, R>(|| Self {
            solver: self.solver.clone(),
            driver: self.driver.clone(),
            step_control: self.step_control.clone(),
        })
    }

    /// Without allocating.
    fn clone_from(&mut self, other: &Self) {
        self.solver.clone_from(&other.solver);
        with_room::<T, _, N, R>(|| self.driver.clone_from(&other.driver));
        self.step_control.clone_from(&other.step_control);
    }
}

impl<T: Real, const N: usize, const R: usize> Stepper<T, N, R> {
    /// A stepper that has made no step yet.
    ///
    /// # Errors
    ///
    /// [`SimulateError`] if the step control is not usable: a step that isn't positive, a
    /// tolerance that isn't or that is below round-off, or a tolerance for a
    /// method without error estimate.
    pub fn new(
        method: Method,
        step_control: StepControl<T>,
        settings: Settings<T>,
    ) -> Result<Self, SimulateError<T>> {
        with_room::<T, _, N, R>(|| {
            let tolerance = tolerance(method, step_control)?;
            Ok(Self {
                solver: Solver::new(settings),
                driver: maybe_boxed(|| Driver::new(method, tolerance, Inside::Nothing)),
                step_control,
            })
        })
    }

    /// Becomes a stepper that has made no step yet, in the memory that it has.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new); nothing is changed then.
    pub fn renew(
        &mut self,
        method: Method,
        step_control: StepControl<T>,
        settings: Settings<T>,
    ) -> Result<(), SimulateError<T>> {
        with_room::<T, _, N, R>(|| {
            let tolerance = tolerance(method, step_control)?;
            let driver: &mut Driver<T, N> = &mut self.driver;
            *driver = Driver::new(method, tolerance, Inside::Nothing);
            self.solver.renew(settings);
            self.step_control = step_control;
            Ok(())
        })
    }

    /// Moves `state` on by `span` seconds, in as many steps as the step control wants.
    /// Inputs keep their values meanwhile, unless they follow a law.
    ///
    /// # Errors
    ///
    /// [`SimulateError`] with the time; `state` is then the last good one.
    pub fn step<M>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
        span: T,
    ) -> Result<(), SimulateError<T>>
    where
        M: Mechanism<T, N, R> + ?Sized,
    {
        let until = state.t + span;
        let grid = Grid::new(state.t, until, self.step_control)?;
        self.driver.forget();
        self.solver.bind(mechanism.structure());
        self.solver.expect_error(self.step_control.tolerance());
        let mut system = self.solver.on(mechanism);
        let driver: &mut Driver<T, N> = &mut self.driver;
        with_room::<T, _, N, R>(|| {
            for i in 1..grid.intervals() {
                go(driver, &mut system, state, grid.time(i))?;
            }
            go(driver, &mut system, state, until)
        })
    }

    /// Moves `state` on by `span` seconds within a deadline: with at most `most` evaluations of the
    /// equations of motion; says how many it took.
    ///
    /// All other work of a step is in proportion to them, because every loop of the
    /// runtime is over sizes of the mechanism, or has a constant bound, or evaluates the
    /// equations in each turn. So a time measured for one evaluation bounds that of a step.
    ///
    /// # Errors
    ///
    /// As [`step`](Self::step), and [`SimulateError::TooMuchWork`] if that is not enough:
    /// `state` is then the last good one, which may be a part of the way ahead. The stepper
    /// can go on from there. What is asked for when nothing is left gets no answer and ends
    /// the step, not at once but after a few dozen evaluations more at most.
    pub fn step_within<M>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
        span: T,
        most: u32,
    ) -> Result<u32, SimulateError<T>>
    where
        M: Mechanism<T, N, R> + ?Sized,
    {
        let limited = LimitedEvaluations::new(mechanism, most);
        let result = self.step(&limited, state, span);
        if limited.is_exceeded() {
            return Err(SimulateError::TooMuchWork { t: state.t, most });
        }
        result.map(|()| limited.asked())
    }

    /// Moves `state` on by one accepted step, as long as the step control wants it and at most to
    /// the time `bound` (s).
    ///
    /// # Errors
    ///
    /// [`SimulateError`] with the time; `state` is then the last good one.
    pub fn step_once<M>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
        bound: T,
    ) -> Result<(), SimulateError<T>>
    where
        M: Mechanism<T, N, R> + ?Sized,
    {
        let grid = Grid::new(state.t, bound, self.step_control)?;
        if grid.intervals() == 0 {
            return Ok(());
        }
        self.driver.forget();
        self.solver.bind(mechanism.structure());
        self.solver.expect_error(self.step_control.tolerance());
        let mut system = self.solver.on(mechanism);
        *state = *self.driver.step(&mut system, state, grid.time(1))?.end();
        Ok(())
    }

    /// What the solver did so far.
    pub fn counters(&self) -> Counters {
        self.solver.counters()
    }

    /// The solver, to ask for reactions, rank and constraint errors.
    pub fn solver(&mut self) -> &mut Solver<T, N, R> {
        &mut self.solver
    }
}

/// Moves `state` on to a time, in as many steps as the method wants.
#[inline(always)]
fn go<T: Real, Y: System<T, N>, const N: usize>(
    driver: &mut Driver<T, N>,
    system: &mut Y,
    state: &mut State<T, N>,
    until: T,
) -> Result<(), SimulateError<T>> {
    while state.t < until {
        *state = *driver.step(system, state, until)?.end();
    }
    Ok(())
}
