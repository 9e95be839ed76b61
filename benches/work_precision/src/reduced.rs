//! What the loops cost: a description beside the same motion in one coordinate, whose
//! equation is written by hand and has no constraint.

use crate::ours;
use crate::problem::{Failed, Problem};
use crate::work::timed;
use beside::Reduced;
use bricard_runtime::{Method, StepControl};

/// Error of q₁ at the end (rad).
const WANTED: f64 = 1e-8;

/// Prints the shortest times of both by DOP853.
///
/// # Errors
///
/// A run that fails.
pub fn table() -> Result<(), Failed> {
    println!("## Beside the motion in one coordinate, by hand, to {WANTED:.0e} rad with DOP853\n");
    println!("| problem | loops (ms) | one coordinate (ms) | ratio |\n|---|--:|--:|--:|");
    for problem in Problem::ALL {
        let (start, exact) = (problem.nominal(), problem.exact(problem.nominal()));
        let reduced = Reduced(problem.reduction());
        let loops = shortest(exact, |control| {
            Ok(ours::run(problem, start, Method::Dop853, control)?[0])
        })?;
        let one = shortest(exact, |control| {
            reduced.after(problem.end(), start, (Method::Dop853, control))
        })?;
        let title = problem.title();
        let [of_loops, of_one] = [loops, one].map(|seconds| 1e3 * seconds);
        println!(
            "| {title} | {of_loops:.3} | {of_one:.3} | {:.1} |",
            loops / one
        );
    }
    println!();
    Ok(())
}

/// The shortest of the times (s) of all tolerances at which the end is right.
fn shortest(
    exact: f64,
    run: impl Fn(StepControl<f64>) -> Result<f64, Failed>,
) -> Result<f64, Failed> {
    let mut least: Option<f64> = None;
    for half in 10..=24 {
        let tolerance = 10.0_f64.powf(-0.5 * f64::from(half));
        let control = StepControl::Adaptive {
            relative: tolerance,
            absolute: tolerance,
        };
        let (angle, seconds) = timed(|| run(control))?;
        if (angle - exact).abs() <= WANTED && least.is_none_or(|least| seconds < least) {
            least = Some(seconds);
        }
    }
    Ok(least.ok_or("no tolerance is enough")?)
}
