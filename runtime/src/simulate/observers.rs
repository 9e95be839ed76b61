//! All observers of a run, in the order in which they are shown a step.
//!
//! In:  accepted steps.
//! Out: whether the run goes on.

use super::event::Events;
use super::event_functions::Functions;
use super::{Audit, Options, Origin, SimulateError, Summary};
use crate::integrator::Inside;
use crate::singular::Found;
use crate::{ConstraintAudit, DynamicsError, EnergyAudit, Observer, Probe, Real, State, Step};
use core::ops::ControlFlow;

/// Does something with an observer.
type Show<'a, T, const N: usize> =
    dyn FnMut(&mut dyn Observer<T, N>) -> Result<ControlFlow<()>, DynamicsError<T>> + 'a;

/// Finds the passages of a step after a time; none where the step was far from singular
/// configurations.
type Passages<'a, T> = &'a mut dyn FnMut(T) -> Option<Found<T>>;

/// Audits, events and observers of a run.
pub(super) struct Observers<'a, 'b, T, const N: usize> {
    constraints: Option<ConstraintAudit<T>>,
    energy: Option<EnergyAudit<T>>,
    /// How many passages there were, if they are counted.
    passages: Option<u64>,
    events: Events<T>,
    observers: &'a mut [&'b mut dyn Observer<T, N>],
}

impl<'a, 'b, T: Real, const N: usize> Observers<'a, 'b, T, N> {
    /// The observers of a run of a mechanism with `rows` constraint equations.
    pub(super) fn new(
        options: &Options<T>,
        rows: usize,
        observers: &'a mut [&'b mut dyn Observer<T, N>],
    ) -> Self {
        let Audit {
            constraints,
            energy,
            passages,
        } = options.audit;
        let tolerance = options.step_control.tolerance();
        Self {
            constraints: constraints.then(ConstraintAudit::new),
            energy: energy.then(|| EnergyAudit::of(tolerance)),
            passages: (rows > 0 && passages).then_some(0),
            events: Events::new(tolerance),
            observers,
        }
    }

    /// Shows all observers the initial state.
    #[inline(never)]
    pub(super) fn begin(
        &mut self,
        functions: Functions<'_, T, N>,
        state: &State<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, SimulateError<T>> {
        let events = probe.structure().events;
        self.events.begin(functions, events, state)?;
        self.all(&mut |watcher| watcher.begin(state, probe))
            .map_err(SimulateError::Observe)
    }

    /// Does something with all audits and observers; whether one of them broke off.
    #[inline(never)]
    fn all(&mut self, show: &mut Show<'_, T, N>) -> Result<ControlFlow<()>, DynamicsError<T>> {
        let mut flow = ControlFlow::Continue(());
        // Audits never break off.
        if let Some(audit) = &mut self.constraints {
            let _: ControlFlow<()> = show(audit)?;
        }
        if let Some(audit) = &mut self.energy {
            let _: ControlFlow<()> = show(audit)?;
        }
        for observer in self.observers.iter_mut() {
            if show(*observer)?.is_break() {
                flow = ControlFlow::Break(());
            }
        }
        Ok(flow)
    }

    /// Goes on with the audit of an earlier part of the run.
    pub(super) fn go_on(&mut self, origin: &Origin<T>) {
        if let Some(audit) = &mut self.energy {
            audit.go_on(origin.energy, origin.supplied);
        }
    }

    /// What must be kept of the inside of steps.
    pub(super) fn inside(&self) -> Inside {
        let energy = self
            .energy
            .as_ref()
            .is_some_and(Observer::<T, N>::looks_inside);
        let others = self.observers.iter().any(|x| x.looks_inside());
        if energy || others || !self.events.is_empty() {
            Inside::Full
        } else if self.passages.is_some() {
            Inside::Hermite
        } else {
            Inside::Nothing
        }
    }

    /// Shows everyone a step; `done.end` becomes its end.
    #[inline(never)]
    pub(super) fn show(
        &mut self,
        functions: Functions<'_, T, N>,
        step: &Step<T, N>,
        passages: Passages<'_, T>,
        probe: &mut dyn Probe<T, N>,
        done: &mut Summary<T, N>,
    ) -> Result<ControlFlow<()>, SimulateError<T>> {
        let cut = match self.events.is_empty() {
            true => None,
            false => self
                .occurrences(functions, step, probe, &mut done.events)
                .map_err(SimulateError::Observe)?,
        };
        let step = cut.as_ref().unwrap_or(step);
        let told = self.tell(passages, step.end().t);
        let shown = self
            .all(&mut |watcher| watcher.step(step, probe))
            .map_err(SimulateError::Observe)?;
        done.end = *step.end();
        let breaks = cut.is_some() || told.is_break() || shown.is_break();
        Ok(match breaks {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        })
    }

    /// Counts passages through singular configurations up to a time and tells all observers
    /// of them.
    fn tell(&mut self, passages: Passages<'_, T>, until: T) -> ControlFlow<()> {
        let mut flow = ControlFlow::Continue(());
        let Some(count) = &mut self.passages else {
            return flow;
        };
        let mut after = -T::from_f64(f64::INFINITY);
        while let Some(found) = passages(after) {
            for passage in found.iter().take_while(|passage| passage.t <= until) {
                *count += 1;
                for observer in self.observers.iter_mut() {
                    if observer.passage(passage).is_break() {
                        flow = ControlFlow::Break(());
                    }
                }
            }
            match found.rest_after() {
                Some(last) => after = last,
                None => break,
            }
        }
        flow
    }

    /// Locates the events of a step and counts them; the step up to the event at which an
    /// observer broke off, if one did. Others that happen there, too, are told before.
    #[inline(never)]
    fn occurrences(
        &mut self,
        functions: Functions<'_, T, N>,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
        count: &mut u64,
    ) -> Result<Option<Step<T, N>>, DynamicsError<T>> {
        self.events.look(functions, step)?;
        let mut cut: Option<Step<T, N>> = None;
        while let Some(mut occurrence) = self.events.next(functions, probe, step)? {
            // What happens at the same instant is no later than the end of the run.
            if let Some(cut) = &cut {
                occurrence.state = *cut.end();
            }
            *count += 1;
            let mut flow = ControlFlow::Continue(());
            for observer in self.observers.iter_mut() {
                if observer.event(&occurrence).is_break() {
                    flow = ControlFlow::Break(());
                }
            }
            if flow.is_break() && cut.is_none() {
                let state = &occurrence.state;
                self.events
                    .keep_simultaneous(functions, probe, step, state)?;
                cut = Some(step.cut(*state));
            }
        }
        Ok(cut)
    }

    /// Adds what the audits found.
    #[inline(never)]
    pub(super) fn report(&self, done: Summary<T, N>) -> Summary<T, N> {
        Summary {
            passages: self.passages,
            constraint_error: self.constraints.as_ref().map(ConstraintAudit::largest),
            energy_error: self.energy.as_ref().map(EnergyAudit::largest),
            energy_exchanged: self.energy.as_ref().map(EnergyAudit::exchanged),
            energy_supplied: self.energy.as_ref().map(EnergyAudit::supplied),
            ..done
        }
    }
}
