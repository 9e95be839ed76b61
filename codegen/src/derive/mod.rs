//! Mechanism to equations of motion.
//!
//! In:  a checked [`Mechanism`].
//! Out: [`Equations`]: `M`, `C q̇`, `h`, `Q`, `p₁`, `g`, `A`, `b`, `p₂` and the
//!      energies, as expressions in the mechanism's graph. Source: Phong & Hoang
//!      (2012), eqs. 2.1–2.10.
//!
//! Not here: simplification, and what is computed when. Equal terms meet in the
//! graph, and `optimise` decides the rest.

mod christoffel;
mod closure;
mod eliminate;
mod energy;
mod explicit;
mod force;
mod linearised;
mod mass;
mod properties;
mod swell;
mod switch;
mod weighed;

pub use christoffel::coriolis_matrix;
pub use eliminate::eliminate;
pub use linearised::{Linearised, linearise};
pub use swell::{EXPRESSIONS_MAX, SWELL, swell};

use crate::diagnostic::Diagnostics;
use crate::expr::{ExprId, Graph, Symbol};
use crate::model::Mechanism;
use swell::within_bounds;

/// A matrix of expressions, row by row.
pub type Matrix = Vec<Vec<ExprId>>;

/// The equations of motion of a mechanism with `N` coordinates and `R`
/// constraint equations: `M q̈ + r = p₁`, `A q̈ = p₂`, `g = 0`.
#[derive(Clone, Debug)]
pub struct Equations {
    /// `M`, `N × N`.
    pub mass: Matrix,
    /// `C q̇` and the terms of moving frames: `d/dt ∂T/∂q̇ − M q̈ − ∂T/∂q`, `N`.
    pub coriolis: Vec<ExprId>,
    /// `h = ∂Π/∂q`, `N`.
    pub gravity: Vec<ExprId>,
    /// `Q`: applied forces and dissipation, `N`.
    pub applied: Vec<ExprId>,
    /// `p₁ = Q − C q̇ − h`, `N`.
    pub force: Vec<ExprId>,
    /// The constraints `g`, `R`; zero for velocity constraints.
    pub residual: Vec<ExprId>,
    /// `A q̇ + b`, `R`.
    pub speed: Vec<ExprId>,
    /// `∂(A q̇ + b)/∂q`, `R × N`.
    pub turn: Matrix,
    /// `A`, `R × N`.
    pub jacobian: Matrix,
    /// Rows of `A` that take part in the metric `M + AᵀWA`, because `M` alone is singular.
    pub weighed: Vec<usize>,
    /// `b`, `R`, of the velocity level `A q̇ + b = 0`.
    pub drift: Vec<ExprId>,
    /// `p₂ = −(Ȧ q̇ + ḃ)`, `R`.
    pub bias: Vec<ExprId>,
    /// The energies.
    pub energies: Energies,
    /// Equations of the start for positions, those that are held first: `g` and `∂g/∂q`.
    pub start_positions: StartRows,
    /// Equations of the start for velocities, likewise: `b` and `A` of `A q̇ + b = 0`.
    pub start_velocities: StartRows,
}

/// Equations of the start.
#[derive(Clone, Debug)]
pub struct StartRows {
    /// What they are off by; for velocities, at rest.
    pub errors: Vec<ExprId>,
    /// Their derivatives by coordinates or velocities.
    pub slopes: Matrix,
}

/// Scalar quantities of a mechanism.
#[derive(Clone, Copy, Debug)]
pub struct Energies {
    /// `T`.
    pub kinetic: ExprId,
    /// `Π`.
    pub potential: ExprId,
    /// `T₂ − T₀ + Π`.
    pub balance: ExprId,
    /// `Q·q̇ + ∂Π/∂t − ∂T/∂t`.
    pub power: ExprId,
}

/// Derives the equations of motion from energies and constraints.
///
/// # Errors
///
/// More than [`EXPRESSIONS_MAX`] expressions, with the lines that most of them come
/// from; more conditions than a run has room for.
pub fn derive(mechanism: &mut Mechanism) -> Result<Equations, Diagnostics> {
    switch::hold(mechanism)?;
    equations(mechanism).ok_or_else(|| swell::refusal(mechanism))
}

/// What comes of the energies and forces alone.
struct Motion {
    kinetic: ExprId,
    potential: ExprId,
    momenta: Vec<ExprId>,
    mass: Matrix,
    coriolis: Vec<ExprId>,
    gravity: Vec<ExprId>,
    applied: Vec<ExprId>,
    force: Vec<ExprId>,
}

