//! What comes of energies and forces: `M` and `p₁` with its parts.

use super::equations::Matrix;
use super::gradient::Sweep;
use super::reduced::Reduced;
use super::swell::within_bounds;
use super::{composite, force, inertia, mass};
use crate::expr::ExprId;
use crate::model::{Mechanism, Symbol};

/// What comes of the energies and forces alone.
pub(super) struct Motion {
    pub kinetic: ExprId,
    pub potential: ExprId,
    pub momenta: Vec<ExprId>,
    pub mass: Option<Matrix>,
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
    let inertia = shared.as_ref();
    let mut inertia = inertia.and_then(|reduced| inertia::inertia(graph, reduced, n));
    for (state, entry) in (0..).zip(inertia.iter_mut().flatten()).skip(freedoms) {
        *entry = graph.symbol(Symbol::Acceleration(state));
    }
    let needs_entries = inertia.is_none() || !mechanism.constraints.is_empty();
    let mass = needs_entries.then(|| {
        let mut mass = match &shared {
            Some(reduced) => composite::mass_matrix(graph, reduced, n),
            None => mass::of_momenta(graph, &momenta),
        };
        mass::set_states(graph, &mut mass, freedoms);
        mass
    });
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
