//! Work against accuracy for Andrews' mechanism.
//!
//! Out: for errors from 1e−4 to 1e−11, the loosest tolerance that reaches it, with its
//! steps and time, beside the published figures of an implicit code.

use super::list::PROBLEMS;
use super::problem::{Outcome, solve_at};
use crate::error::CommandError;

/// A run that reaches an accuracy.
#[derive(Debug)]
pub struct Reached {
    /// The accuracy asked for: the largest relative error of a coordinate.
    pub wanted: f64,
    /// The tolerance of the run.
    pub tolerance: f64,
    /// What it came to.
    pub outcome: Outcome,
}

/// Accuracies in decimal digits.
const DIGITS: std::ops::RangeInclusive<i32> = 4..=11;
/// Tolerances are tried at so many to a decade.
const PER_DECADE: i32 = 2;

/// The loosest tolerance for each accuracy; in a quick run for every second one.
///
/// # Errors
///
/// [`CommandError::UnknownName`].
pub fn work(quick: bool) -> Result<Vec<Reached>, CommandError> {
    let Some(problem) = PROBLEMS.iter().find(|p| p.mechanism == "andrews") else {
        return Ok(Vec::new());
    };
    let mut reached = Vec::new();
    let mut step = 3 * PER_DECADE;
    for digits in DIGITS.filter(|digits| !quick || digits % 2 == 0) {
        let wanted = 10.0_f64.powi(-digits);
        while step <= 13 * PER_DECADE {
            let tolerance = 10.0_f64.powf(-f64::from(step) / f64::from(PER_DECADE));
            let outcome = solve_at(problem, tolerance)?;
            if is_within(&outcome, wanted) {
                reached.push(Reached {
                    wanted,
                    tolerance,
                    outcome,
                });
                break;
            }
            step += 1;
        }
    }
    Ok(reached)
}

fn is_within(outcome: &Outcome, wanted: f64) -> bool {
    let Outcome { result, .. } = outcome;
    result.as_ref().is_ok_and(|figures| figures.error <= wanted)
}

/// The steps, time and digits that MEBDFI needs at tolerances of 1e−4, 1e−6, 1e−8 and
/// 1e−10. Source: output of the authors' driver, 2000; machine unknown.
pub const PUBLISHED: &str = "MEBDFI (2000): 108 steps, 0.16 s for 0.4 digits; 240, 0.34 s for \
     4.0; 422, 0.58 s for 5.6; 645, 0.88 s for 5.8";
