//! `bricard simulate`: rows of numbers, a summary, a plot.
//!
//! In:  a mechanism's name and what to change, how to integrate, what to record.
//! Out: CSV or Parquet, a summary on standard error, SVG or HTML.

mod cases;
mod checkpoints;
mod choices;
mod coarse;
mod film;
mod picture;
mod prepare;
mod record;
mod several;
pub mod summary;

pub use cases::only_one;
pub use choices::TOLERANCE;

use crate::arguments::Simulate;
use crate::comparison::Called;
use crate::compiled::browser;
use crate::description::Description;
use crate::error::CommandError;
use crate::interrupt;
use crate::law::described_with;
use crate::output::{print, say};
use crate::page::Live;
use crate::run::{Report, run};
use cases::Case;
use picture::Picture;
use prepare::{Prepared, prepared};
use record::Record;

/// Simulates a mechanism, once or for each value of a list.
pub fn simulate(arguments: &Simulate) -> Result<(), CommandError> {
    match cases::varied(arguments)? {
        Some(varied) => several::simulate(arguments, &varied),
        None => simulate_for(arguments, None),
    }
}

/// The mechanism as WebAssembly, if the page is to have sliders and that can be made; a page
/// without them is better than none.
///
/// # Errors
///
/// As [`described_with`].
fn module(arguments: &Simulate, case: &Case) -> Result<Option<Vec<u8>>, CommandError> {
    if !arguments.live {
        return Ok(None);
    }
    let Description { file, source } = described_with(&arguments.name, &case.set)?;
    let made = browser::module(&file, &source);
    Ok(made
        .map_err(|error| say(&format!("warning: the page has no sliders: {error}")))
        .ok())
}

/// Simulates a mechanism once, for a page that is kept up to date, if there is one.
pub fn simulate_for(arguments: &Simulate, live: Option<&Live>) -> Result<(), CommandError> {
    // What can be told from the command line is told before anything is compiled.
    let mut plan = choices::plan(arguments)?;
    let case = cases::single(arguments);
    let Prepared {
        mechanism,
        changes,
        columns,
    } = prepared(arguments, &case)?;
    let structure = mechanism.structure();
    plan.columns = columns.clone();
    plan.checkpoints = checkpoints::checkpoints((arguments, &case), &plan, &changes, structure)?;
    let absolute = choices::absolute(&plan);
    let mut record = Record::open(arguments, structure, &columns, None, absolute)?;
    let shown = picture::shown(arguments, &columns, structure)?;
    plan.columns = shown.columns.clone();
    let checkpoints = plan.checkpoints.as_ref();
    if let Some(checkpoint) = checkpoints.and_then(|all| all.from.as_ref()) {
        record.go_on(checkpoint)?;
    }
    let module = module(arguments, &case)?;
    interrupt::listen();
    let result = run(mechanism.as_ref(), &plan, &mut record);
    let report = match &result {
        Ok(report) => Some(report),
        Err(stopped) => stopped.report.as_deref(),
    };
    let error = result.as_ref().err().map(|stopped| &stopped.error);
    let settings = &plan.options.settings;
    let picture = Picture {
        arguments,
        mechanism: mechanism.as_ref(),
        plan: &plan,
        shown: &shown,
        report,
        summary: report
            .map(|report| summary::quantities(report, structure, settings))
            .unwrap_or_default(),
        error: error.map(ToString::to_string),
        live,
        module: module.as_deref().map(|module| (module, &changes)),
    };
    let kept = record.close(|rows| picture.draw(&[Called::alone(rows)]))?;
    if let Some(report) = report.filter(|report| result.is_ok() || report.steps > 0) {
        say(summary::summary(report, structure, settings).trim_end());
    }
    if arguments.json {
        let object = summary::json(report.unwrap_or(&Report::default()), structure, error);
        print(&format!("{object:#}\n"))?;
    }
    match result {
        Ok(_) => Ok(()),
        Err(stopped) => {
            checkpoints::say_how_to_go_on(arguments, stopped.resumable);
            Err(stopped.error.with(kept))
        }
    }
}
