//! Generalized momenta `∂T/∂q̇` and the mass matrix `M = ∂²T/∂q̇²` [PH 2.1].

use super::equations::Matrix;
use super::gradient::{Sweep, gradient, velocities};
use crate::expr::{ExprId, Graph};

/// `∂T/∂q̇_i`, `N`.
pub(super) fn momenta(graph: &mut Graph, kinetic: ExprId, n: usize, by: Sweep) -> Vec<ExprId> {
    by.gradient(graph, kinetic, velocities(n))
}

/// `M_ij = ∂²T/∂q̇_i ∂q̇_j`, `N × N`; the lower triangle is derived, the upper is
/// the same expressions.
pub(super) fn mass_matrix(graph: &mut Graph, momenta: &[ExprId]) -> Matrix {
    let n = momenta.len();
    let mut mass: Matrix = vec![Vec::with_capacity(n); n];
    for (i, momentum) in momenta.iter().enumerate() {
        let row = gradient(graph, *momentum, velocities(n).take(i + 1));
        for (j, entry) in row.into_iter().enumerate() {
            mass[i].push(entry);
            if j < i {
                mass[j].push(entry);
            }
        }
    }
    mass
}
