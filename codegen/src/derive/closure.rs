//! Constraints and their first two derivatives in time [PH 2.8].
//!
//! Holonomic rows: `g(q, t) = 0`, `φ = ġ = A q̇ + b`. Velocity rows: `φ = A q̇ + b`
//! as written. From there both are alike: `φ̇ = A q̈ + γ`, `p₂ = −γ`.

use super::equations::Matrix;
use super::gradient::{coordinates, gradient, rates, velocities};
use crate::expr::ExprId;
use crate::model::{Constraint, Graph};

pub(super) struct Closure {
    pub residual: Vec<ExprId>,
    /// `φ = A q̇ + b`.
    pub speed: Vec<ExprId>,
    /// `∂φ/∂q`.
    pub turn: Matrix,
    pub jacobian: Matrix,
    pub drift: Vec<ExprId>,
    /// `p₂ = −(Ȧ q̇ + ḃ)`.
    pub bias: Vec<ExprId>,
}

pub(super) fn closure(graph: &mut Graph, constraints: &[Constraint], n: usize) -> Closure {
    let residuals: Vec<ExprId> = constraints.iter().map(|c| c.residual).collect();
    let carried = rates(graph, &residuals, n);
    let holonomic = |i: usize| constraints[i].holonomic;
    let zero = graph.integer(0);
    let speed: Vec<ExprId> = (0..residuals.len())
        .map(|i| {
            if holonomic(i) {
                carried[i]
            } else {
                residuals[i]
            }
        })
        .collect();
    let jacobian: Matrix = speed
        .iter()
        .map(|&phi| gradient(graph, phi, velocities(n)))
        .collect();
    let turn: Matrix = speed
        .iter()
        .map(|&phi| gradient(graph, phi, coordinates(n)))
        .collect();
    let drift = speed.iter().map(|&phi| graph.at_rest(phi)).collect();
    let turning = rates(graph, &speed, n);
    let bias = turning.into_iter().map(|rate| graph.neg(rate)).collect();
    let residual = (0..residuals.len())
        .map(|i| if holonomic(i) { residuals[i] } else { zero })
        .collect();
    Closure {
        residual,
        speed,
        turn,
        jacobian,
        drift,
        bias,
    }
}