/// `M` and `p₁` with its parts, or nothing as soon as they are too long.
fn motion(mechanism: &mut Mechanism) -> Option<Motion> {
    let (n, freedoms) = (mechanism.coordinates.len(), mechanism.freedoms());
    let graph = &mut mechanism.graph;
    let kinetic = graph.sum(mechanism.kinetic.iter().map(|summand| summand.value));
    let potential = graph.sum(mechanism.potential.iter().map(|summand| summand.value));
    let dissipation = graph.sum(mechanism.dissipation.iter().map(|summand| summand.value));

    let momenta = mass::momenta(graph, kinetic, n);
    within_bounds(graph)?;
    let mut mass = mass::mass_matrix(graph, &momenta);
    for (i, row) in mass.iter_mut().enumerate().skip(freedoms) {
        row[i] = graph.integer(1);
    }
    within_bounds(graph)?;
    let coriolis = force::coriolis_product(graph, kinetic, &momenta);
    let gravity = force::potential_force(graph, potential, n);
    let applied = force::applied(graph, &mechanism.forces, dissipation, (n, freedoms));
    let force = force::total(graph, &applied, &coriolis, &gravity);
    Some(Motion {
        kinetic,
        potential,
        momenta,
        mass,
        coriolis,
        gravity,
        applied,
        force,
    })
}

/// The equations, or nothing as soon as they are too long.
fn equations(mechanism: &mut Mechanism) -> Option<Equations> {
    let (n, freedoms) = (mechanism.coordinates.len(), mechanism.freedoms());
    let Motion {
        kinetic,
        potential,
        momenta,
        mass,
        coriolis,
        gravity,
        applied,
        force,
    } = motion(mechanism)?;
    let graph = &mut mechanism.graph;

    within_bounds(graph)?;
    let closure = closure::closure(graph, &mechanism.constraints, n);
    within_bounds(graph)?;
    let held = mechanism.start_equations.iter();
    let equations = held.chain(&mechanism.start_guesses).cloned();
    let (positions, speeds): (Vec<_>, Vec<_>) = equations.partition(|row| row.holonomic);
    let positions = closure::closure(graph, &positions, n);
    let speeds = closure::closure(graph, &speeds, n);
    within_bounds(graph)?;
    // What acts on states does no work.
    let (forces, momenta) = (&applied[..freedoms], &momenta[..freedoms]);
    let energies = energy::energies(graph, kinetic, potential, forces, momenta);
    within_bounds(graph)?;
    let weighed = weighed::weighed(graph, &mass, &closure.jacobian);
    Some(Equations {
        mass,
        coriolis,
        gravity,
        applied,
        force,
        residual: closure.residual,
        speed: closure.speed,
        turn: closure.turn,
        jacobian: closure.jacobian,
        weighed,
        drift: closure.drift,
        bias: closure.bias,
        energies,
        start_positions: StartRows {
            errors: positions.residual,
            slopes: positions.jacobian,
        },
        start_velocities: StartRows {
            errors: speeds.drift,
            slopes: speeds.jacobian,
        },
    })
}

/// The symbols of `n` velocities or coordinates.
fn velocities(n: usize) -> impl Iterator<Item = Symbol> + Clone {
    (0..u32::try_from(n).unwrap_or(u32::MAX)).map(Symbol::Velocity)
}

fn coordinates(n: usize) -> impl Iterator<Item = Symbol> + Clone {
    (0..u32::try_from(n).unwrap_or(u32::MAX)).map(Symbol::Coordinate)
}

/// `∂e/∂symbol` for each symbol, in order.
fn gradient(graph: &mut Graph, e: ExprId, symbols: impl Iterator<Item = Symbol>) -> Vec<ExprId> {
    let present = graph.symbols(e);
    let mut by = |symbol| match present.contains(&symbol) {
        true => graph.differentiate(e, symbol),
        false => graph.integer(0),
    };
    symbols.map(&mut by).collect()
}

/// The derivatives in time, at frozen velocities, of several expressions.
fn rates(graph: &mut Graph, expressions: &[ExprId], n: usize) -> Vec<ExprId> {
    let symbols = coordinates(n).chain([Symbol::Time]);
    let mut flow = graph.frozen_flow(symbols);
    expressions
        .iter()
        .map(|&e| graph.derivative_along(e, &mut flow))
        .collect()
}
