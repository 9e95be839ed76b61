//! Forty loops in a row: problem A02 of the IFToMM library, ten seconds of it.
//!
//! In:  a method and a tolerance.
//! Out: the change of energy and the processor time.
//!
//! All forty parallelograms fold into one line at once, several times. There is no
//! exact motion to compare with, so the energy is what tells.

use crate::problem::Failed;
use crate::work::timed;
use bricard_runtime::Interface;
use bricard_runtime::{Mechanism, Method, Settings, State, StepControl, Stepper, assemble};
use instructions::mechanism::row_40::n_four_bar::NFourBar;

/// Length of the run (s).
const END: f64 = 10.0;
/// Coordinates.
const N: usize = 81;
/// Constraint equations.
const R: usize = 80;

/// Prints the table.
///
/// # Errors
///
/// A run that fails.
pub fn table() -> Result<(), Failed> {
    println!("## 40 loops in a row, 10 s\n");
    println!(
        "| method | setting | change of energy (J) | processor time (ms) |\n|---|---|--:|--:|"
    );
    let mechanism = NFourBar::default();
    let start = assemble(&mechanism, &mechanism.start(), 0.0).map_err(|e| e.to_string())?;
    for method in [Method::Dp5, Method::Dop853] {
        for tolerance in [1e-6, 1e-7, 1e-8, 1e-9, 1e-10] {
            let (change, seconds) = timed(|| run(&mechanism, start, method, tolerance))?;
            println!(
                "| bricard {method} | tolerance {tolerance:.0e} | {:.1e} | {:.1} |",
                change.abs(),
                1e3 * seconds
            );
        }
    }
    println!();
    Ok(())
}

fn run(
    mechanism: &NFourBar<f64>,
    start: State<f64, N>,
    method: Method,
    tolerance: f64,
) -> Result<f64, Failed> {
    let step_control = StepControl::Adaptive {
        relative: tolerance,
        absolute: tolerance,
    };
    let mut state = start;
    let mut stepper = Box::new(Stepper::<f64, N, R>::new(
        method,
        step_control,
        Settings::default(),
    )?);
    stepper.step(mechanism, &mut state, END)?;
    Ok(mechanism.energy(&state).balance - mechanism.energy(&start).balance)
}
