//! `bricard workprecision`: run time against error, for methods and forms.
//!
//! In:  a mechanism's name and what to change.
//! Out: a table, and on demand a work-precision diagram and the numbers as CSV.

mod measure;
mod reference;

use crate::arguments::{FormName, MethodName, WorkPrecision};
use crate::changes;
use crate::error::{CommandError, TooMany};
use crate::files::{apart, is_of, refuse};
use crate::formula::Choice;
use crate::law::{described_with, find_with};
use crate::mistakes::{both, once, word};
use crate::output::{print, probe, say};
use crate::plot::{Cloud, Mark, work_diagram};
use crate::raster;
use crate::table::{Align, headed};
use clap::ValueEnum;
use measure::{Series, series};
use reference::exact;
use std::path::{Path, PathBuf};

/// Kinds of files, and what to write instead of others.
type Kinds = (&'static [&'static str], &'static str);

/// What the diagram can be written to.
const DRAWINGS: Kinds = (
    &["svg", "png", "pdf"],
    "the diagram is SVG, PNG or PDF; write `--out work.svg`, `--out work.png` or `--out work.pdf`",
);
/// What the numbers behind it can be written to.
const TABLES: Kinds = (
    &["csv", "txt", "dat"],
    "the numbers are written as CSV; write `--csv work.csv`",
);

/// Measures all methods and forms.
///
/// # Errors
///
/// [`CommandError`]: an unknown name, a start that can't be assembled, a file that
/// can't be written. A method that fails is no error: the table says so.
pub fn workprecision(arguments: &WorkPrecision) -> Result<(), CommandError> {
    if arguments.until <= 0.0 {
        return Err(CommandError::OutOfRange {
            option: "--until",
            value: arguments.until,
            wanted: "a positive number".to_string(),
        });
    }
    let written = [("--out", &arguments.out), ("--csv", &arguments.csv)];
    apart(&arguments.name, &written)?;
    both(
        once("--methods", &arguments.methods),
        once("--forms", &arguments.forms),
    )?;
    both(
        kind(&arguments.out, &DRAWINGS),
        kind(&arguments.csv, &TABLES),
    )?;
    let (set, start) = both(
        single(&arguments.set, |set| format!("--set {}", set.name())),
        single(&arguments.start, |start| format!("--start {}", start.name)),
    )?;
    let (mut mechanism, numbers) = find_with(&arguments.name, &set)?;
    let structure = mechanism.structure();
    let changes = changes::find(structure, &arguments.name, &numbers, &start)?;
    changes::apply(&changes, mechanism.as_mut());
    for path in [&arguments.out, &arguments.csv].into_iter().flatten() {
        probe(path)?;
    }
    say("computing the motion to compare with, in double-double arithmetic");
    let described = described_with(&arguments.name, &set)?;
    let exact = exact(&described, &changes, arguments.until)?;
    let forms = forms(&arguments.forms, structure.constraints.is_empty());
    let mut all = Vec::new();
    for method in methods(&arguments.methods) {
        for form in &forms {
            say(&format!("running {}", title(method, *form)));
            let pair = (method, *form);
            all.push(series(mechanism.as_ref(), pair, arguments.until, &exact));
        }
    }
    print(&table(&all))?;
    print(&failures(&all))?;
    print(&format!(
        "error: the largest of a coordinate at t = {} s (m or rad), against a motion that is \
         good to {:.0e}\ntime: the median of several runs, integration alone\n",
        arguments.until, exact.error
    ))?;
    if let Some(path) = &arguments.csv {
        write_csv(path, &all)?;
    }
    match &arguments.out {
        Some(path) => draw(path, arguments, &all),
        None => Ok(()),
    }
}

fn methods(chosen: &[MethodName]) -> Vec<MethodName> {
    match chosen {
        [] => MethodName::value_variants().to_vec(),
        chosen => chosen.to_vec(),
    }
}

