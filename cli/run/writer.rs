//! Rows, progress and legs: what watches a run for the command line.
//!
//! In:  steps.
//! Out: rows to a [`RowSink`], a line of progress, [`Checkpoint`]s at the ends of legs.

use super::{Plan, Report, RowSink};
use crate::checkpoint::{CALM_SINE, Checkpoint, EXTRA_STEPS, LEG_STEPS, Rows};
use crate::column::Column;
use crate::error::CommandError;
use crate::interrupt;
use crate::progress::Progress;
use bricard_runtime::{
    BadInterval, DynamicsError, Observer, Occurrence, Origin, Passage, Probe, Sampler, State, Step,
    Summary,
};
use std::cell::RefCell;
use std::iter::once;
use std::ops::ControlFlow;
use std::rc::Rc;

type States<const N: usize> = Rc<RefCell<Vec<State<f64, N>>>>;
type Collect<const N: usize> = Box<dyn FnMut(&State<f64, N>) -> ControlFlow<()>>;

/// What is left of the last interval between rows is round-off up to this part of it.
const SHORT: f64 = 1e-9;

/// Turns states into rows, and takes note of what happened on the way.
pub(super) struct Writer<'a, const N: usize> {
    sampler: Option<Sampler<f64, Collect<N>>>,
    sampled: States<N>,
    columns: &'a [Column],
    sink: &'a mut dyn RowSink,
    rows: u64,
    progress: Progress,
    /// The state that the run begins with, and the time at which it ends (s).
    first: State<f64, N>,
    until: f64,
    /// The distance of the rows, and the time of the last one (s).
    every: Option<f64>,
    last: f64,
    /// Whether there are legs, and the steps of this one.
    leg: Option<u64>,
    /// Whether the run was broken off for the next leg.
    pub(super) leg_is_over: bool,
    /// The beginning of the run, once it has begun.
    pub(super) origin: Option<Origin<f64>>,
    /// What the rows were refused for.
    pub(super) refused: Option<CommandError>,
    /// What was done.
    pub(super) done: Report,
}

impl<'a, const N: usize> Writer<'a, N> {
    /// A writer of a plan's rows, from a state.
    pub(super) fn new(
        plan: &'a Plan,
        sink: &'a mut dyn RowSink,
        first: State<f64, N>,
    ) -> Result<Self, BadInterval<f64>> {
        let sampled = States::default();
        let mut sampler = match plan.every {
            Some(every) => {
                let states = Rc::clone(&sampled);
                let collect: Collect<N> = Box::new(move |state| {
                    states.borrow_mut().push(*state);
                    ControlFlow::Continue(())
                });
                Some(Sampler::new(every, collect)?)
            }
            None => None,
        };
        let from = plan.legs.as_ref().and_then(|legs| legs.from.as_ref());
        if let (Some(sampler), Some(checkpoint)) = (&mut sampler, from) {
            sampler.go_on(checkpoint.origin.t, checkpoint.rows.count);
        }
        Ok(Self {
            sampler,
            sampled,
            columns: &plan.columns,
            sink,
            rows: from.map_or(0, |checkpoint| checkpoint.rows.count),
            first,
            until: plan.options.until,
            every: plan.every,
            last: first.t,
            progress: Progress::new(first.t, plan.options.until, plan.watched),
            leg: plan.legs.as_ref().map(|_| 0),
            leg_is_over: false,
            origin: from.map(|checkpoint| checkpoint.origin),
            refused: None,
            done: from.map_or_else(Report::default, |checkpoint| checkpoint.report.clone()),
        })
    }

    /// The checkpoint at the end of a leg.
    ///
    /// # Errors
    ///
    /// What stands in the way of the rows.
    pub(super) fn checkpoint(
        &mut self,
        summary: &Summary<f64, N>,
    ) -> Result<Checkpoint, CommandError> {
        let supplied = summary.energy_supplied.unwrap_or(0.0);
        let origin = self.origin.unwrap_or(Origin {
            t: 0.0,
            energy: 0.0,
            supplied,
        });
        let origin = Origin { supplied, ..origin };
        self.origin = Some(origin);
        let rows = Rows {
            count: self.rows,
            ..self.sink.settle()?
        };
        let end = &summary.end;
        let state = once(&end.t).chain(&end.q).chain(&end.v).copied().collect();
        Ok(Checkpoint {
            origin,
            state,
            rows,
            report: self.done.clone(),
        })
    }

