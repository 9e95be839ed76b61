//! diffsol's explicit method of order 5 on equations of motion.

use diffsol::{NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason};
use std::cell::RefCell;
use std::error::Error;

/// Steps after which a run is given up.
const MOST_STEPS: u32 = 1_000_000;

/// The coordinates at the end of a run from rest; `acceleration` takes coordinates and
/// velocities and writes accelerations.
///
/// # Errors
///
/// A solver that stops.
pub fn tsit45(
    start: &[f64],
    until: f64,
    tolerance: f64,
    acceleration: impl FnMut(&[f64], &[f64], &mut [f64]),
) -> Result<Vec<f64>, Box<dyn Error>> {
    let n = start.len();
    let acceleration = RefCell::new(acceleration);
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(tolerance)
        .atol([tolerance])
        .rhs(move |x, _p, _t, y| {
            let (q, v) = x.split_at(n);
            let (first, second) = y.split_at_mut(n);
            first.copy_from_slice(v);
            acceleration.borrow_mut()(q, v, second);
        })
        .init(
            move |_p, _t, y| {
                for (i, coordinate) in start.iter().enumerate() {
                    y[i] = *coordinate;
                    y[n + i] = 0.0;
                }
            },
            2 * n,
        )
        .build()?;
    let mut solver = problem.tsit45()?;
    solver.set_stop_time(until)?;
    for _ in 0..MOST_STEPS {
        if let OdeSolverStopReason::TstopReached = solver.step()? {
            let y = solver.state().y;
            return Ok((0..n).map(|i| y[i]).collect());
        }
    }
    Err("too many steps".into())
}