/// The forms that differ: without constraints there is one.
fn forms(chosen: &[FormName], free: bool) -> Vec<FormName> {
    match chosen {
        _ if free => vec![FormName::Reduced],
        [] => FormName::value_variants().to_vec(),
        chosen => chosen.to_vec(),
    }
}

fn title(method: MethodName, form: FormName) -> String {
    format!("{}, {}", word(&method), word(&form))
}

fn table(all: &[Series]) -> String {
    let mut rows = Vec::new();
    for series in all {
        let title = title(series.method, series.form);
        for (i, point) in series.points.iter().enumerate() {
            rows.push(vec![
                if i == 0 { title.clone() } else { String::new() },
                point.setting.clone(),
                format!("{:.1e}", point.error),
                format!("{:.3}", 1e3 * point.wall.as_secs_f64()),
                point.steps.to_string(),
                point.evaluations.to_string(),
            ]);
        }
    }
    let heading = [
        "method, form",
        "setting",
        "error",
        "ms",
        "steps",
        "accelerations",
    ];
    let right = Align::Right;
    let align = [Align::Left, Align::Left, right, right, right, right];
    headed(&heading, &rows, &align)
}

/// Where methods gave up, and why, a line for each.
fn failures(all: &[Series]) -> String {
    let line = |series: &Series| {
        let reason = series.failed.as_ref()?;
        Some(format!(
            "{} ends: {reason}\n",
            title(series.method, series.form)
        ))
    };
    all.iter().filter_map(line).collect()
}

fn write_csv(path: &Path, all: &[Series]) -> Result<(), CommandError> {
    let failed = |error: csv::Error| CommandError::write(path, error.into());
    let mut writer = csv::Writer::from_path(path).map_err(failed)?;
    writer
        .write_record([
            "method",
            "form",
            "setting",
            "error",
            "seconds",
            "steps",
            "accelerations",
        ])
        .map_err(failed)?;
    for series in all {
        for point in &series.points {
            writer
                .write_record([
                    word(&series.method),
                    word(&series.form),
                    point.setting.clone(),
                    point.error.to_string(),
                    point.wall.as_secs_f64().to_string(),
                    point.steps.to_string(),
                    point.evaluations.to_string(),
                ])
                .map_err(failed)?;
        }
    }
    writer
        .flush()
        .map_err(|error| CommandError::write(path, error))
}

fn draw(path: &Path, arguments: &WorkPrecision, all: &[Series]) -> Result<(), CommandError> {
    let methods = methods(&arguments.methods);
    let clouds: Vec<Cloud> = all
        .iter()
        .filter(|series| !series.points.is_empty())
        .map(|series| Cloud {
            name: title(series.method, series.form),
            colour: methods
                .iter()
                .position(|m| *m == series.method)
                .unwrap_or(0),
            mark: match series.form {
                FormName::Reduced => Mark::Disc,
                FormName::Full => Mark::Ring,
                FormName::Multipliers => Mark::Cross,
                FormName::Partitioning => Mark::Triangle,
            },
            points: series
                .points
                .iter()
                .map(|point| (point.error, point.wall.as_secs_f64()))
                .collect(),
        })
        .collect();
    let title = format!("{}: {} s of motion", arguments.name, arguments.until);
    raster::write(path, &work_diagram(path, &title, &clouds)?, false)
}

/// The values of an option that takes one for each name.
fn single<T: Clone>(
    choices: &[Choice<T>],
    called: impl Fn(&T) -> String,
) -> Result<Vec<T>, CommandError> {
    let value = |choice: &Choice<T>| match choice.all().count() {
        1 => Ok(choice.first.clone()),
        count => Err(CommandError::Runs(TooMany {
            what: "workprecision measures one mechanism from one start",
            varied: called(&choice.first),
            count,
            instead: "give it one value",
        })),
    };
    choices.iter().map(value).collect()
}

/// Refuses a kind of file that can't be written.
fn kind(path: &Option<PathBuf>, (kinds, instead): &Kinds) -> Result<(), CommandError> {
    match path {
        Some(path) if !is_of(path, kinds) => refuse(path, instead),
        _ => Ok(()),
    }
}
