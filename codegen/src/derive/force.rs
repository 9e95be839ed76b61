//! Forces: `C q̇` from `T`, `h` from `Π`, `Q` from applied forces and dissipation,
//! and their sum `p₁` [PH 2.2, 2.4].

use super::gradient::{Sweep, coordinates, gradient, rates, velocities};
use crate::expr::{ExprId, Graph, Number};
use crate::model::Force;

/// `d/dt ∂T/∂q̇ − M q̈ − ∂T/∂q`: for `T = ½ q̇ᵀM q̇` the product `C q̇` with the
/// Christoffel `C`; the linear and constant parts of `T` bring their gyroscopic,
/// centrifugal and explicit time terms.
pub(super) fn coriolis_product(
    graph: &mut Graph,
    kinetic: ExprId,
    momenta: &[ExprId],
    by: Sweep,
) -> Vec<ExprId> {
    let n = momenta.len();
    let carried = rates(graph, momenta, n);
    let slope = by.gradient(graph, kinetic, coordinates(n));
    carried
        .into_iter()
        .zip(slope)
        .map(|(rate, slope)| graph.sub(rate, slope))
        .collect()
}

/// `h = ∂Π/∂q`.
pub(super) fn potential_force(
    graph: &mut Graph,
    potential: ExprId,
    n: usize,
    by: Sweep,
) -> Vec<ExprId> {
    by.gradient(graph, potential, coordinates(n))
}

/// `Q_i = Σ F·∂x/∂q_i − ∂R/∂q̇_i`: virtual work of the applied forces, less
/// Rayleigh dissipation. A moment works on an angular velocity ω by virtual power,
/// `Q_i = Σ M·∂ω/∂q̇_i`. Of `n` coordinates those behind the first `freedoms` are integrals
/// of states, which dissipate nothing.
pub(super) fn applied(
    graph: &mut Graph,
    forces: &[Force],
    dissipation: ExprId,
    (n, freedoms): (usize, usize),
) -> Vec<ExprId> {
    let loss = gradient(graph, dissipation, velocities(freedoms));
    let mut terms: Vec<Vec<ExprId>> = loss.into_iter().map(|x| vec![graph.neg(x)]).collect();
    terms.resize(n, Vec::new());
    for force in forces {
        for (&component, &place) in force.force.iter().zip(&force.on) {
            let slope = match force.on_velocity {
                true => gradient(graph, place, velocities(n)),
                false => gradient(graph, place, coordinates(n)),
            };
            for (terms, slope) in terms.iter_mut().zip(slope) {
                terms.push(graph.mul(component, slope));
            }
        }
    }
    terms.into_iter().map(|terms| graph.sum(terms)).collect()
}

/// `p₁ = Q − C q̇ − h`.
pub(super) fn total(
    graph: &mut Graph,
    applied: &[ExprId],
    coriolis: &[ExprId],
    gravity: &[ExprId],
) -> Vec<ExprId> {
    let mut force = |((&q, &c), &h): ((&ExprId, &ExprId), &ExprId)| {
        let minus = Number::MINUS_ONE;
        graph.weighted_sum(Number::ZERO, &[(q, Number::ONE), (c, minus), (h, minus)])
    };
    applied
        .iter()
        .zip(coriolis)
        .zip(gravity)
        .map(&mut force)
        .collect()
}
