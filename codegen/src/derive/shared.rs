//! The kinetic energy in velocities that bodies share, for solves that need not know how each
//! of them is made of the coordinates' velocities.
//!
//! In:  a mechanism without constraints.
//! Out: [`Shared`]: `T` as a form in the velocities `w` of points that several bodies have in
//!      common and in `q̇`, and how each `w` is made of those before it.
//!
//! In a chain, `M` has an entry for each pair of bodies. With the velocity of each joint as
//! an unknown of its own, each body meets its neighbours only, and elimination goes from
//! body to body, as the recursive methods do. Source: Featherstone, Rigid Body Dynamics
//! Algorithms (2008), section 7.3 ("articulated-body algorithm").
//!
//! `(w, q̇) = J q̇` and `M = Jᵀ M̃ J`, so that `M q̈ = p₁` is `Jᵀ (M̃ J q̈ − f) = 0` for all `f`
//! with `Jᵀ f = p₁`.

use super::equations::Equations;
use super::force;
use super::gradient::{Sweep, coordinates, rates};
use super::local::Local;
use super::reduced::{Entries, Reduced};
use crate::expr::ExprId;
use crate::model::Mechanism;

/// A solve for accelerations in shared velocities, which are the first of the unknowns.
#[derive(Clone, Debug)]
pub struct Shared {
    /// How many velocities are shared.
    pub count: usize,
    /// `M̃`, both triangles.
    pub mass: Entries,
    /// `L` of `w = L x`, a row for each shared velocity: what it is made of.
    pub links: Entries,
    /// `f`, of all unknowns, whose common parts are computed once.
    pub force: Vec<ExprId>,
}

/// The equations of motion in shared velocities; none with constraints, where none are
/// shared, or where masses depend on velocities.
pub fn shared(mechanism: &mut Mechanism, equations: &Equations) -> Option<Shared> {
    if !equations.jacobian.is_empty() {
        return None;
    }
    let (n, freedoms) = (mechanism.coordinates.len(), mechanism.freedoms());
    let graph = &mut mechanism.graph;
    let kinetic = graph.sum(mechanism.kinetic.iter().map(|summand| summand.value));
    let Reduced {
        count,
        mut mass,
        links,
    } = Reduced::of(graph, kinetic, n)?;
    let one = graph.integer(1);
    mass.extend((freedoms..n).map(|state| (count + state, count + state, one)));
    let parts = parts(mechanism);
    let graph = &mut mechanism.graph;
    let local = Local::of(graph, &links, count);
    let [applied, carried, slope, gravity] = parts.map(|part| local.moved(graph, &part));
    let pairs = carried.iter().zip(&slope);
    let coriolis: Vec<ExprId> = pairs
        .map(|(&rate, &slope)| graph.sub(rate, slope))
        .collect();
    let force = force::total(graph, &applied, &coriolis, &gravity);
    Some(Shared {
        count,
        mass,
        links,
        force,
    })
}

/// What `p₁` is made of, as reverse sweeps give it: `Q`, `d/dt ∂T/∂q̇` without what
/// accelerations bring, `∂T/∂q` and `h`.
fn parts(mechanism: &mut Mechanism) -> [Vec<ExprId>; 4] {
    let (n, freedoms) = (mechanism.coordinates.len(), mechanism.freedoms());
    let graph = &mut mechanism.graph;
    let [kinetic, potential, dissipation] = [
        &mechanism.kinetic,
        &mechanism.potential,
        &mechanism.dissipation,
    ]
    .map(|summands| graph.sum(summands.iter().map(|summand| summand.value)));
    let by = Sweep::Back;
    let momenta = super::mass::momenta(graph, kinetic, n, by);
    [
        force::applied(graph, &mechanism.forces, dissipation, (n, freedoms), by),
        rates(graph, &momenta, n),
        by.gradient(graph, kinetic, coordinates(n)),
        force::potential_force(graph, potential, n, by),
    ]
}
