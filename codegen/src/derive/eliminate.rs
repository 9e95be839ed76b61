//! Elimination of the coordinates that constraints give explicitly.
//!
//! In:  a mechanism.
//! Out: the same motion in the coordinates that are left, with the constraints that are
//!      left; and the declared coordinates, with their velocities, accelerations and
//!      reactions, as expressions in them.
//!
//! `q_k = f(q, t)` goes into every energy, force and constraint, `q̇_k = ∂f/∂q q̇ + ∂f/∂t`
//! with it. Virtual work and Rayleigh's function then give forces on the other
//! coordinates by themselves, `Q_j + Q_k ∂f/∂q_j`. The rows of the eliminated constraints are
//! independent everywhere, so that no loss of rank disappears with them: the rest is singular
//! where the whole was.

use super::explicit::{Explicit, explicit};
use super::gradient::Sweep;
use super::gradient::{coordinates, velocities};
use super::inertia::product;
use super::motion::{Motion, motion};
use super::swell;
use crate::diagnostic::Diagnostics;
use crate::expr::ExprId;
use crate::model::{Described, Graph, Mechanism, Shape, Symbol};

/// The mechanism without the coordinates that its constraints give explicitly; unchanged if
/// there are none. A coordinate that decides the start stays, and at least one coordinate
/// does.
///
/// # Errors
///
/// As [`derive`](super::derive).
pub fn eliminate(mut mechanism: Mechanism) -> Result<Mechanism, Diagnostics> {
    let found = explicit(&mut mechanism);
    if found.is_empty() {
        return Ok(mechanism);
    }
    let Some(reactions) = reactions(&mut mechanism) else {
        return Err(swell::refusal(&mechanism));
    };
    let kept = Kept::of(&mut mechanism, &found);
    let freedoms = mechanism.freedoms();
    let declared = std::mem::take(&mut mechanism.coordinates);
    for (i, quantity) in declared.into_iter().enumerate() {
        let row = found.iter().find(|e| e.coordinate == i).map(|e| e.row);
        if row.is_none() {
            mechanism.coordinates.push(quantity.clone());
        }
        if i >= freedoms {
            continue;
        }
        mechanism.described.push(Described {
            quantity,
            given_by: row.map(|row| mechanism.constraints[row].clone()),
            position: kept.positions[i],
            velocity: kept.velocities[i],
            acceleration: kept.accelerations[i],
            reaction: kept.expressed(&mut mechanism.graph, reactions[i]),
        });
    }
    rewrite(&mut mechanism, &kept, &found);
    Ok(mechanism)
}

/// `r = p₁ − M q̈` in all coordinates.
fn reactions(mechanism: &mut Mechanism) -> Option<Vec<ExprId>> {
    let Motion {
        mass,
        inertia,
        force,
        ..
    } = motion(mechanism, Sweep::Forward)?;
    let graph = &mut mechanism.graph;
    let inertia = product(graph, inertia.as_ref(), mass.as_ref());
    let pairs = force.into_iter().zip(inertia);
    Some(pairs.map(|(force, i)| graph.sub(force, i)).collect())
}

/// The declared coordinates in terms of those that are kept, by their old places.
struct Kept {
    positions: Vec<ExprId>,
    velocities: Vec<ExprId>,
    accelerations: Vec<ExprId>,
    /// The new place of each coordinate that is kept.
    places: Vec<Option<usize>>,
}

