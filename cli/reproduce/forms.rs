//! The forms of the equations of motion, compared.

use super::experiment::{Outcome, STEP, named, plan};
use super::report::Findings;
use crate::error::CommandError;
use crate::number::largest;
use crate::run::run;
use crate::table::{Align, headed};
use bricard_runtime::Form;

/// The two forms that pass singular positions, compared; and when the others end.
///
/// # Errors
///
/// A failure of a form that passes singular positions.
pub fn comparison(outcomes: &[Outcome], findings: &mut Findings) -> Result<String, CommandError> {
    let mut rows = Vec::new();
    for outcome in outcomes {
        let experiment = outcome.experiment;
        let published = difference(outcome, true)?;
        let difference = difference(outcome, false)?;
        let what = format!("{}: `full` and `reduced` differ", experiment.title);
        let most = largest([difference, published]);
        let verdict = findings.judge(&what, most, experiment.angle_bound);
        rows.push(vec![
            experiment.title.to_string(),
            format!("{published:.1e}"),
            format!("{difference:.1e}"),
            format!("{:.0e}", experiment.angle_bound),
            ending(outcome, Form::Multipliers, findings),
            ending(outcome, Form::Partitioning, findings),
            verdict,
        ]);
    }
    let heading = [
        "forms",
        "full − reduced, as published",
        "on the sheets",
        "bound",
        "multipliers",
        "partitioning",
        "",
    ];
    let (left, right) = (Align::Left, Align::Right);
    let table = headed(
        &heading,
        &rows,
        &[left, right, right, right, left, left, left],
    );
    Ok(format!(
        "{table}full − reduced: the largest difference of a coordinate during the run, which \
         should not exceed the error of either. The paper finds practically none.\n\n"
    ))
}

/// The largest difference of a coordinate between the two forms, as published or on the
/// sheets of the constraint set.
fn difference(outcome: &Outcome, published: bool) -> Result<f64, CommandError> {
    let rows = |form| {
        let mut plan = plan(outcome.experiment, STEP, form);
        plan.options.settings.published = published;
        let mut rows = Vec::new();
        run(outcome.mechanism.as_ref(), &plan, &mut rows)
            .map_err(|stopped| named(outcome.experiment, stopped))?;
        Ok::<_, CommandError>(rows)
    };
    let (full, reduced) = (rows(Form::Full)?, rows(Form::Reduced)?);
    if full.len() != reduced.len() {
        return Ok(f64::INFINITY);
    }
    let n = outcome.n_coordinates();
    Ok(largest(full.iter().zip(&reduced).flat_map(|(a, b)| {
        let (a, b) = (a.iter().skip(1).take(n), b.iter().skip(1).take(n));
        a.zip(b).map(|(x, y)| x - y)
    })))
}

/// When a form that can't pass singular positions ends. That it does not end is
/// a broken promise: it has then passed one without a word.
fn ending(outcome: &Outcome, form: Form, findings: &mut Findings) -> String {
    let plan = plan(outcome.experiment, STEP, form);
    match run(outcome.mechanism.as_ref(), &plan, &mut Vec::new()) {
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
