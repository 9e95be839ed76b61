//! The forms of the equations of motion, compared.

use super::experiment::{Outcome, Rows, STEP, largest, plan};
use super::report::Findings;
use crate::error::CommandError;
use crate::table::{Align, headed};
use bricard_runtime::Form;

/// Bound of the difference between the two forms that pass singular positions:
/// round-off, grown over the run.
const DIFFERENCE_BOUND: f64 = 1e-9;

/// The difference between `full` and `reduced`, and when the other forms end.
///
/// # Errors
///
/// A failure of `full`, which passes singular positions.
pub fn comparison(outcomes: &[Outcome], findings: &mut Findings) -> Result<String, CommandError> {
    let mut rows = Vec::new();
    for outcome in outcomes {
        let title = outcome.experiment.title;
        let difference = difference(outcome)?;
        let what = format!("{title}: `full` and `reduced` differ");
        let verdict = findings.judge(&what, difference, DIFFERENCE_BOUND);
        rows.push(vec![
            title.to_string(),
            format!("{difference:.1e}"),
            ending(outcome, Form::Multipliers, findings),
            ending(outcome, Form::Partitioning, findings),
            verdict,
        ]);
    }
    let heading = ["forms", "full − reduced", "multipliers", "partitioning", ""];
    let align = [
        Align::Left,
        Align::Right,
        Align::Left,
        Align::Left,
        Align::Left,
    ];
    let table = headed(&heading, &rows, &align);
    Ok(format!(
        "{table}full − reduced: the largest difference of a coordinate during the run; the paper \
         finds practically none.\n\n"
    ))
}

/// The largest difference of a coordinate between the two forms.
fn difference(outcome: &Outcome) -> Result<f64, CommandError> {
    let plan = plan(outcome.experiment, STEP, Form::Full);
    let mut rows = Rows::default();
    outcome
        .mechanism
        .run(&plan, &mut rows)
        .map_err(|stopped| stopped.error)?;
    if rows.0.len() != outcome.rows.len() {
        return Ok(f64::INFINITY);
    }
    let n = outcome.n_coordinates();
    let pairs = outcome.rows.iter().zip(&rows.0);
    Ok(largest(pairs.flat_map(|(a, b)| {
        let (a, b) = (a.iter().skip(1).take(n), b.iter().skip(1).take(n));
        a.zip(b).map(|(x, y)| x - y)
    })))
}

/// When a form that can't pass singular positions ends. That it does not end is
/// a broken promise: it has then passed one without a word.
fn ending(outcome: &Outcome, form: Form, findings: &mut Findings) -> String {
    let plan = plan(outcome.experiment, STEP, form);
    match outcome.mechanism.run(&plan, &mut Rows::default()) {
        Err(stopped) => match stopped.time {
            Some(t) => format!("ends at t = {t:.4} s"),
            None => "does not begin".to_string(),
        },
        Ok(_) => {
            let title = outcome.experiment.title;
            findings.broken.push(format!(
                "{title}: `{form}` passed a singular position silently"
            ));
            "passes silently".to_string()
        }
    }
}
