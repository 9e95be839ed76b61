//! `bricard simulate`: rows of numbers, a summary, a plot.
//!
//! In:  a mechanism's name and what to change, how to integrate, what to record.
//! Out: CSV or Parquet, a summary on standard error, SVG or HTML.

mod checkpoints;
mod choices;
mod film;
mod picture;
mod record;
pub mod summary;

pub use choices::TOLERANCE;

use crate::arguments::Simulate;
use crate::changes;
use crate::column::columns;
use crate::error::CommandError;
use crate::interrupt;
use crate::law::find_with;
use crate::output::{print, say};
use crate::page::Live;
use crate::run::{Stopped, run};
use picture::Picture;
use record::Record;

/// Simulates a mechanism.
pub fn simulate(arguments: &Simulate) -> Result<(), CommandError> {
    simulate_for(arguments, None)
}

/// Simulates a mechanism for a page that is kept up to date, if there is one.
pub fn simulate_for(arguments: &Simulate, live: Option<&Live>) -> Result<(), CommandError> {
    let (mut mechanism, set) = find_with(&arguments.name, &arguments.set)?;
    let structure = mechanism.structure();
    let changes = changes::find(structure, &arguments.name, &set, &arguments.start)?;
    let tell = |text: &str| {
        if !arguments.quiet {
            say(text);
        }
    };
    for name in changes::negative_inertia(&changes, structure) {
        tell(&format!("warning: `{name}` is an inertia, and negative"));
    }
    changes::apply(&changes, mechanism.as_mut());
    let columns = columns(&arguments.columns, structure, &arguments.name)?;
    let mut plan = choices::plan(arguments, columns.clone())?;
    choices::check_files(arguments)?;
    plan.checkpoints = checkpoints::checkpoints(arguments, &plan, &changes, structure)?;
    let mut record = Record::open(arguments, structure, &columns)?;
    let shown = picture::shown(arguments, &columns, structure)?;
    plan.columns = shown.columns.clone();
    let checkpoints = plan.checkpoints.as_ref();
    if let Some(checkpoint) = checkpoints.and_then(|all| all.from.as_ref()) {
        record.go_on(checkpoint);
    }
    interrupt::listen();
    let result = run(mechanism.as_ref(), &plan, &mut record);
    let report = match &result {
        Ok(report) => Some(report),
        Err(stopped) => stopped.report.as_deref(),
    };
    let picture = Picture {
        arguments,
        mechanism: mechanism.as_ref(),
        plan: &plan,
        shown: &shown,
        report,
        error: result.as_ref().err().map(|stopped| &stopped.error),
        live,
    };
    let kept = record.close(|rows| picture.draw(rows))?;
    if let Some(report) = report.filter(|report| result.is_ok() || report.steps > 0) {
        tell(summary::summary(report, structure).trim_end());
    }
    if let Some(report) = report.filter(|_| arguments.json) {
        let error = result.as_ref().err().map(|stopped| &stopped.error);
        print(&summary::json(report, structure, error))?;
    }
    match result {
        Ok(_) => Ok(()),
        Err(Stopped { error, .. }) => {
            checkpoints::say_how_to_go_on(arguments);
            match error {
                CommandError::Run { reason, .. } => Err(CommandError::Run { reason, kept }),
                CommandError::Interrupted { .. } => Err(CommandError::Interrupted { kept }),
                error => Err(error),
            }
        }
    }
}
