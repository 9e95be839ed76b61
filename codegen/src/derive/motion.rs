//! What comes of energies and forces: `M` and `p₁` with its parts.

use super::equations::Matrix;
use super::gradient::Sweep;
use super::reduced::Reduced;
use super::swell::within_bounds;
use super::{composite, force, inertia, mass};
use crate::expr::{ExprId, Symbol};
use crate::model::Mechanism;

/// What comes of the energies and forces alone.
pub(super) struct Motion {
    pub kinetic: ExprId,
    pub potential: ExprId,
    pub momenta: Vec<ExprId>,
    pub mass: Matrix,
    pub inertia: Option<Vec<ExprId>>,
    pub coriolis: Vec<ExprId>,
    pub gravity: Vec<ExprId>,
    pub applied: Vec<ExprId>,
    pub force: Vec<ExprId>,
}

/// `M` and `p₁` with its parts, or nothing as soon as they are too long.
pub(super) fn motion(mechanism: &mut Mechanism, by: Sweep) -> Option<Motion> {
    let (n, freedoms) = (mechanism.coordinates.len(), mechanism.freedoms());
    let graph = &mut mechanism.graph;
    let kinetic = graph.sum(mechanism.kinetic.iter().map(|summand| summand.value));
    let potential = graph.sum(mechanism.potential.iter().map(|summand| summand.value));
    let dissipation = graph.sum(mechanism.dissipation.iter().map(|summand| summand.value));

    let momenta = mass::momenta(graph, kinetic, n, by);
    within_bounds(graph)?;
    let shared = match by {
        Sweep::Forward => None,
        Sweep::Back => Reduced::of(graph, kinetic, n),
    };
    let mut mass = match &shared {
        Some(reduced) => composite::mass_matrix(graph, reduced, n),
        None => mass::mass_matrix(graph, &momenta),
    };
    let mut inertia = shared.and_then(|reduced| inertia::inertia(graph, &reduced, n));
    for (i, row) in mass.iter_mut().enumerate().skip(freedoms) {
        row[i] = graph.integer(1);
        if let (Some(inertia), Ok(state)) = (&mut inertia, u32::try_from(i)) {
            inertia[i] = graph.symbol(Symbol::Acceleration(state));
        }
    }
    within_bounds(graph)?;
    let coriolis = force::coriolis_product(graph, kinetic, &momenta, by);
    let gravity = force::potential_force(graph, potential, n, by);
    let sizes = (n, freedoms);
    let applied = force::applied(graph, &mechanism.forces, dissipation, sizes, by);
    let force = force::total(graph, &applied, &coriolis, &gravity);
    Some(Motion {
        kinetic,
        potential,
        momenta,
        mass,
        inertia,
        coriolis,
        gravity,
        applied,
        force,
    })
}
