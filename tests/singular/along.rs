//! The motion of the almost parallelogram along its curve of configurations.
//!
//! In:  its parameters, times.
//! Out: coordinates and velocities at the times.
//!
//! With a gap the curve has no singular point, however near the gap comes to zero: the
//! product a₁ × a₂ of the two rows of the constraint Jacobian is its tangent everywhere
//! and never changes its direction. One degree of freedom and a conserved energy E leave
//! an equation of first order, q̇ = τ(q) √(2 (E − Π(q))), where τ is the tangent of unit
//! kinetic energy. It holds as long as the motion doesn't turn round. Extrapolated
//! midpoint rule with steps as the curvature asks for.
//!
//! Source: Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I (1993),
//! section II.9.

use crate::descriptions::four_bar::FourBar;
use crate::exact::Exact;
use crate::trial::Set;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Interface, Mechanism, Position, State, assemble};

type Vector = SVector<f64, 3>;

/// Levels of the extrapolation: order 12.
const LEVELS: usize = 6;
/// Error of a step.
const TOLERANCE: f64 = 1e-12;
/// Steps shorter than this (s) are not made.
const SHORTEST: f64 = 1e-10;
/// Steps longer than this (s) are not made.
const LONGEST: f64 = 0.02;

/// The curve, its energy, which way it is followed.
struct Curve {
    mechanism: FourBar<f64>,
    energy: f64,
    way: f64,
}

impl Curve {
    fn position(&self, q: &Vector) -> Position<f64, 3, 2> {
        let mut position = Position::default();
        let state = State::new(0.0, *q, Vector::zeros());
        self.mechanism.position(&state, &mut position);
        position
    }

    /// The tangent of unit kinetic energy.
    fn tangent(&self, q: &Vector) -> Vector {
        let position = self.position(q);
        let row = |i: usize| position.jacobian.row(i).transpose();
        let normal = row(0).cross(&row(1));
        normal / (normal.dot(&(position.mass * normal))).sqrt()
    }

    fn velocity(&self, q: &Vector) -> Vector {
        let rest = self.mechanism.energy(&State::new(0.0, *q, Vector::zeros()));
        let kinetic = self.energy - rest.potential;
        self.tangent(q) * (self.way * (2.0 * kinetic).sqrt())
    }

    /// Back onto the curve, the shortest way.
    fn back(&self, q: &mut Vector) {
        for _ in 0..2 {
            let position = self.position(q);
            let gram = position.jacobian * position.jacobian.transpose();
            if let Some(inverse) = gram.try_inverse() {
                *q -= position.jacobian.transpose() * (inverse * position.residual);
            }
        }
    }

    /// The midpoint rule in so many substeps.
    fn midpoint(&self, q: &Vector, step: f64, substeps: usize) -> Vector {
        let h = step / substeps as f64;
        let (mut before, mut here) = (*q, q + self.velocity(q) * h);
        for _ in 1..substeps {
            (before, here) = (here, before + self.velocity(&here) * (2.0 * h));
        }
        (before + here + self.velocity(&here) * h) / 2.0
    }

    /// One step by extrapolation, and its error; with no more levels than it needs.
    fn step(&self, q: &Vector, step: f64) -> (Vector, f64) {
        let mut table = [Vector::zeros(); LEVELS];
        for level in 0..LEVELS {
            table[level] = self.midpoint(q, step, 2 * (level + 1));
            for k in (0..level).rev() {
                let ratio = (level + 1) as f64 / (k + 1) as f64;
                let change = (table[k + 1] - table[k]) / (ratio * ratio - 1.0);
                table[k] = table[k + 1] + change;
            }
            let error = (table[0] - table[1]).norm();
            if level > 0 && error <= TOLERANCE {
                return (table[0], error);
            }
        }
        (table[0], (table[0] - table[1]).norm())
    }
}

/// The motion at the times, which ascend from zero.
pub fn follow(set: &Set, times: &[f64]) -> Exact {
    let mut mechanism = FourBar::<f64>::default();
    for (name, value) in set {
        let parameters = mechanism.structure().parameters;
        let place = parameters.iter().position(|p| p.name == *name);
        mechanism.set_parameter(place.expect("it is a parameter"), *value);
    }
    let start = assemble(&mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    let energy = mechanism.energy(&start);
    let mut curve = Curve {
        mechanism,
        energy: energy.kinetic + energy.potential,
        way: 1.0,
    };
    curve.way = curve.tangent(&start.q).dot(&start.v).signum();
    let (mut t, mut q, mut length) = (0.0, start.q, 1e-3);
    let mut exact = Exact::default();
    for &time in times {
        while t < time {
            let step = f64::min(length, time - t);
            let (next, error) = curve.step(&q, step);
            if error <= TOLERANCE || step <= SHORTEST {
                (t, q) = (if step < length { time } else { t + step }, next);
                curve.back(&mut q);
            }
            // A step that was cut at a row says nothing of how long the next may be.
            length = match error <= TOLERANCE {
                true => length.max(2.0 * step).min(LONGEST),
                false => (step * (TOLERANCE / error).powf(1.0 / 11.0) * 0.8).max(0.1 * step),
            };
            length = length.max(SHORTEST);
        }
        exact
            .numbers
            .extend(q.iter().chain(curve.velocity(&q).iter()));
    }
    exact
}
