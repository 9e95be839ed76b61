//! Branch rows: the constraints differentiated once more.
//!
//! `φ̈ = A q⃛ + K q̈ − κ` with `K = Ȧ + ∂γ/∂q̇` and `κ = −(∂γ/∂t + ∂γ/∂q q̇)`. Where a
//! combination of rows of `A` vanishes, its branch row carries the information
//! on. For constraints `g(q) = 0` this gives `K = 3 Ȧ`.

use super::closure::Closure;
use super::{Matrix, gradient, rates, velocities};
use crate::expr::{ExprId, Graph};

/// `K`, `R × N`, and `κ`, `R`.
pub(super) fn branch_rows(graph: &mut Graph, closure: &Closure, n: usize) -> (Matrix, Vec<ExprId>) {
    let mut slope = Matrix::new();
    for (row, &gamma) in closure.jacobian.iter().zip(&closure.gamma) {
        let turning = rates(graph, row, n);
        let by_velocity = gradient(graph, gamma, velocities(n));
        let entries = turning.into_iter().zip(by_velocity);
        slope.push(entries.map(|(a, g)| graph.add(a, g)).collect());
    }
    let drift = rates(graph, &closure.gamma, n);
    let bias = drift.into_iter().map(|x| graph.neg(x)).collect();
    (slope, bias)
}
