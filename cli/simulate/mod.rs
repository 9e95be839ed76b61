//! `bricard simulate`: rows of numbers, a summary, a plot.
//!
//! In:  a mechanism's name and what to change, how to integrate, what to record.
//! Out: CSV or Parquet, a summary on standard error, SVG or HTML.

mod choices;
mod legs;
mod record;
pub mod summary;

pub use choices::TOLERANCE;

use crate::arguments::Simulate;
use crate::changes;
use crate::column::columns;
use crate::error::CommandError;
use crate::interrupt;
use crate::law::find_with;
use crate::output::say;
use crate::plot::Marks;
use crate::run::{Report, Stopped, run};
use bricard_runtime::Structure;
use record::Record;

/// Simulates a mechanism.
pub fn simulate(arguments: &Simulate) -> Result<(), CommandError> {
    let (mut mechanism, set) = find_with(&arguments.name, &arguments.set)?;
    let structure = mechanism.structure();
    let changes = changes::find(structure, &arguments.name, &set, &arguments.start)?;
    for name in changes::negative_inertia(&changes, structure) {
        say(&format!("warning: `{name}` is an inertia, and negative"));
    }
    changes::apply(&changes, mechanism.as_mut());
    let columns = columns(&arguments.columns, structure, &arguments.name)?;
    let mut plan = choices::plan(arguments, columns.clone())?;
    choices::check_files(arguments)?;
    plan.legs = legs::legs(arguments, &plan, &changes, structure)?;
    let mut record = Record::open(arguments, structure, &columns)?;
    if let Some(checkpoint) = plan.legs.as_ref().and_then(|legs| legs.from.as_ref()) {
        record.go_on(checkpoint);
    }
    interrupt::listen();
    let result = run(mechanism.as_ref(), &plan, &mut record);
    let report = match &result {
        Ok(report) => Some(report),
        Err(stopped) => stopped.report.as_deref(),
    };
    let marks = report
        .map(|report| marks(report, structure))
        .unwrap_or_default();
    let kept = record.close(arguments, &marks, structure, &columns)?;
    if let Some(report) = report.filter(|report| result.is_ok() || report.steps > 0) {
        say(summary::summary(report, structure).trim_end());
    }
    match result {
        Ok(_) => Ok(()),
        Err(Stopped { error, .. }) => {
            legs::say_how_to_go_on(arguments);
            match error {
                CommandError::Run { reason, .. } => Err(CommandError::Run { reason, kept }),
                CommandError::Interrupted { .. } => Err(CommandError::Interrupted { kept }),
                error => Err(error),
            }
        }
    }
}

/// What is marked in a plot: singular positions, and the events by name.
fn marks(report: &Report, structure: &Structure) -> Vec<Marks> {
    let passages = report.passages.iter().map(|passage| passage.t);
    let passages = Marks {
        times: passages.collect(),
        name: "singular position".to_string(),
    };
    let events = structure.events.iter().map(|event| {
        let of_name = report.events.iter().filter(|(name, _)| *name == event.name);
        Marks {
            times: of_name.map(|(_, t)| *t).collect(),
            name: event.name.to_string(),
        }
    });
    std::iter::once(passages).chain(events).collect()
}
