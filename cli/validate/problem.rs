//! A benchmark problem: what is run, what it is compared with, how it went.
//!
//! In:  [`Problem`]s.
//! Out: [`Outcome`]s.

use crate::column::{Column, header};
use crate::error::CommandError;
use crate::mechanism::find;
use crate::number::largest;
use crate::run::{Plan, Report, RowSink, run};
use bricard_driver::{AnyMechanism, Given};
use bricard_runtime::{Method, Options, StepControl, Structure};

/// A benchmark problem.
#[derive(Debug)]
pub struct Problem {
    /// What it is called in tables.
    pub title: &'static str,
    /// The mechanism, by name.
    pub mechanism: &'static str,
    /// Coordinates held at the start instead of what the description says.
    pub held: &'static [(&'static str, f64)],
    /// Its end (s).
    pub until: f64,
    /// The method.
    pub method: Method,
    /// Relative and absolute tolerance of a step.
    pub tolerance: (f64, f64),
    /// Whether the energy is kept.
    pub keep_energy: bool,
    /// Columns and what they should be at the end.
    pub reference: &'static [(&'static str, f64)],
    /// How errors are measured.
    pub measure: Measure,
    /// Bound of the largest of them.
    pub bound: f64,
    /// Bound of the error of the energy or power balance (J), if there is one.
    pub balance_bound: Option<f64>,
    /// An output whose growth is the work that inputs do (J), where it is known in
    /// closed form.
    pub work: Option<&'static str>,
    /// Bound of the error of a constraint equation, in its unit.
    pub constraint_bound: f64,
    /// How many times as many steps an explicit method of order 5 must need, if the
    /// problem is stiff.
    pub stiffness: Option<f64>,
    /// What others have published for it.
    pub published: &'static str,
    /// Whether it is left out of a quick run.
    pub long: bool,
}

/// How errors are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// In the unit of the column.
    Absolute,
    /// Over the reference value.
    Relative,
}

/// What a problem came to.
#[derive(Debug)]
pub struct Outcome {
    /// The problem.
    pub problem: &'static Problem,
    /// The numbers, or why there are none.
    pub result: Result<Figures, String>,
}

/// The numbers of a run.
#[derive(Debug)]
pub struct Figures {
    /// The largest error at the end.
    pub error: f64,
    /// The error of the energy or power balance (J).
    pub balance: f64,
    /// The largest error of a constraint equation.
    pub constraint: f64,
    /// Steps of an explicit method over those of this run, for a stiff problem.
    pub stiffness: Option<f64>,
    /// Steps, time and passages.
    pub report: Report,
}

impl Problem {
    fn plan(&self, method: Method, tolerance: (f64, f64), columns: Vec<Column>) -> Plan {
        let (relative, absolute) = tolerance;
        let step_control = StepControl::Adaptive { relative, absolute };
        let mut options = Options::new(self.until, method, step_control);
        options.keep_energy = self.keep_energy;
        Plan::new(options, None, columns)
    }

    /// The mechanism, held at the start as the problem wants it.
    fn prepared(&self) -> Result<Box<dyn AnyMechanism>, CommandError> {
        let mut mechanism = find(self.mechanism)?;
        let coordinates = mechanism.structure().coordinates;
        for (name, value) in self.held {
            if let Some(coordinate) = coordinates.iter().position(|c| c.name == *name) {
                mechanism.begin(Given {
                    coordinate,
                    velocity: false,
                    held: true,
                    value: *value,
                });
            }
        }
        Ok(mechanism)
    }
}

/// Runs a problem. A run that fails is an outcome, not an error.
///
/// # Errors
///
/// [`CommandError::UnknownName`].
pub fn solve(problem: &'static Problem) -> Result<Outcome, CommandError> {
    perform(problem, problem.tolerance)
}

/// Runs a problem with another relative and absolute tolerance.
///
/// # Errors
///
/// As [`solve`].
pub fn solve_at(problem: &'static Problem, tolerance: f64) -> Result<Outcome, CommandError> {
    perform(problem, (tolerance, tolerance))
}

