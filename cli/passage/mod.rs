//! `bricard passage`: what the passage through a singular configuration costs in
//! accuracy, by stage placement.
//!
//! In:  names of mechanisms that pass one.
//! Out: median and worst error over many placements, for several steps.
//!
//! Stages are placed by their abscissae; the distance is that of the fastest coordinate.

use crate::arguments::{MethodName, Passage};
use crate::error::CommandError;
use crate::mechanism::{find, precise};
use crate::mistakes::once;
use crate::number::largest;
use crate::output::{print, say};
use crate::run::{Plan, run};
use crate::table::{Align, headed};
use bricard_driver::{AnyMechanism, Around, Path, Precise};
use bricard_runtime::{Audit, Method, Options, StepControl};
use bricard_testkit::placement::{Placements, SPAN, STEPS, distances, stages};

/// Tolerance of the run that finds the singular position.
const SEARCH: f64 = 1e-11;
/// How long that run looks for one (s).
const LOOK: f64 = 20.0;

/// Places stages of each method beside the singular configuration of each mechanism.
///
/// # Errors
///
/// [`CommandError`]: a mechanism that passes no singular position, a run that CommandError::run,
/// a placement that is worse than it may be.
pub fn passage(arguments: &Passage) -> Result<(), CommandError> {
    once("--methods", &arguments.methods)?;
    let mut rows = Vec::new();
    let mut broken = Vec::new();
    for name in &arguments.names {
        let mechanism = find(name)?;
        let about = first_passage(name, mechanism.as_ref())?;
        let mut precise = precise(name)?;
        for &method in &arguments.methods {
            say(&format!(
                "{name}: placing stages of {}",
                Method::from(method)
            ));
            for steps in STEPS {
                let found = placed(precise.as_mut(), mechanism.as_ref(), (method, steps), about)?;
                if !found.is_even() {
                    broken.push(format!("{name}, {}, {steps} steps", Method::from(method)));
                }
                rows.push(row(&found, name, method, steps));
            }
        }
    }
    let heading = [
        "mechanism",
        "method",
        "h (s)",
        "placements",
        "median",
        "worst",
        "ratio",
        "",
    ];
    let right = Align::Right;
    let left = Align::Left;
    print(&headed(
        &heading,
        &rows,
        &[left, left, right, right, right, right, right, left],
    ))?;
    print("errors: the largest of a coordinate after 0.4 s (m or rad)\n")?;
    if broken.is_empty() {
        Ok(())
    } else {
        Err(CommandError::OutOfBounds(broken))
    }
}

/// The errors of all placements of one method and step.
fn placed(
    precise: &mut dyn Precise,
    mechanism: &dyn AnyMechanism,
    (method, steps): (MethodName, u32),
    about: f64,
) -> Result<Placements<()>, CommandError> {
    let step = SPAN / f64::from(steps);
    let around = Around {
        about,
        places: places(method.into(), step),
        span: SPAN,
    };
    let exact = precise.path(&around).map_err(CommandError::run)?;
    let mut errors = Vec::new();
    for row in &exact.rows {
        let Some(end) = row_at(&exact, row[0] + SPAN) else {
            continue;
        };
        let mut options = Options::new(end[0], method.into(), StepControl::Fixed { step });
        options.audit = Audit::NONE;
        let run = mechanism
            .timed_run(Some(row), &options)
            .map_err(CommandError::run)?;
        let differences = run.end.iter().zip(&end[1..]).map(|(a, b)| a - b);
        errors.push((largest(differences), ()));
    }
    let too_near = || CommandError::run("it begins too near the singular position".to_string());
    Placements::of(errors).ok_or_else(too_near)
}

/// What is printed of them.
fn row(placements: &Placements<()>, name: &str, method: MethodName, steps: u32) -> Vec<String> {
    let (median, (worst, ())) = (placements.median(), placements.worst());
    vec![
        name.to_string(),
        Method::from(method).to_string(),
        (SPAN / f64::from(steps)).to_string(),
        placements.count().to_string(),
        format!("{median:.1e}"),
        format!("{worst:.1e}"),
        format!("{:.1}", worst / median),
        if placements.is_even() { "ok" } else { "uneven" }.to_string(),
    ]
}

/// The row at a time, if there is one.
fn row_at(path: &Path, time: f64) -> Option<&Vec<f64>> {
    let near = |row: &&Vec<f64>| (row[0] - time).abs() < 1e-9;
    let after = path.rows.partition_point(|row| row[0] < time - 1e-9);
    path.rows.get(after).filter(near)
}

/// Where stages lie, and how long before that runs begin (s).
fn places(method: Method, step: f64) -> Vec<(f64, f64)> {
    let of = |stage| distances().into_iter().map(move |d| (d, stage * step));
    stages(method.abscissae())
        .into_iter()
        .flat_map(of)
        .collect()
}

/// When a mechanism first passes a singular position (s).
fn first_passage(name: &str, mechanism: &dyn AnyMechanism) -> Result<f64, CommandError> {
    say(&format!("{name}: looking for a singular position"));
    let plan = Plan {
        // In stiff mechanisms it takes minutes.
        watched: true,
        ..Plan::new(Options::dop853(LOOK, SEARCH), Some(LOOK), Vec::new())
    };
    let report = run(mechanism, &plan, &mut Vec::new()).map_err(|stopped| stopped.error)?;
    match report.passages.first() {
        Some(passage) => Ok(passage.t),
        None => Err(CommandError::run(format!(
            "`{name}` passes no singular position in {LOOK} s"
        ))),
    }
}
