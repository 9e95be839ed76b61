//! Exact motions of mechanisms with one degree of freedom.
//!
//! `M_eff(q) q̈ + ½ M_eff'(q) q̇² = drive − damping q̇ − V'(q)`, integrated by RK4
//! with steps so small that only round-off remains. Against the 20-digit end
//! values of the paper's examples it agrees to 1e-12 (see the tests of runs).

use super::{ANGLE, structure};
use bricard_runtime::{Energy, Mechanism, State, Structure, Terms};

/// `M_eff = constant + ripple cos 2q`, `V = weight sin q`.
#[derive(Clone, Copy, Debug)]
pub struct Reduction {
    /// Constant part of the effective mass (kg·m²).
    pub constant: f64,
    /// Part of the effective mass that varies with `cos 2q` (kg·m²).
    pub ripple: f64,
    /// Amplitude of the potential energy (J).
    pub weight: f64,
    /// Constant moment (N·m).
    pub drive: f64,
    /// Moment lost per speed (N·m·s).
    pub damping: f64,
}

impl Reduction {
    /// `q̈`.
    pub fn acceleration(&self, angle: f64, rate: f64) -> f64 {
        let (s, c) = angle.sin_cos();
        let mass = self.constant + self.ripple * (c * c - s * s);
        let slope = -4.0 * self.ripple * s * c;
        let moment = self.drive - self.damping * rate - self.weight * c;
        (moment - 0.5 * slope * rate * rate) / mass
    }

    /// `|q̇|` at an angle after rest at another, from the energy.
    pub fn rate_after_rest(&self, rest: f64, angle: f64) -> f64 {
        let mass = self.constant + self.ripple * (2.0 * angle).cos();
        (2.0 * self.weight * (rest.sin() - angle.sin()) / mass).sqrt()
    }

    /// Angle and rate a time `span` later (earlier if negative).
    pub fn after(&self, span: f64, (angle, rate): (f64, f64)) -> (f64, f64) {
        let steps = (span.abs() / 1e-3).ceil().max(1.0);
        let h = span / steps;
        let (mut q, mut v) = (angle, rate);
        for _ in 0..steps as usize {
            (q, v) = self.step(h, q, v);
        }
        (q, v)
    }

    /// A step of order 6: Butcher's method by Richardson extrapolation of RK4
    /// would cost as much; two RK4 steps against one remove the leading error.
    fn step(&self, h: f64, q: f64, v: f64) -> (f64, f64) {
        let (q1, v1) = self.rk4(h, q, v);
        let (qh, vh) = self.rk4(h / 2.0, q, v);
        let (q2, v2) = self.rk4(h / 2.0, qh, vh);
        (q2 + (q2 - q1) / 15.0, v2 + (v2 - v1) / 15.0)
    }

    fn rk4(&self, h: f64, q: f64, v: f64) -> (f64, f64) {
        let a1 = self.acceleration(q, v);
        let v2 = v + 0.5 * h * a1;
        let a2 = self.acceleration(q + 0.5 * h * v, v2);
        let v3 = v + 0.5 * h * a2;
        let a3 = self.acceleration(q + 0.5 * h * v2, v3);
        let v4 = v + h * a3;
        let a4 = self.acceleration(q + h * v3, v4);
        (
            q + h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4),
            v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4),
        )
    }
}

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
        let mass = self.0.constant + self.0.ripple * (2.0 * state.q[0]).cos();
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