fn perform(problem: &'static Problem, tolerance: (f64, f64)) -> Result<Outcome, CommandError> {
    let mechanism = problem.prepared()?;
    let structure = mechanism.structure();
    let mut columns = vec![Column::Energy];
    columns.extend((0..structure.outputs.len()).map(Column::Output));
    let mut ends = Ends::default();
    let plan = problem.plan(problem.method, tolerance, columns.clone());
    let result = match run(mechanism.as_ref(), &plan, &mut ends) {
        Ok(report) => figures(problem, structure, &columns, &ends, report)
            .and_then(|figures| compared(problem, mechanism.as_ref(), figures)),
        Err(stopped) => Err(stopped.error.to_string()),
    };
    Ok(Outcome { problem, result })
}

fn figures(
    problem: &Problem,
    structure: &'static Structure,
    columns: &[Column],
    ends: &Ends,
    report: Report,
) -> Result<Figures, String> {
    let header = header(structure, columns);
    let at = |row: &[f64], name: &str| {
        let place = header.iter().position(|column| column == name);
        let value = place.and_then(|place| row.get(place)).copied();
        value.ok_or_else(|| format!("the mechanism has no column `{name}`"))
    };
    let mut error = 0.0_f64;
    for (name, exact) in problem.reference {
        let away = (at(&ends.last, name)? - exact).abs();
        let away = match problem.measure {
            Measure::Absolute => away,
            Measure::Relative => away / exact.abs(),
        };
        error = largest([error, away]);
    }
    let balance = match problem.work {
        None => report.energy_error,
        Some(work) => {
            let grown =
                |name: &str| Ok::<f64, String>(at(&ends.last, name)? - at(&ends.first, name)?);
            (grown("energy")? - grown(work)?).abs()
        }
    };
    Ok(Figures {
        error,
        balance,
        constraint: report.constraint_error,
        stiffness: None,
        report,
    })
}

/// Counts the steps of an explicit method beside, if the problem is stiff.
fn compared(
    problem: &Problem,
    mechanism: &dyn AnyMechanism,
    figures: Figures,
) -> Result<Figures, String> {
    if problem.stiffness.is_none() {
        return Ok(figures);
    }
    let plan = problem.plan(Method::Dp5, problem.tolerance, Vec::new());
    let explicit =
        run(mechanism, &plan, &mut Ends::default()).map_err(|stopped| stopped.error.to_string())?;
    let ratio = explicit.steps as f64 / figures.report.steps.max(1) as f64;
    Ok(Figures {
        stiffness: Some(ratio),
        ..figures
    })
}

impl Outcome {
    /// A sentence for each bound that is not kept.
    pub fn broken(&self) -> Vec<String> {
        let Problem { title, .. } = self.problem;
        let figures = match &self.result {
            Ok(figures) => figures,
            Err(reason) => return vec![format!("{title}: {reason}")],
        };
        let mut broken = Vec::new();
        let mut judge = |what: &str, value: f64, bound: f64| {
            if value.is_nan() || value > bound {
                broken.push(format!("{title}: {what} {value:.2e}, bound {bound:.0e}"));
            }
        };
        judge("error", figures.error, self.problem.bound);
        judge(
            "error of a constraint equation",
            figures.constraint,
            self.problem.constraint_bound,
        );
        if let Some(bound) = self.problem.balance_bound {
            judge("error of the energy balance (J)", figures.balance, bound);
        }
        if let (Some(wanted), Some(found)) = (self.problem.stiffness, figures.stiffness)
            && found < wanted
        {
            broken.push(format!(
                "{title}: dp5 takes only {found:.0} times as many steps, bound {wanted:.0}"
            ));
        }
        broken
    }
}

/// Keeps the first and the last row of a run.
#[derive(Debug, Default)]
pub struct Ends {
    /// The first row.
    pub first: Vec<f64>,
    /// The last row.
    pub last: Vec<f64>,
}

impl RowSink for Ends {
    fn row(&mut self, values: &[f64]) -> Result<(), CommandError> {
        if self.first.is_empty() {
            self.first = values.to_vec();
        }
        self.last.clear();
        self.last.extend_from_slice(values);
        Ok(())
    }
}
