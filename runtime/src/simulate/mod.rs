//! The loop: integrate, project, observe.
//!
//! In:  a mechanism, a state on its constraints, [`Options`], observers.
//! Out: a [`Summary`], or a [`Failure`] with what was reached before.
//!
//! [`Stepper`] is the same without observers, one step at a time.

mod conserve;
mod driver;
mod error;
mod evaluation_limit;
mod event;
mod event_functions;
mod grid;
mod observers;
mod options;
mod simultaneous;
mod stepper;
mod summary;

pub use error::{Failure, SimulateError};
pub use options::{Audit, Options, Origin, StepControl};
pub use stepper::Stepper;
pub use summary::Summary;

use conserve::Conserving;
use driver::{Driver, tolerance};
use grid::Grid;
use observers::Observers;

use crate::dynamics::Core;
use crate::stack::with_room;
use crate::{
    ConstrainedSystem, DynamicsError, IntegrateError, Integrator, Interface, Mechanism, Observer,
    Real, State, Tolerance,
};
use core::ops::ControlFlow;

/// Runs a mechanism from a state to a time.
///
/// The start is projected onto the constraints first, which changes a state from
/// [`assemble`](crate::assemble) by no more than round-off.
///
/// # Errors
///
/// A [`Failure`] that carries the reason with its time, the last good state, and
/// the summary of what was done until then. Observers keep what they have.
#[expect(
    clippy::result_large_err,
    reason = "the failure of a run is returned once, and there is no allocator to box it with"
)]
pub fn simulate<T, M, const N: usize, const R: usize>(
    mechanism: &M,
    start: &State<T, N>,
    options: &Options<T>,
    observers: &mut [&mut dyn Observer<T, N>],
) -> Result<Summary<T, N>, Failure<T, N>>
where
    T: Real,
    M: Mechanism<T, N, R> + Interface<T, N> + ?Sized,
{
    with_room::<T, _, N, R>(|| {
        let mut solver = Core::new(options.settings);
        let mut inquiry = Core::new(options.settings);
        let mut observers = Observers::new(options, R, observers);
        let mut done = Summary::at(*start);
        let mut run = Run {
            mechanism,
            options,
            system: Conserving::new(solver.on(mechanism)),
            probe: inquiry.on(mechanism),
            observers: &mut observers,
            done: &mut done,
        };
        let result = run.all();
        done.counters = solver.counters;
        let summary = observers.report(done);
        match result {
            Ok(()) => Ok(summary),
            Err(error) => Err(Failure { error, summary }),
        }
    })
}

/// A run in progress.
struct Run<'a, 'b, 'c, M: ?Sized, T, const N: usize, const R: usize> {
    mechanism: &'a M,
    options: &'a Options<T>,
    system: Conserving<'a, M, T, N, R>,
    /// Answers what observers ask, apart from the run.
    probe: ConstrainedSystem<'a, M, T, N, R>,
    observers: &'a mut Observers<'b, 'c, T, N>,
    done: &'a mut Summary<T, N>,
}

impl<M, T, const N: usize, const R: usize> Run<'_, '_, '_, M, T, N, R>
where
    T: Real,
    M: Mechanism<T, N, R> + Interface<T, N> + ?Sized,
{
    /// From the start to the end.
    #[inline(never)]
    fn all(&mut self) -> Result<(), SimulateError<T>> {
        let Options {
            until,
            method,
            step_control,
            origin,
            ..
        } = *self.options;
        let mut state = self.done.end;
        if !state.is_finite() {
            return Err(SimulateError::StartNotFinite { t: state.t });
        }
        let tolerance = tolerance(method, step_control)?;
        let begun = origin.map_or(state.t, |origin| origin.t);
        let grid = Grid::new(begun, until, step_control)?;
        let first = grid.first_after(state.t);
        if self.options.keep_energy && !self.mechanism.structure().conservative {
            return Err(SimulateError::NotConservative);
        }
        self.begin(&mut state, tolerance.as_ref().map(Tolerance::relative))
            .map_err(IntegrateError::Dynamics)?;
        let events = |state: &_, values: &mut _| self.mechanism.events(state, values);
        let flow = self.observers.begin(&events, &state, &mut self.probe)?;
        if let Some(origin) = &origin {
            self.observers.go_on(origin);
        }
        if flow.is_break() {
            self.done.stopped = true;
            return Ok(());
        }
        let mut driver = Driver::new(method, tolerance, self.observers.inside());
        for interval in first..=grid.intervals() {
            let bound = grid.time(interval);
            while self.done.end.t < bound {
                if self.step(&mut driver, bound)?.is_break() {
                    self.done.stopped = true;
                    return Ok(());
                }
            }
        }
        Ok(())
    }

    /// Puts the start onto the constraints.
    fn begin(
        &mut self,
        state: &mut State<T, N>,
        tolerance: Option<T>,
    ) -> Result<(), DynamicsError<T>> {
        self.system.start(state, tolerance)?;
        self.done.end = *state;
        self.probe.follow(self.system.system());
        if self.options.keep_energy {
            let energy = self.options.origin.map(|origin| origin.energy);
            self.system.keep(state, energy)?;
        }
        Ok(())
    }

    /// One step, shown to everyone who watches.
    #[inline(never)]
    fn step(
        &mut self,
        driver: &mut Driver<T, N>,
        bound: T,
    ) -> Result<ControlFlow<()>, SimulateError<T>> {
        let state = self.done.end;
        if self
            .options
            .most_steps
            .is_some_and(|most| self.done.steps >= most)
        {
            let steps = self.done.steps;
            return Err(SimulateError::TooManySteps { t: state.t, steps });
        }
        let step = driver.step(&mut self.system, &state, bound)?;
        self.done.count(step);
        self.probe.follow(self.system.system());
        let system = self.system.system();
        let passages = &mut |after| system.passages_after(step, after);
        let events = |state: &_, values: &mut _| self.mechanism.events(state, values);
        self.observers
            .show(&events, step, passages, &mut self.probe, self.done)
    }
}
