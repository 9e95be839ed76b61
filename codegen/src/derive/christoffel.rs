//! The Coriolis matrix by Christoffel symbols [PH 2.3]:
//! `c_ij = ½ Σ_k (∂m_ij/∂q_k + ∂m_ik/∂q_j − ∂m_jk/∂q_i) q̇_k`.
//!
//! With it `Ṁ − 2C` is skew-symmetric. The simulation does not need it: it uses
//! the product `C q̇`, which `force` derives from `T` at a fraction of the cost.

use super::equations::Matrix;
use super::gradient::{coordinates, gradient, velocities};
use crate::expr::{ExprId, Number};
use crate::model::{Graph, Symbol};

/// `C(q, q̇)`, `N × N`, from the mass matrix.
pub fn coriolis_matrix(graph: &mut Graph, mass: &Matrix) -> Matrix {
    let n = mass.len();
    let slopes: Vec<Vec<Vec<ExprId>>> = mass
        .iter()
        .map(|row| {
            row.iter()
                .map(|&m| gradient(graph, m, coordinates(n)))
                .collect()
        })
        .collect();
    let velocity: Vec<ExprId> = velocities(n)
        .map(|symbol: Symbol| graph.symbol(symbol))
        .collect();
    let mut entry = |i: usize, j: usize| {
        let mut terms = Vec::new();
        for k in 0..n {
            let half = Number::Exact(1, 2);
            let symbol = graph.weighted_sum(
                Number::ZERO,
                &[
                    (slopes[i][j][k], half),
                    (slopes[i][k][j], half),
                    (slopes[j][k][i], -half),
                ],
            );
            terms.push(graph.mul(symbol, velocity[k]));
        }
        graph.sum(terms)
    };
    (0..n)
        .map(|i| (0..n).map(|j| entry(i, j)).collect())
        .collect()
}
