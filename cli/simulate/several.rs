//! Several runs that differ in one value, compared.
//!
//! In:  the options of `simulate`, with a list of values.
//! Out: one table with a column for the value, a summary for each run, one picture.

use super::cases::Varied;
use super::picture::{Picture, Shown, shown};
use super::prepare::prepared;
use super::record::Record;
use super::{choices, summary};
use crate::arguments::Simulate;
use crate::comparison::Called;
use crate::error::CommandError;
use crate::interrupt;
use crate::output::{print, say};
use crate::run::{Plan, Report, run};
use bricard_driver::AnyMechanism;
use bricard_runtime::{Settings, Structure};
use serde_json::{Value, json};

/// What came of one of the runs.
struct Done {
    value: f64,
    name: String,
    mechanism: Box<dyn AnyMechanism>,
    report: Report,
    error: Option<CommandError>,
}

/// Simulates a mechanism for each value of a list. The end of a run that fails is not that of
/// the others.
///
/// # Errors
///
/// A [`CommandError`] if no run can begin, some have failed, or something can't be written.
pub fn simulate(arguments: &Simulate, varied: &Varied) -> Result<(), CommandError> {
    varied.check(arguments)?;
    let mut plan = choices::plan(arguments)?;
    // What is wrong with the command line is wrong for the first run, too.
    let first = prepared(arguments, &varied.first)?;
    let (structure, columns) = (first.mechanism.structure(), first.columns);
    let (column, absolute) = (varied.column(), choices::absolute(&plan));
    let mut record = Record::open(arguments, structure, &columns, Some(column), absolute)?;
    let shown = shown(arguments, &columns, structure)?;
    plan.columns = shown.columns.clone();
    interrupt::listen();
    let mut done: Vec<Done> = Vec::new();
    let mut runs = Vec::new();
    for (value, case) in varied.runs() {
        record.begin(value);
        let mechanism = prepared(arguments, case)?.mechanism;
        let (report, error) = match run(mechanism.as_ref(), &plan, &mut record) {
            Ok(report) => (report, None),
            Err(stopped) => {
                let report = stopped.report.map(|report| *report);
                (report.unwrap_or_default(), Some(stopped.error))
            }
        };
        let name = varied.label(value);
        let settings = &plan.options.settings;
        say(&said(
            &name,
            (&report, error.is_some()),
            structure,
            settings,
        ));
        runs.push(Called {
            name: name.clone(),
            rows: record.end(),
        });
        done.push(Done {
            value,
            name,
            mechanism,
            report,
            error,
        });
        let last = done.last().and_then(|one| one.error.as_ref());
        if last.is_some_and(CommandError::ends_all) {
            break;
        }
    }
    let kept = record.close(|_| draw(arguments, (&plan, &shown), &done, &runs))?;
    if arguments.json {
        let runs: Vec<Value> = done.iter().map(|one| one.json(varied)).collect();
        print(&format!("{:#}\n", Value::from(runs)))?;
    }
    failed(done).map_or(Ok(()), |error| Err(error.with(kept)))
}

/// What is said at the end of a run.
fn said(
    name: &str,
    (report, has_failed): (&Report, bool),
    structure: &Structure,
    settings: &Settings<f64>,
) -> String {
    match has_failed && report.steps == 0 {
        true => format!("{name}\nthe run could not begin\n"),
        false => format!("{name}\n{}", summary::summary(report, structure, settings)),
    }
}

/// Draws the picture of all runs, on which the first one that has begun moves. Returns the
/// names of the files.
fn draw(
    arguments: &Simulate,
    (plan, shown): (&Plan, &Shown),
    done: &[Done],
    runs: &[Called],
) -> Result<Vec<String>, CommandError> {
    let begun = |(_, run): &(&Done, &Called)| !run.rows.is_empty();
    let (done, runs): (Vec<&Done>, Vec<Called>) = done
        .iter()
        .zip(runs)
        .filter(begun)
        .map(|(done, run)| (done, run.clone()))
        .unzip();
    let Some(first) = done.first() else {
        return Ok(Vec::new());
    };
    let structure = first.mechanism.structure();
    let line = |one: &&Done| {
        [
            one.name.clone(),
            summary::line(&one.report, structure, &plan.options.settings),
        ]
    };
    let errors: Vec<String> = done.iter().filter_map(|one| one.complaint()).collect();
    let picture = Picture {
        arguments,
        mechanism: first.mechanism.as_ref(),
        plan,
        shown,
        report: Some(&first.report),
        summary: done.iter().map(line).collect(),
        error: (!errors.is_empty()).then(|| errors.join("\n")),
        live: None,
        module: None,
    };
    picture.draw(&runs)
}

/// What is said if runs have failed.
fn failed(mut done: Vec<Done>) -> Option<CommandError> {
    let last = done.last_mut().and_then(|last| last.error.take());
    match last {
        Some(error) if error.ends_all() => return Some(error),
        error => done.last_mut().map(|last| last.error = error),
    };
    let complaints: Vec<String> = done.iter().filter_map(Done::complaint).collect();
    (!complaints.is_empty()).then(|| {
        CommandError::run(format!(
            "{} of {} runs ended early\n{}",
            complaints.len(),
            done.len(),
            complaints.join("\n")
        ))
    })
}

impl Done {
    /// Why it ended early, and which it is.
    fn complaint(&self) -> Option<String> {
        let error = self.error.as_ref()?;
        Some(format!("{}: {error}", self.name))
    }

    /// Its summary as a JSON object.
    fn json(&self, varied: &Varied) -> Value {
        let structure = self.mechanism.structure();
        let mut object = summary::json(&self.report, structure, self.error.as_ref());
        let [option, name] = varied.key();
        object[option] = json!({ name: self.value });
        object
    }
}