impl Kept {
    fn of(mechanism: &mut Mechanism, found: &[Explicit]) -> Self {
        let graph = &mut mechanism.graph;
        let given = |i: usize| found.iter().find(|e| e.coordinate == i);
        let mut next = 0..;
        let place = |i| given(i).is_none().then(|| next.next()).flatten();
        let places: Vec<Option<usize>> = (0..mechanism.coordinates.len()).map(place).collect();
        let symbols: Vec<Option<ExprId>> = places
            .iter()
            .map(|place| place.map(|i| graph.symbol(Symbol::Coordinate(i as u32))))
            .collect();
        let renamed = |symbol| match symbol {
            Symbol::Coordinate(i) => symbols[i as usize],
            _ => None,
        };
        let mut positions = Vec::new();
        for (i, symbol) in symbols.iter().enumerate() {
            positions.extend(match given(i) {
                Some(explicit) => Some(graph.substitute(explicit.value, &renamed)),
                None => *symbol,
            });
        }
        let count = places.iter().flatten().count();
        let velocities = flow(graph, &positions, count);
        let accelerations = flow(graph, &velocities, count);
        Self {
            positions,
            velocities,
            accelerations,
            places,
        }
    }

    /// An expression of declared coordinates in those that are kept.
    fn expressed(&self, graph: &mut Graph, e: ExprId) -> ExprId {
        graph.substitute(e, &|symbol| match symbol {
            Symbol::Coordinate(i) => Some(self.positions[i as usize]),
            Symbol::Velocity(i) => Some(self.velocities[i as usize]),
            Symbol::Acceleration(i) => Some(self.accelerations[i as usize]),
            _ => None,
        })
    }
}

/// Rates in time of expressions of the first `count` coordinates and their velocities.
fn flow(graph: &mut Graph, expressions: &[ExprId], count: usize) -> Vec<ExprId> {
    let mut seeds = vec![(Symbol::Time, graph.integer(1))];
    for (position, velocity) in coordinates(count).zip(velocities(count)) {
        seeds.push((position, graph.symbol(velocity)));
    }
    for (i, velocity) in (0..).zip(velocities(count)) {
        seeds.push((velocity, graph.symbol(Symbol::Acceleration(i))));
    }
    let mut direction = crate::expr::Direction::new(seeds);
    let rate = |&e: &ExprId| graph.derivative_along(e, &mut direction);
    expressions.iter().map(rate).collect()
}

/// Puts everything that the description says into the coordinates that are kept.
fn rewrite(mechanism: &mut Mechanism, kept: &Kept, found: &[Explicit]) {
    let Mechanism {
        graph,
        inputs,
        kinetic,
        potential,
        dissipation,
        forces,
        constraints,
        starts,
        start_equations,
        start_guesses,
        outputs,
        events,
        shapes,
        ..
    } = mechanism;
    let mut row = 0..;
    constraints.retain(|_| {
        let row = row.next();
        found.iter().all(|explicit| Some(explicit.row) != row)
    });
    let summands = [kinetic, potential, dissipation].into_iter().flatten();
    let forces = forces.iter_mut();
    let everything = summands
        .map(|summand| &mut summand.value)
        .chain(forces.flat_map(|force| force.force.iter_mut().chain(&mut force.on)))
        .chain(constraints.iter_mut().map(|row| &mut row.residual))
        .chain(start_equations.iter_mut().map(|row| &mut row.residual))
        .chain(start_guesses.iter_mut().map(|row| &mut row.residual))
        .chain(inputs.iter_mut().map(|input| &mut input.law))
        .chain(outputs.iter_mut().map(|output| &mut output.value))
        .chain(events.iter_mut().map(|event| &mut event.value))
        .chain(shapes.iter_mut().flat_map(numbers));
    for e in everything {
        *e = kept.expressed(graph, *e);
    }
    // Rows that follow from the eliminated constraints have become `0 = 0`.
    constraints.retain(|row| !graph.is_zero(row.residual));
    starts.retain_mut(|start| {
        let place = kept.places[start.coordinate];
        start.coordinate = place.unwrap_or(start.coordinate);
        place.is_some()
    });
}

/// The numbers of a part of the picture.
fn numbers(shape: &mut Shape) -> Box<dyn Iterator<Item = &mut ExprId> + '_> {
    match shape {
        Shape::Line(points) | Shape::Polygon(points) => Box::new(points.iter_mut().flatten()),
        Shape::Circle(centre, radius) => Box::new(centre.iter_mut().chain([radius])),
        Shape::Trace(point) => Box::new(point.iter_mut()),
    }
}
