//! Parallelograms in a row, ten seconds: problem A02 of the IFToMM library.
//!
//! All of them fold into one line at once, ten times.

use crate::Failed;
use crate::clock::timed;
use bricard_runtime::{Method, Settings, State, StepControl, Stepper, Whole, assemble};
use instructions::mechanism::{row_10, row_40};
use std::f64::consts::FRAC_PI_2;

/// Length of the run (s).
const END: f64 = 10.0;
/// The angle of the first crank at the end (rad), from the x axis, by the exact reduction to
/// it, from extrapolation in arithmetic of 30 digits.
const EXACT: [(u32, f64); 2] = [(10, -30.050_933_495_986_976), (40, -30.026_637_417_190_84)];
/// A tolerance near that of the figures that simulators have, and a tight one.
pub const TOLERANCES: [f64; 2] = [1e-6, 1e-9];

/// A run of ours.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    pub loops: u32,
    pub tolerance: f64,
    /// Error of the first angle (rad).
    pub error: f64,
    /// Change of the energy (J).
    pub change: f64,
    pub seconds: f64,
}

/// Runs of both rows.
///
/// # Errors
///
/// A run that fails.
pub fn runs() -> Result<Vec<Run>, Failed> {
    let mut runs = Vec::new();
    for (loops, exact) in EXACT {
        for tolerance in TOLERANCES {
            let (values, seconds) = timed(|| match loops {
                10 => run::<21, 20>(&row_10::n_four_bar::NFourBar::default(), tolerance),
                _ => run::<81, 80>(&row_40::n_four_bar::NFourBar::default(), tolerance),
            })?;
            let [angle, change] = values;
            runs.push(Run {
                loops,
                tolerance,
                error: (angle - exact).abs(),
                change: change.abs(),
                seconds,
            });
        }
    }
    Ok(runs)
}

/// The first angle at the end, and by how much the energy has changed.
fn run<const N: usize, const R: usize>(
    row: &dyn Whole<f64, N, R>,
    tolerance: f64,
) -> Result<[f64; 2], Failed> {
    let control = StepControl::Adaptive {
        relative: tolerance,
        absolute: tolerance,
    };
    let start: State<f64, N> = assemble(row, &row.start(), 0.0).map_err(|e| e.to_string())?;
    let mut state = start;
    let mut stepper = Box::new(Stepper::<f64, N, R>::new(
        Method::Dop853,
        control,
        Settings::default(),
    )?);
    stepper.step(row, &mut state, END)?;
    let change = row.energy(&state).balance - row.energy(&start).balance;
    Ok([FRAC_PI_2 - state.q[0], change])
}
