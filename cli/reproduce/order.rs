//! The observed order of convergence.
//!
//! Over eight seconds the error of the period, which the energy error of RK4
//! brings about, outgrows all others at these steps: it is of fifth order, and RK4
//! on the exact reduction to one degree of freedom shows it just as well. So the
//! order is judged over the first second, in which each mechanism passes one or
//! two singular positions; both are shown.

use super::experiment::{EXPERIMENTS, Experiment, named, plan};
use super::report::Findings;
use crate::error::CommandError;
use crate::mechanism::find;
use crate::number::largest;
use crate::run::{Plan, run};
use crate::table::{Align, headed};
use bricard_runtime::Form;

/// Steps, each half of the one before (s).
const STEPS: [f64; 4] = [0.02, 0.01, 0.005, 0.0025];
/// The step of the run that others are compared with in the first second (s): its
/// error is 10⁴ times smaller than that of the shortest of them.
const FINE: f64 = 0.0025 / 16.0;
/// The order of the method.
const ORDER: f64 = 4.0;
/// How far the observed order may be from it.
const SPREAD: f64 = 0.2;

/// Errors of q₁ for several steps, and the order they show.
///
/// # Errors
///
/// A run that failed.
pub fn table(findings: &mut Findings) -> Result<String, CommandError> {
    let mut rows = Vec::new();
    for experiment in &EXPERIMENTS {
        let run = |step: &f64| at_end(experiment, *step);
        let end: Vec<f64> = STEPS.iter().map(run).collect::<Result<_, _>>()?;
        rows.push(row(
            &format!("{}, at the end", experiment.title),
            &end,
            String::new(),
        ));
    }
    for experiment in [&EXPERIMENTS[0], &EXPERIMENTS[1], &EXPERIMENTS[3]] {
        let fine = first_second(experiment, FINE)?;
        let run = |step: &f64| {
            let coarse = first_second(experiment, *step)?;
            Ok(largest(fine.iter().zip(&coarse).map(|(a, b)| a - b)))
        };
        let errors: Vec<f64> = STEPS.iter().map(run).collect::<Result<_, CommandError>>()?;
        let title = experiment
            .title
            .rsplit_once(',')
            .map_or(experiment.title, |(name, _)| name);
        let title = format!("{title}, in the first second");
        let away = (observed(&errors) - ORDER).abs();
        let what = format!("{title}: distance of the observed order from {ORDER}");
        rows.push(row(&title, &errors, findings.judge(&what, away, SPREAD)));
    }
    let heading = [
        "error of q1",
        "h = 0.02",
        "0.01",
        "0.005",
        "0.0025",
        "order",
        "",
    ];
    let right = Align::Right;
    let align = [Align::Left, right, right, right, right, right, Align::Left];
    let table = headed(&heading, &rows, &align);
    Ok(format!(
        "{table}At the end the energy error of RK4 decides, which is of fifth order; in the first \
         second it is too small to show.\n\n"
    ))
}

fn row(title: &str, errors: &[f64], verdict: String) -> Vec<String> {
    let mut row = vec![title.to_string()];
    row.extend(errors.iter().map(|error| format!("{error:.2e}")));
    row.extend([format!("{:.2}", observed(errors)), verdict]);
    row
}

/// The error of q₁ at the end of an experiment.
fn at_end(experiment: &'static Experiment, step: f64) -> Result<f64, CommandError> {
    let angles = angles(experiment, &plan(experiment, step, Form::Reduced))?;
    let end = angles.last().copied().unwrap_or(f64::NAN);
    Ok((end - experiment.exact.q1).abs())
}

/// q₁ in the first second, where all steps meet.
fn first_second(experiment: &'static Experiment, step: f64) -> Result<Vec<f64>, CommandError> {
    let mut plan = plan(experiment, step, Form::Reduced);
    plan.options.until = 1.0;
    plan.every = Some(STEPS[0]);
    angles(experiment, &plan)
}

/// q₁ in each row of a run.
fn angles(experiment: &Experiment, plan: &Plan) -> Result<Vec<f64>, CommandError> {
    let mut rows = Vec::new();
    run(find(experiment.mechanism)?.as_ref(), plan, &mut rows)
        .map_err(|stopped| named(experiment, stopped))?;
    Ok(rows.iter().filter_map(|row| row.get(1).copied()).collect())
}

/// The slope of the straight line through the logarithms, by least squares.
fn observed(errors: &[f64]) -> f64 {
    let points: Vec<(f64, f64)> = STEPS
        .iter()
        .zip(errors)
        .map(|(h, error)| (h.log2(), error.log2()))
        .collect();
    let n = points.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let above: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let below: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    above / below
}
