//! The observed order of convergence.

use super::experiment::{EXPERIMENTS, Experiment, Rows, plan};
use super::report::Findings;
use crate::error::CommandError;
use crate::mechanism::find;
use crate::table::{Align, headed};
use bricard_runtime::Form;

/// Steps, each half of the one before (s).
const STEPS: [f64; 4] = [0.02, 0.01, 0.005, 0.0025];
/// The order of the method.
const ORDER: f64 = 4.0;
/// How far the observed order may be from it.
const SPREAD: f64 = 0.2;

/// Errors of q₁ at the end for several steps, and the order they show.
///
/// # Errors
///
/// A run that failed.
pub fn table(findings: &mut Findings) -> Result<String, CommandError> {
    let mut rows = Vec::new();
    for experiment in &EXPERIMENTS {
        let errors: Vec<f64> = STEPS
            .iter()
            .map(|step| error(experiment, *step))
            .collect::<Result<_, _>>()?;
        let order = observed(&errors);
        let what = format!(
            "{}: distance of the observed order from {ORDER}",
            experiment.title
        );
        let verdict = findings.judge(&what, (order - ORDER).abs(), SPREAD);
        let mut row = vec![experiment.title.to_string()];
        row.extend(errors.iter().map(|error| format!("{error:.2e}")));
        row.extend([format!("{order:.2}"), verdict]);
        rows.push(row);
    }
    let heading = [
        "error of q1 at the end",
        "h = 0.02",
        "0.01",
        "0.005",
        "0.0025",
        "order",
        "",
    ];
    let right = Align::Right;
    let align = [Align::Left, right, right, right, right, right, Align::Left];
    Ok(headed(&heading, &rows, &align) + "\n")
}

fn error(experiment: &'static Experiment, step: f64) -> Result<f64, CommandError> {
    let mut rows = Rows::default();
    let plan = plan(experiment, step, Form::Reduced);
    find(experiment.mechanism)?
        .run(&plan, &mut rows)
        .map_err(|stopped| stopped.error)?;
    let end = rows
        .0
        .last()
        .and_then(|row| row.get(1))
        .copied()
        .unwrap_or(f64::NAN);
    Ok((end - experiment.exact.q1).abs())
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
