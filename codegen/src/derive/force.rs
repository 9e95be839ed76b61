//! Forces: `C q̇` from `T`, `h` from `Π`, `Q` from applied forces and dissipation,
//! and their sum `p₁` [PH 2.2, 2.4].

use super::gradient::{Sweep, coordinates, gradient, rates, velocities};
use crate::expr::{ExprId, Number};
use crate::model::{Force, Graph};

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
    by: Sweep,
) -> Vec<ExprId> {
    let loss = by.gradient(graph, dissipation, velocities(freedoms));
    let mut terms: Vec<Vec<ExprId>> = loss.into_iter().map(|x| vec![graph.neg(x)]).collect();
    terms.resize(n, Vec::new());
    let work = match by {
        Sweep::Forward => work_one_by_one(graph, forces, n),
        Sweep::Back => Vec::from(work_at_once(graph, forces, n)),
    };
    for slopes in work {
        for (terms, slope) in terms.iter_mut().zip(slopes) {
            terms.push(slope);
        }
    }
    terms.into_iter().map(|terms| graph.sum(terms)).collect()
}

/// What each component of each force comes to on each coordinate.
fn work_one_by_one(graph: &mut Graph, forces: &[Force], n: usize) -> Vec<Vec<ExprId>> {
    let mut work = Vec::new();
    for force in forces {
        for (&component, &place) in force.force.iter().zip(&force.on) {
            let slopes = match force.on_velocity {
                true => gradient(graph, place, velocities(n)),
                false => gradient(graph, place, coordinates(n)),
            };
            let slopes = slopes.into_iter();
            work.push(slopes.map(|slope| graph.mul(component, slope)).collect());
        }
    }
    work
}

/// What all forces on places come to on each coordinate, and all that work on velocities.
fn work_at_once(graph: &mut Graph, forces: &[Force], n: usize) -> [Vec<ExprId>; 2] {
    [false, true].map(|on_velocity| {
        let chosen = forces.iter().filter(|f| f.on_velocity == on_velocity);
        let rated = chosen.flat_map(|f| f.on.iter().copied().zip(f.force.iter().copied()));
        let rated: Vec<(ExprId, ExprId)> = rated.collect();
        let found = graph.pulled_back(&rated);
        let zero = graph.integer(0);
        let entry = |symbol| found.get(&symbol).copied().unwrap_or(zero);
        match on_velocity {
            true => velocities(n).map(entry).collect(),
            false => coordinates(n).map(entry).collect(),
        }
    })
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
