//! Energies and the power supplied from outside.
//!
//! Multiplying Lagrange's equations by `q̇` gives
//! `d/dt (T₂ − T₀ + Π) = (Q + r)·q̇ − ∂T/∂t + ∂Π/∂t`,
//! since `q̇·∂T/∂q̇ = 2T₂ + T₁`. So `balance = q̇·∂T/∂q̇ − T + Π`.

use super::equations::Energies;
use super::gradient::velocities;
use crate::expr::{ExprId, Number};
use crate::model::{Graph, Symbol};

pub(super) fn energies(
    graph: &mut Graph,
    kinetic: ExprId,
    potential: ExprId,
    applied: &[ExprId],
    momenta: &[ExprId],
) -> Energies {
    let speeds: Vec<ExprId> = velocities(applied.len()).map(|v| graph.symbol(v)).collect();
    let work_rate = dot(graph, applied, &speeds);
    let action = dot(graph, momenta, &speeds);
    let one = Number::ONE;
    let balance = graph.weighted_sum(
        Number::ZERO,
        &[
            (action, one),
            (kinetic, Number::MINUS_ONE),
            (potential, one),
        ],
    );
    let kinetic_rate = graph.differentiate(kinetic, Symbol::Time);
    let potential_rate = graph.differentiate(potential, Symbol::Time);
    let power = graph.weighted_sum(
        Number::ZERO,
        &[
            (work_rate, one),
            (potential_rate, one),
            (kinetic_rate, Number::MINUS_ONE),
        ],
    );
    Energies {
        kinetic,
        potential,
        balance,
        power,
    }
}

fn dot(graph: &mut Graph, a: &[ExprId], b: &[ExprId]) -> ExprId {
    let products: Vec<ExprId> = a.iter().zip(b).map(|(&a, &b)| graph.mul(a, b)).collect();
    graph.sum(products)
}
