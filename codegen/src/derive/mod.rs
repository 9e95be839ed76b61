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
mod components;
mod composite;
mod eliminate;
mod energy;
mod equations;
mod explicit;
mod finite;
mod force;
mod gradient;
mod hold;
mod independent;
mod inertia;
mod knots;
mod linearised;
mod local;
mod mass;
mod motion;
mod partition;
mod properties;
mod reduced;
mod shared;
mod swell;
mod switch;
mod trial;
mod vanishing;
mod weighed;

pub use christoffel::coriolis_matrix;
pub use eliminate::eliminate;
pub use equations::{ConnectedComponent, Energies, Equations, Matrix, StartRows};
pub use linearised::{Linearisation, Partials, differentiate, linearise};
pub use mass::mass_matrix;
pub use partition::Partition;
pub use shared::{Shared, shared};
pub use swell::{SWELL, swell};

use crate::diagnostic::Diagnostics;
use crate::model::Mechanism;
use gradient::Sweep;
use inertia::LONG_CHAIN;
use motion::{Motion, motion};
use swell::within_bounds;
use weighed::weighed;

/// Equations with more expressions than this are derived in one sweep, too, for comparison.
const LONG: usize = 100;

/// Below [`SWELL`], equations that are derived in one sweep from the energy back are taken only if
/// they have less than this part of the expressions of the others: linearisation differentiates
/// once more, which takes longer with their formulas.
const MUCH_SHORTER: (usize, usize) = (2, 3);

/// Derives the equations of motion from energies and constraints.
///
/// # Errors
///
/// More than [`EXPRESSIONS_MAX`](crate::model::EXPRESSIONS_MAX) expressions, with the lines
/// that most of them come from; more conditions than a run has room for; numbers that are not
/// finite.
pub fn derive(mechanism: &mut Mechanism) -> Result<Equations, Diagnostics> {
    switch::hold(mechanism)?;
    let equations = shortest(mechanism)?;
    finite::check(mechanism, &equations)?;
    Ok(equations)
}

/// The shortest of the ways in which the equations may be written.
fn shortest(mechanism: &mut Mechanism) -> Result<Equations, Diagnostics> {
    let begun = mechanism.clone();
    // Symbol by symbol a long chain would have many more expressions.
    let first = (begun.coordinates.len() >= LONG_CHAIN).then(|| in_one_sweep(&begun));
    let first = match first {
        Some(Some((other, back))) if back.inertia.is_some() => {
            *mechanism = other;
            return Ok(back);
        }
        other => other,
    };
    let forward = equations(mechanism, Sweep::Forward);
    let size = |mechanism: &Mechanism, equations: &Equations| swell::size(mechanism, equations);
    let longest = forward.as_ref().map(|equations| size(mechanism, equations));
    if longest.is_none_or(|longest| longest > LONG) {
        let back = first.unwrap_or_else(|| in_one_sweep(&begun));
        let most = longest.map_or(usize::MAX, |longest| match longest > SWELL {
            true => longest,
            false => longest * MUCH_SHORTER.0 / MUCH_SHORTER.1,
        });
        let shorter = back.filter(|(other, back)| size(other, back) < most);
        if let Some((other, back)) = shorter {
            *mechanism = other;
            return Ok(back);
        }
    }
    forward.ok_or_else(|| swell::refusal(mechanism))
}

/// The equations from the energy back, and the mechanism with their expressions; nothing
/// where they are too long.
fn in_one_sweep(begun: &Mechanism) -> Option<(Mechanism, Equations)> {
    let mut mechanism = begun.clone();
    let equations = equations(&mut mechanism, Sweep::Back)?;
    Some((mechanism, equations))
}

/// The equations, or nothing as soon as they are too long.
fn equations(mechanism: &mut Mechanism, by: Sweep) -> Option<Equations> {
    let (n, freedoms) = (mechanism.coordinates.len(), mechanism.freedoms());
    let Motion {
        kinetic,
        potential,
        momenta,
        mass,
        inertia,
        coriolis,
        gravity,
        applied,
        force,
    } = motion(mechanism, by)?;
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
    let weighed = weighed(graph, mass.as_ref(), &closure.jacobian);
    let components = mass
        .as_ref()
        .map(|mass| components::components(graph, &mechanism.constraints, &closure, mass));
    Some(Equations {
        mass,
        inertia,
        coriolis,
        gravity,
        applied,
        force,
        residual: closure.residual,
        speed: closure.speed,
        turn: closure.turn,
        jacobian: closure.jacobian,
        weighed: weighed.rows,
        redundant: Vec::new(),
        metric_degenerates: weighed.degenerates,
        components: components.unwrap_or_default(),
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
