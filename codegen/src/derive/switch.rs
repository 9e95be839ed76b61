//! Switching functions for the conditions of forces and inputs.
//!
//! In:  a mechanism.
//! Out: the same mechanism, in whose forces and laws each comparison, `abs`, `sign`, `min` and
//!      `max` that can change along a motion depends on the sign of a switching function,
//!      which a run may hold over a step; the list of those functions with their rates, and
//!      others that are zero where a spline of the time goes on with another polynomial.
//!
//! Energies and constraints have no conditions. Outputs and events keep theirs, which
//! follow the state.

use super::hold::Switches;
use crate::diagnostic::{Diagnostic, Diagnostics, Span};
use crate::expr::{Direction, ExprId};
use crate::model::{Mechanism, Switch, Symbol};
use std::collections::BTreeSet;

/// Switching functions that a run has room for.
const ROOM: usize = 128;

/// Makes the conditions of forces and laws depend on switching functions.
///
/// # Errors
///
/// More switching functions than a run has room for.
pub(super) fn hold(mechanism: &mut Mechanism) -> Result<(), Diagnostics> {
    let mut switches = Switches::default();
    let mut spans: Vec<Span> = Vec::new();
    let used = inputs_of_motion(mechanism);
    let graph = &mut mechanism.graph;
    for force in &mut mechanism.forces {
        for component in &mut force.force {
            *component = graph.hold(*component, &mut switches);
        }
        spans.resize(switches.list.len(), force.span);
    }
    for (i, input) in (0..).zip(&mut mechanism.inputs) {
        if used.contains(&i) {
            input.law = graph.hold(input.law, &mut switches);
            spans.resize(switches.list.len(), input.quantity.span);
        }
    }
    if switches.list.len() > ROOM {
        return Err(too_many(switches.list.len(), spans[ROOM]));
    }
    for (roots, span) in smooth(mechanism, &used) {
        mechanism.graph.add_knots(&roots, &mut switches, ROOM);
        spans.resize(switches.list.len(), span);
    }
    for (found, span) in switches.list.iter().zip(spans) {
        let rate = rate(mechanism, found.function);
        let names = |symbol| mechanism.symbol_text(symbol);
        let text = mechanism.graph.text(found.met_in, &names);
        let fixed_or_time = |symbol: &Symbol| matches!(symbol, Symbol::Parameter(_) | Symbol::Time);
        let symbols = mechanism.graph.symbols(found.function);
        mechanism.switches.push(Switch {
            value: found.function,
            rate,
            text,
            span,
            discontinuity: found.discontinuity,
            of_time: symbols.iter().all(fixed_or_time),
        });
    }
    Ok(())
}

/// What the accelerations are made of, statement by statement.
fn smooth(mechanism: &Mechanism, used: &BTreeSet<u32>) -> Vec<(Vec<ExprId>, Span)> {
    let energies = [
        &mechanism.kinetic,
        &mechanism.potential,
        &mechanism.dissipation,
    ];
    let energies = energies.into_iter().flatten();
    let energies = energies.map(|summand| (vec![summand.value], summand.span));
    let forces = mechanism.forces.iter();
    let forces = forces.map(|force| ([&force.force[..], &force.on].concat(), force.span));
    let inputs = (0..)
        .zip(&mechanism.inputs)
        .filter(|(i, _)| used.contains(i));
    let inputs = inputs.map(|(_, input)| (vec![input.law], input.quantity.span));
    let rows = mechanism.constraints.iter();
    let rows = rows.map(|row| (vec![row.residual], row.span));
    energies.chain(forces).chain(inputs).chain(rows).collect()
}

/// The inputs that forces or dissipation are made of.
fn inputs_of_motion(mechanism: &Mechanism) -> BTreeSet<u32> {
    let forces = mechanism.forces.iter().flat_map(|force| &force.force);
    let losses = mechanism.dissipation.iter().map(|summand| &summand.value);
    let roots = forces.chain(losses).copied();
    let mut used = BTreeSet::new();
    for e in roots {
        let symbols = mechanism.graph.symbols(e);
        used.extend(symbols.into_iter().filter_map(|symbol| match symbol {
            Symbol::Input(i) => Some(i),
            _ => None,
        }));
    }
    used
}

/// `∂s/∂t + ∂s/∂q q̇ + ∂s/∂q̇ q̈`; an input changes as its law does while it follows it.
fn rate(mechanism: &mut Mechanism, function: ExprId) -> ExprId {
    let n = u32::try_from(mechanism.coordinates.len()).unwrap_or(u32::MAX);
    let Mechanism { graph, inputs, .. } = mechanism;
    let mut seeds = vec![(Symbol::Time, graph.integer(1))];
    for i in 0..n {
        seeds.push((Symbol::Coordinate(i), graph.symbol(Symbol::Velocity(i))));
        seeds.push((Symbol::Velocity(i), graph.symbol(Symbol::Acceleration(i))));
    }
    let mut motion = Direction::new(seeds.clone());
    for (i, input) in (0..).zip(inputs.iter()) {
        let change = graph.derivative_along(input.law, &mut motion);
        let follows = graph.symbol(Symbol::Follows(i));
        seeds.push((Symbol::Input(i), graph.mul(follows, change)));
    }
    graph.derivative_along(function, &mut Direction::new(seeds))
}

fn too_many(count: usize, span: Span) -> Diagnostics {
    let message = format!("{count} conditions decide the forces, and there is room for {ROOM}");
    let help = "write forces that begin and end smoothly instead, such as `tanh(x/d)` for \
                `sign(x)`, and `spline` for `table`";
    let mut errors = Diagnostics::new();
    errors.push(Diagnostic::error(span, message).help(help));
    errors
}
