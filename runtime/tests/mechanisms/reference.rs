//! Exact motions as mechanisms and as passages.
//!
//! In:  a [`Reduction`].
//! Out: [`Reduced`], [`Passage`].

use super::{ANGLE, structure};
use bricard_runtime::{Energy, Mechanism, State, Structure, Terms};
use bricard_testkit::Reduction;

/// The motion as a mechanism of its own, without constraints: what a run with
/// singular positions is compared with.
#[derive(Clone, Copy, Debug)]
pub struct Reduced(pub Reduction);

static REDUCED: Structure = structure(&[ANGLE], &[]);

impl Mechanism<f64, 1, 0> for Reduced {
    fn structure(&self) -> &'static Structure {
        &REDUCED
    }

    fn terms(&self, state: &State<f64, 1>, out: &mut Terms<f64, 1, 0>) {
        let mass = self.0.mass(state.q[0]);
        out.mass[(0, 0)] = mass;
        out.force[0] = mass * self.0.acceleration(state.q[0], state.v[0]);
    }

    fn energy(&self, _state: &State<f64, 1>) -> Energy<f64> {
        Energy::default()
    }
}

/// A passage through a singular position: the exact motion on a grid around it.
#[derive(Clone, Debug)]
pub struct Passage {
    reduction: Reduction,
    /// States at `i · SPACING`, from the singular position at time zero on.
    grid: Vec<(f64, f64)>,
    at: (f64, f64),
}

const SPACING: f64 = 1e-3;

impl Passage {
    /// The exact motion from the singular position on, for `span` seconds.
    pub fn new(reduction: Reduction, at: (f64, f64), span: f64) -> Self {
        let mut grid = vec![at];
        for _ in 0..(span / SPACING).ceil() as usize + 1 {
            grid.push(reduction.after(SPACING, grid[grid.len() - 1]));
        }
        Self {
            reduction,
            grid,
            at,
        }
    }

    /// Angle and rate at a time relative to the passage.
    pub fn at(&self, t: f64) -> (f64, f64) {
        if t <= 0.0 {
            return self.reduction.after(t, self.at);
        }
        let i = ((t / SPACING) as usize).min(self.grid.len() - 1);
        self.reduction.after(t - i as f64 * SPACING, self.grid[i])
    }
}
