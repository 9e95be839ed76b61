//! Everyone who watches a run, in the order in which they are shown a step.
//!
//! In:  accepted steps.
//! Out: whether the run goes on.

use super::event::Events;
use super::{Audit, Options, Origin, SimulateError, Summary};
use crate::integrator::Inside;
use crate::{
    ConstraintAudit, DynamicsError, EnergyAudit, Form, IntegrateError, Interface, Observer,
    Passage, Probe, RankAudit, Real, State, Step,
};
use core::ops::ControlFlow;

/// Audits, events and observers of a run.
pub(super) struct Watchers<'a, 'b, T, const N: usize> {
    constraints: Option<ConstraintAudit<T>>,
    energy: Option<EnergyAudit<T>>,
    rank: Option<RankAudit<T, N>>,
    events: Events<T>,
    observers: &'a mut [&'b mut dyn Observer<T, N>],
    form: Form,
    /// Where the step before the last began.
    before: State<T, N>,
}

/// Whether a form of the equations passes singular positions.
fn passes(form: Form) -> bool {
    match form {
        Form::Reduced | Form::Full => true,
        Form::Multipliers | Form::Partitioning => false,
    }
}

impl<'a, 'b, T: Real, const N: usize> Watchers<'a, 'b, T, N> {
    /// The watchers of a run of a mechanism with `rows` constraint equations.
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
        let form = options.settings.form;
        Self {
            constraints: constraints.then(ConstraintAudit::new),
            energy: energy.then(EnergyAudit::new),
            rank: (rows > 0 && (passages || !passes(form))).then(RankAudit::new),
            events: Events::default(),
            observers,
            form,
            before: State::default(),
        }
    }

    /// Shows everyone the initial state.
    pub(super) fn begin<I: Interface<T, N> + ?Sized>(
        &mut self,
        interface: &I,
        state: &State<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, SimulateError<T>> {
        self.before = *state;
        self.events = Events::new(interface, probe.structure().events, state)?;
        let mut flow = ControlFlow::Continue(());
        for watcher in self.all() {
            if watcher
                .begin(state, probe)
                .map_err(SimulateError::Observe)?
                .is_break()
            {
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

    /// Audits first, then the observers.
    fn all(&mut self) -> impl Iterator<Item = &mut dyn Observer<T, N>> {
        let constraints = self
            .constraints
            .iter_mut()
            .map(|x| x as &mut dyn Observer<T, N>);
        let energy = self.energy.iter_mut().map(|x| x as &mut dyn Observer<T, N>);
        let rank = self.rank.iter_mut().map(|x| x as &mut dyn Observer<T, N>);
        let others = self
            .observers
            .iter_mut()
            .map(|x| &mut **x as &mut dyn Observer<T, N>);
        constraints.chain(energy).chain(rank).chain(others)
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
        } else if self.rank.is_some() {
            Inside::Hermite
        } else {
            Inside::Nothing
        }
    }

    /// Shows everyone a step; `done.end` becomes its end.
    pub(super) fn show<I: Interface<T, N> + ?Sized>(
        &mut self,
        interface: &I,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
        done: &mut Summary<T, N>,
    ) -> Result<ControlFlow<()>, SimulateError<T>> {
        let mut flow = self.passages(step, probe, done)?;
        let cut = self.occurrences(interface, step, probe, done)?;
        let step = cut.as_ref().unwrap_or(step);
        if cut.is_some() {
            flow = ControlFlow::Break(());
        }
        self.before = *step.start();
        let observe = SimulateError::Observe;
        if let Some(audit) = &mut self.constraints {
            let _: ControlFlow<()> = audit.step(step, probe).map_err(observe)?;
        }
        if let Some(audit) = &mut self.energy {
            let _: ControlFlow<()> = audit.step(step, probe).map_err(observe)?;
        }
        for observer in self.observers.iter_mut() {
            if observer.step(step, probe).map_err(observe)?.is_break() {
                flow = ControlFlow::Break(());
            }
        }
        done.end = *step.end();
        Ok(flow)
    }

    /// Looks for passages through singular positions, and refuses them to forms
    /// that only jumped over one.
    fn passages(
        &mut self,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
        done: &mut Summary<T, N>,
    ) -> Result<ControlFlow<()>, SimulateError<T>> {
        let Some(rank) = &mut self.rank else {
            return Ok(ControlFlow::Continue(()));
        };
        let mut first: Option<Passage<T>> = None;
        let mut flow = ControlFlow::Continue(());
        let observers = &mut *self.observers;
        let mut found = |passage: &Passage<T>| {
            first.get_or_insert(*passage);
            for observer in observers.iter_mut() {
                if observer.passage(passage).is_break() {
                    flow = ControlFlow::Break(());
                }
            }
        };
        rank.look(step, probe, &mut found)
            .map_err(SimulateError::Observe)?;
        match first {
            Some(Passage { t, rank, .. }) if !passes(self.form) => {
                if t < step.start().t {
                    done.end = self.before;
                }
                let error = DynamicsError::SingularPosition {
                    t,
                    form: self.form,
                    rank,
                    structure: probe.structure(),
                };
                Err(IntegrateError::Dynamics(error).into())
            }
            _ => Ok(flow),
        }
    }

    /// Locates the events of a step; the step up to the event at which an
    /// observer broke off, if one did.
    fn occurrences<I: Interface<T, N> + ?Sized>(
        &mut self,
        interface: &I,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
        done: &mut Summary<T, N>,
    ) -> Result<Option<Step<T, N>>, SimulateError<T>> {
        if self.events.is_empty() {
            return Ok(None);
        }
        let mut from = step.start().t;
        for to in step.look_times() {
            let found = self.events.look(interface, probe, step, (from, to));
            for occurrence in found.map_err(SimulateError::Observe)?.iter() {
                done.events += 1;
                let mut flow = ControlFlow::Continue(());
                for observer in self.observers.iter_mut() {
                    if observer.event(occurrence).is_break() {
                        flow = ControlFlow::Break(());
                    }
                }
                if flow.is_break() {
                    return Ok(Some(step.cut(occurrence.state)));
                }
            }
            from = to;
        }
        Ok(None)
    }

    /// Adds what the audits found.
    pub(super) fn report(&self, done: Summary<T, N>) -> Summary<T, N> {
        Summary {
            passages: self.rank.as_ref().map(RankAudit::count),
            constraint_error: self.constraints.as_ref().map(ConstraintAudit::largest),
            energy_error: self.energy.as_ref().map(EnergyAudit::largest),
            energy_supplied: self.energy.as_ref().map(EnergyAudit::supplied),
            ..done
        }
    }
}
