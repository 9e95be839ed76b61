//! A run: from a plan to rows and a report.
//!
//! In:  a mechanism, its start, a [`Plan`].
//! Out: rows to a [`RowSink`] while they are computed, a [`Report`].
//!
//! Compiled once for each pair of sizes.

use crate::column::Column;
use crate::error::CommandError;
use crate::interrupt;
use bricard_runtime::{
    Counters, DynamicsError, Observer, Occurrence, Options, Passage, Probe, Sampler, Start, State,
    Step, Summary, Whole, assemble, simulate,
};
use std::cell::RefCell;
use std::ops::ControlFlow;
use std::rc::Rc;
use std::time::{Duration, Instant};

/// How to integrate and what to record.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Method, end, form of the equations.
    pub options: Options<f64>,
    /// Distance of the rows (s); a row after each step if there is none.
    pub every: Option<f64>,
    /// Columns besides time, coordinates and velocities.
    pub columns: Vec<Column>,
}

/// Receives rows.
pub trait RowSink {
    /// Takes a row: time, coordinates, velocities, added columns.
    ///
    /// # Errors
    ///
    /// What stands in the way; it ends the run.
    fn row(&mut self, values: &[f64]) -> Result<(), CommandError>;
}

/// What was done in a run, and how well.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Accepted steps.
    pub steps: u64,
    /// Steps that were tried and thrown away.
    pub rejected: u64,
    /// Time it took.
    pub wall: Duration,
    /// The largest error of a constraint equation, in its unit.
    pub constraint_error: f64,
    /// The largest difference between the energy and what it should be (J).
    pub energy_error: f64,
    /// Passages through singular positions.
    pub passages: Vec<Passage<f64>>,
    /// Events: the name and the time (s) of each.
    pub events: Vec<(&'static str, f64)>,
    /// Work by kind.
    pub counters: Counters,
}

/// A run that could not begin or ended early.
#[derive(Debug)]
pub struct Stopped {
    /// Why.
    pub error: CommandError,
    /// When (s), if it had begun.
    pub time: Option<f64>,
    /// What was done before.
    pub report: Option<Box<Report>>,
}

/// Runs a mechanism from a start.
///
/// # Errors
///
/// [`Stopped`], with what was reached.
pub fn run<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    start: &Start<f64, N>,
    plan: &Plan,
    sink: &mut dyn RowSink,
) -> Result<Report, Stopped> {
    let refuse = |reason: String| {
        let error = CommandError::Run {
            reason,
            kept: String::new(),
        };
        Stopped {
            error,
            time: None,
            report: None,
        }
    };
    let state = assemble(mechanism, start, 0.0).map_err(|error| refuse(error.to_string()))?;
    let mut writer = Writer::new(plan, sink).map_err(|error| refuse(error.to_string()))?;
    let begun = Instant::now();
    let result = simulate(mechanism, &state, &plan.options, &mut [&mut writer]);
    let wall = begun.elapsed();
    let (refused, seen) = (writer.refused, writer.seen);
    match (result, refused) {
        (Ok(summary), None) => Ok(report(&summary, seen, wall)),
        (Ok(summary), Some(error)) => {
            let time = Some(summary.end.t);
            Err(Stopped {
                error,
                time,
                report: Some(Box::new(report(&summary, seen, wall))),
            })
        }
        (Err(failure), _) => {
            let report = report(&failure.summary, seen, wall);
            let reason = failure.error.to_string();
            let error = CommandError::Run {
                reason,
                kept: String::new(),
            };
            let time = Some(failure.summary.end.t);
            Err(Stopped {
                error,
                time,
                report: Some(Box::new(report)),
            })
        }
    }
}

fn report<const N: usize>(summary: &Summary<f64, N>, seen: Seen, wall: Duration) -> Report {
    Report {
        steps: summary.steps,
        rejected: summary.rejected,
        wall,
        constraint_error: summary.constraint_error.map_or(0.0, |error| error.position),
        energy_error: summary.energy_error.unwrap_or(0.0),
        passages: seen.passages,
        events: seen.events,
        counters: summary.counters,
    }
}

type States<const N: usize> = Rc<RefCell<Vec<State<f64, N>>>>;
type Collect<const N: usize> = Box<dyn FnMut(&State<f64, N>) -> ControlFlow<()>>;

/// What happened on the way.
#[derive(Default)]
struct Seen {
    passages: Vec<Passage<f64>>,
    events: Vec<(&'static str, f64)>,
}

/// Turns states into rows.
struct Writer<'a, const N: usize> {
    sampler: Option<Sampler<f64, Collect<N>>>,
    sampled: States<N>,
    columns: &'a [Column],
    sink: &'a mut dyn RowSink,
    refused: Option<CommandError>,
    seen: Seen,
}

impl<'a, const N: usize> Writer<'a, N> {
    fn new(
        plan: &'a Plan,
        sink: &'a mut dyn RowSink,
    ) -> Result<Self, bricard_runtime::BadInterval<f64>> {
        let sampled = States::default();
        let sampler = match plan.every {
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
        let (columns, refused, seen) = (&plan.columns, None, Seen::default());
        Ok(Self {
            sampler,
            sampled,
            columns,
            sink,
            refused,
            seen,
        })
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
        match &mut self.sampler {
            Some(sampler) => {
                let _goes_on = sampler.begin(state, probe)?;
            }
            None => self.sampled.borrow_mut().push(*state),
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
        let flow = self.write(probe)?;
        if flow.is_continue() && interrupt::is_wanted() {
            let kept = String::new();
            self.refused = Some(CommandError::Interrupted { kept });
            return Ok(ControlFlow::Break(()));
        }
        Ok(flow)
    }

    fn passage(&mut self, passage: &Passage<f64>) -> ControlFlow<()> {
        self.seen.passages.push(*passage);
        ControlFlow::Continue(())
    }

    fn event(&mut self, occurrence: &Occurrence<f64, N>) -> ControlFlow<()> {
        self.seen
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
