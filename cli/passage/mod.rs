//! `bricard passage`: what the passage through a singular configuration costs in
//! accuracy, by stage placement.
//!
//! In:  names of mechanisms that pass one.
//! Out: median and worst error over many placements, for several steps.
//!
//! A run begins on the exact motion so that a stage of its first step lies at a
//! distance `d` from the singular position, `d = ±{1, 3.3}·10⁻ᵏ`, `k = 1…16`, for each
//! stage of the method, and goes on for 0.4 s. The distance is that of the fastest
//! coordinate.

use crate::arguments::{MethodName, Passage};
use crate::error::CommandError;
use crate::mechanism::{find, precise};
use crate::number::largest;
use crate::output::{print, say};
use crate::run::{Plan, RowSink, run};
use crate::table::{Align, headed};
use bricard_driver::{AnyMechanism, Around, Path, Precise};
use bricard_runtime::{Audit, Method, Options, StepControl};

/// How long a motion is followed (s).
const SPAN: f64 = 0.4;
/// Steps in that time.
const STEPS: [u32; 4] = [20, 40, 80, 160];
/// How much worse than the median the worst placement may be.
const SPREAD: f64 = 2.0;
/// A median that is round-off, and what no placement may exceed then.
const FLOOR: f64 = 1e-12;
const PLACED: f64 = 1e-11;
/// Tolerance of the run that finds the singular position.
const SEARCH: f64 = 1e-11;
/// How long that run looks for one (s).
const LOOK: f64 = 20.0;

/// Places stages of each method beside the singular configuration of each mechanism.
///
/// # Errors
///
/// [`CommandError`]: a mechanism that passes no singular position, a run that failed,
/// a placement that is worse than it may be.
pub fn passage(arguments: &Passage) -> Result<(), CommandError> {
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
                let found =
                    Placements::of(precise.as_mut(), mechanism.as_ref(), (method, steps), about)?;
                if !found.is_even() {
                    broken.push(format!("{name}, {}, {steps} steps", Method::from(method)));
                }
                rows.push(found.row(name, method, steps));
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

/// Errors of all placements of one method and step.
struct Placements {
    /// Sorted.
    errors: Vec<f64>,
}

impl Placements {
    fn of(
        precise: &mut dyn Precise,
        mechanism: &dyn AnyMechanism,
        (method, steps): (MethodName, u32),
        about: f64,
    ) -> Result<Self, CommandError> {
        let step = SPAN / f64::from(steps);
        let around = Around {
            about,
            places: places(&stages(method.into()), step),
            span: SPAN,
        };
        let exact = precise.path(&around).map_err(failed)?;
        let mut errors = Vec::new();
        for row in &exact.rows {
            let Some(end) = row_at(&exact, row[0] + SPAN) else {
                continue;
            };
            let mut options = Options::new(end[0], method.into(), StepControl::Fixed { step });
            options.audit = Audit::NONE;
            let found = mechanism
                .timed_run(Some(row), &options)
                .map_err(failed)?
                .end;
            let differences = found.iter().zip(&end[1..]).map(|(a, b)| a - b);
            errors.push(largest(differences));
        }
        errors.sort_by(f64::total_cmp);
        match errors.is_empty() {
            true => Err(failed(
                "it begins too near the singular position".to_string(),
            )),
            false => Ok(Self { errors }),
        }
    }

    fn median(&self) -> f64 {
        self.errors[self.errors.len() / 2]
    }

    fn worst(&self) -> f64 {
        self.errors[self.errors.len() - 1]
    }

    fn is_even(&self) -> bool {
        let floor = if self.median() <= FLOOR { PLACED } else { 0.0 };
        self.worst() <= floor.max(SPREAD * self.median())
    }

    fn row(&self, name: &str, method: MethodName, steps: u32) -> Vec<String> {
        vec![
            name.to_string(),
            Method::from(method).to_string(),
            (SPAN / f64::from(steps)).to_string(),
            self.errors.len().to_string(),
            format!("{:.1e}", self.median()),
            format!("{:.1e}", self.worst()),
            format!("{:.1}", self.worst() / self.median()),
            if self.is_even() { "ok" } else { "uneven" }.to_string(),
        ]
    }
}

/// The row at a time, if there is one.
fn row_at(path: &Path, time: f64) -> Option<&Vec<f64>> {
    let near = |row: &&Vec<f64>| (row[0] - time).abs() < 1e-9;
    let after = path.rows.partition_point(|row| row[0] < time - 1e-9);
    path.rows.get(after).filter(near)
}

/// Where stages lie, and how long before that runs begin (s).
fn places(stages: &[f64], step: f64) -> Vec<(f64, f64)> {
    let mut places = Vec::new();
    for stage in stages {
        for exponent in 1..=16 {
            for size in [1.0, -1.0, 3.3, -3.3] {
                let distance = size * 10.0_f64.powi(-exponent);
                places.push((distance, stage * step));
            }
        }
    }
    places
}

/// The abscissae of the stages of a method, and the start of the step.
fn stages(method: Method) -> Vec<f64> {
    let mut stages: Vec<f64> = std::iter::once(0.0).chain(method.abscissae()).collect();
    stages.dedup();
    stages
}

/// When a mechanism first passes a singular position (s).
fn first_passage(name: &str, mechanism: &dyn AnyMechanism) -> Result<f64, CommandError> {
    let plan = Plan::new(Options::dop853(LOOK, SEARCH), Some(LOOK), Vec::new());
    let report = run(mechanism, &plan, &mut Nowhere).map_err(|stopped| stopped.error)?;
    match report.passages.first() {
        Some(passage) => Ok(passage.t),
        None => Err(failed(format!(
            "`{name}` passes no singular position in {LOOK} s"
        ))),
    }
}

/// Takes rows and forgets them.
struct Nowhere;

impl RowSink for Nowhere {
    fn row(&mut self, _values: &[f64]) -> Result<(), CommandError> {
        Ok(())
    }
}

fn failed(reason: String) -> CommandError {
    CommandError::Run {
        reason,
        kept: String::new(),
    }
}
