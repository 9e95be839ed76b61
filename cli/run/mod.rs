//! A run: from a plan to rows and a report.
//!
//! In:  a mechanism, its start, a [`Plan`].
//! Out: rows to a [`RowSink`] while they are computed, a [`Report`].
//!
//! Compiled once for each pair of sizes.

mod report;
mod writer;

pub use report::Report;

use crate::checkpoint::{Keeper, Legs, Rows};
use crate::column::Column;
use crate::error::CommandError;
use crate::mechanism::state_of;
use bricard_runtime::{AssemblyError, Options, Start, Whole, assemble, simulate};
use std::time::Instant;
use writer::Writer;

/// How to integrate and what to record.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Method, end, form of the equations.
    pub options: Options<f64>,
    /// Distance of the rows (s); a row after each step if there is none.
    pub every: Option<f64>,
    /// Columns besides time, coordinates and velocities.
    pub columns: Vec<Column>,
    /// The checkpoints of a run that has some.
    pub legs: Option<Legs>,
    /// Whether somebody waits for the run.
    pub watched: bool,
}

impl Plan {
    /// A run from its start to its end that nobody waits for.
    pub fn new(options: Options<f64>, every: Option<f64>, columns: Vec<Column>) -> Self {
        Self {
            options,
            every,
            columns,
            legs: None,
            watched: false,
        }
    }
}

/// Receives rows.
pub trait RowSink {
    /// Takes a row: time, coordinates, velocities, added columns.
    ///
    /// # Errors
    ///
    /// What stands in the way; it ends the run.
    fn row(&mut self, values: &[f64]) -> Result<(), CommandError>;

    /// Hands all rows over to where they go, and says what is there.
    ///
    /// # Errors
    ///
    /// As [`row`](Self::row).
    fn settle(&mut self) -> Result<Rows, CommandError> {
        Ok(Rows::default())
    }
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

fn failed(reason: String) -> CommandError {
    let kept = String::new();
    CommandError::Run { reason, kept }
}

/// What a start lacks, and how a guess is written here.
fn reason<const N: usize, const R: usize>(error: &AssemblyError<f64, N, R>) -> String {
    let text = error.to_string();
    match text.contains("(`~`)") {
        true => format!("{text}; on the command line a guess is `--start 'NAME~VALUE'`"),
        false => text,
    }
}

/// Runs a mechanism from a start, or from the checkpoint of the plan.
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
    let refuse = |reason: String| Stopped {
        error: failed(reason),
        time: None,
        report: None,
    };
    let from = plan.legs.as_ref().and_then(|legs| legs.from.as_ref());
    let mut state = match from {
        Some(checkpoint) => state_of(&checkpoint.state),
        None => assemble(mechanism, start, 0.0).map_err(|error| refuse(reason(&error)))?,
    };
    let mut writer = Writer::new(plan, sink, state).map_err(|e| refuse(e.to_string()))?;
    let mut keeper = plan.legs.as_ref().map(Keeper::new);
    let (begun, before) = (Instant::now(), writer.done.wall);
    loop {
        let options = Options {
            origin: writer.origin,
            ..plan.options
        };
        let result = simulate(mechanism, &state, &options, &mut [&mut writer]);
        let (summary, reason) = match result {
            Ok(summary) => (summary, None),
            Err(failure) => (failure.summary, Some(failure.error.to_string())),
        };
        state = summary.end;
        writer.done.wall = before + begun.elapsed();
        writer.done.add(&summary);
        let mut error = reason.map(failed).or_else(|| writer.refused.take());
        if error.is_none() {
            let ends = !writer.leg_is_over || state.t >= plan.options.until;
            match (ends, &mut keeper) {
                (true, _) | (_, None) => return Ok(writer.done),
                (false, Some(keeper)) => {
                    let taken = writer.checkpoint(&summary).and_then(|c| keeper.take(c));
                    error = taken.err();
                }
            }
        } else if let Some(keeper) = &mut keeper {
            // What stopped the run is the news, even if this fails, too.
            let _written = keeper.write();
        }
        if let Some(error) = error {
            let (time, report) = (Some(state.t), Some(Box::new(writer.done)));
            return Err(Stopped {
                error,
                time,
                report,
            });
        }
    }
}
