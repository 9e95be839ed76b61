//! A run: from a plan to rows and a report.
//!
//! In:  a mechanism, a [`Plan`].
//! Out: rows to a [`RowSink`] while they are computed, a [`Report`].

mod plan;
mod report;
mod watcher;

pub use plan::{Plan, RowSink};
pub use report::Report;

use crate::checkpoint::{Checkpoint, CheckpointWriter, Rows};
use crate::error::CommandError;
use bricard_driver::{AnyMechanism, Reached};
use watcher::Watcher;

/// A run that could not begin or ended early.
#[derive(Debug)]
pub struct Stopped {
    /// Why.
    pub error: CommandError,
    /// When (s), if it had begun.
    pub time: Option<f64>,
    /// What was done before.
    pub report: Option<Box<Report>>,
    /// Whether the run can be taken up again from a checkpoint.
    pub resumable: bool,
}

/// What a start lacks, and how a guess is written here.
fn with_guess(text: String) -> String {
    match text.contains("(`~`)") {
        true => format!("{text}; on the command line a guess is `--start 'NAME~VALUE'`"),
        false => text,
    }
}

/// Runs a mechanism from its start, or from the checkpoint of the plan.
///
/// # Errors
///
/// [`Stopped`], with what was reached.
pub fn run(
    mechanism: &dyn AnyMechanism,
    plan: &Plan,
    sink: &mut dyn RowSink,
) -> Result<Report, Stopped> {
    let structure = mechanism.structure();
    let from = plan
        .checkpoints
        .as_ref()
        .and_then(|checkpoints| checkpoints.from.as_ref());
    let mut report = from.map_or_else(Report::default, |from| from.report.clone());
    let begun = from.and_then(|from| from.state.first().copied());
    let mut watcher = Watcher::new(plan, begun.unwrap_or(0.0), sink);
    let mut writer = plan.checkpoints.as_ref().map(CheckpointWriter::new);
    let mut segment = plan.segment(from);
    loop {
        let reached = mechanism
            .segment(&segment, &mut watcher)
            .map_err(|text| Stopped {
                error: CommandError::run(with_guess(text)),
                time: None,
                report: None,
                resumable: resumable(&writer),
            })?;
        report.add(&reached, structure);
        let time = reached.state.first().copied();
        let stopped = reached.error.clone().map(CommandError::run);
        let mut error = stopped.or_else(|| watcher.refused.take());
        if error.is_none() {
            let Some(writer) = &mut writer else {
                return Ok(report);
            };
            let more = time < Some(plan.options.until);
            match more.then(|| checkpoint(reached, &report, watcher.sink)) {
                Some(Ok(checkpoint)) => {
                    segment = plan.segment(Some(&checkpoint));
                    error = writer.take(checkpoint).err();
                }
                Some(Err(refused)) => error = Some(refused),
                None => match writer.end() {
                    Ok(()) => return Ok(report),
                    Err(refused) => error = Some(refused),
                },
            }
        } else if let Some(writer) = &mut writer {
            // What stopped the run is the news, even if this fails, too.
            let _written = writer.write();
        }
        if let Some(error) = error {
            let report = Some(Box::new(report));
            return Err(Stopped {
                error,
                time,
                report,
                resumable: resumable(&writer),
            });
        }
    }
}

/// Whether there is a checkpoint to go on from.
fn resumable(writer: &Option<CheckpointWriter>) -> bool {
    let writer = writer.as_ref();
    writer.is_some_and(CheckpointWriter::can_be_resumed)
}

/// The checkpoint at the end of a segment.
///
/// # Errors
///
/// What stands in the way of the rows.
fn checkpoint(
    reached: Reached,
    report: &Report,
    sink: &mut dyn RowSink,
) -> Result<Checkpoint, CommandError> {
    let rows = sink.flush()?;
    Ok(Checkpoint {
        origin: reached.origin,
        state: reached.state,
        rows: Rows {
            count: reached.rows,
            ..rows
        },
        report: report.clone(),
    })
}