    /// Whether a leg ends with this state: where it is long enough, and the state is not
    /// next to a singular position.
    fn ends_leg(
        &mut self,
        state: &State<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<bool, DynamicsError<f64>> {
        let Some(steps) = &mut self.leg else {
            return Ok(false);
        };
        *steps += 1;
        Ok(*steps >= LEG_STEPS
            && (*steps >= LEG_STEPS + EXTRA_STEPS || probe.rank(state)?.sine >= CALM_SINE))
    }

    /// Adds a row at the end of the run, where the last interval is a short one.
    fn end(&mut self, state: &State<f64, N>) {
        let Some(every) = self.every.filter(|_| state.t >= self.until) else {
            return;
        };
        let mut sampled = self.sampled.borrow_mut();
        let last = sampled.last().map_or(self.last, |row| row.t);
        if state.t - last > every * SHORT {
            sampled.push(*state);
        }
    }

    /// Hands the sampled states over as rows.
    fn write(
        &mut self,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        let states: Vec<_> = self.sampled.borrow_mut().drain(..).collect();
        for state in &states {
            let row = row(state, self.columns, probe)?;
            if let Err(error) = self.sink.row(&row) {
                self.refused = Some(error);
                return Ok(ControlFlow::Break(()));
            }
            self.rows += 1;
            self.last = state.t;
        }
        Ok(ControlFlow::Continue(()))
    }
}

impl<const N: usize> Observer<f64, N> for Writer<'_, N> {
    fn begin(
        &mut self,
        state: &State<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        self.leg_is_over = false;
        self.leg = self.leg.map(|_| 0);
        if self.origin.is_some() {
            // A later leg: its first row is the last one of the leg before.
            return Ok(ControlFlow::Continue(()));
        }
        let energy = probe.energy(state).balance;
        self.origin = Some(Origin {
            t: state.t,
            energy,
            supplied: 0.0,
        });
        // The projection of the start may have moved what is held by its round-off.
        let first = self.first;
        match &mut self.sampler {
            Some(sampler) => {
                let _goes_on = sampler.begin(&first, probe)?;
            }
            None => self.sampled.borrow_mut().push(first),
        }
        self.write(probe)
    }

    fn step(
        &mut self,
        step: &Step<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        match &mut self.sampler {
            Some(sampler) => {
                let _goes_on = sampler.step(step, probe)?;
            }
            None => self.sampled.borrow_mut().push(*step.end()),
        }
        self.end(step.end());
        self.progress.step(step.end().t);
        let flow = self.write(probe)?;
        if flow.is_break() {
            return Ok(flow);
        }
        if interrupt::is_wanted() {
            let kept = String::new();
            self.refused = Some(CommandError::Interrupted { kept });
            return Ok(ControlFlow::Break(()));
        }
        self.leg_is_over = self.ends_leg(step.end(), probe)?;
        match self.leg_is_over {
            true => Ok(ControlFlow::Break(())),
            false => Ok(ControlFlow::Continue(())),
        }
    }

    fn passage(&mut self, passage: &Passage<f64>) -> ControlFlow<()> {
        self.done.passages.push(*passage);
        ControlFlow::Continue(())
    }

    fn event(&mut self, occurrence: &Occurrence<f64, N>) -> ControlFlow<()> {
        self.done
            .events
            .push((occurrence.event.name, occurrence.state.t));
        ControlFlow::Continue(())
    }

    fn looks_inside(&self) -> bool {
        self.sampler.is_some()
    }
}

/// The numbers of a row.
fn row<const N: usize>(
    state: &State<f64, N>,
    columns: &[Column],
    probe: &mut dyn Probe<f64, N>,
) -> Result<Vec<f64>, DynamicsError<f64>> {
    let mut row = vec![state.t];
    row.extend(state.q.iter().chain(state.v.iter()));
    let reactions = columns
        .iter()
        .any(|column| matches!(column, Column::Reaction(_)));
    let reaction = if reactions {
        Some(probe.reaction(state)?)
    } else {
        None
    };
    let mut outputs = vec![0.0; probe.structure().outputs.len()];
    if columns
        .iter()
        .any(|column| matches!(column, Column::Output(_)))
    {
        probe.outputs(state, &mut outputs);
    }
    for column in columns {
        row.push(match column {
            Column::Energy => {
                let energy = probe.energy(state);
                energy.kinetic + energy.potential
            }
            Column::Kinetic => probe.energy(state).kinetic,
            Column::Potential => probe.energy(state).potential,
            Column::ConstraintError => probe.constraint_error(state).position,
            Column::VelocityError => probe.constraint_error(state).velocity,
            Column::Rank => probe.rank(state)?.rank as f64,
            Column::Reaction(i) => reaction.map_or(f64::NAN, |r| r[*i]),
            Column::Output(i) => outputs[*i],
        });
    }
    Ok(row)
}
