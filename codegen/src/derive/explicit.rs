//! Coordinates that constraints give explicitly.
//!
//! In:  a mechanism.
//! Out: which coordinate is which function of the others, by which constraint.
//!
//! `c(q, t) = s q_k + (what is free of q_k) = 0` with a number `s` gives `q_k = f(q, t)`,
//! whatever the position: nothing is lost by leaving `q_k` out. A coefficient that has a
//! parameter or a coordinate in it may vanish, so it does not count.

use crate::expr::{ExprId, Number};
use crate::model::{Graph, Mechanism, Symbol};
use std::collections::BTreeSet;

/// A coordinate that a constraint gives.
pub(super) struct Explicit {
    /// The coordinate, by its place.
    pub coordinate: usize,
    /// The constraint, by its place.
    pub row: usize,
    /// What the coordinate is, in time and coordinates that no constraint gives.
    pub value: ExprId,
}

/// What the start says of coordinates, by their places.
struct Starts {
    /// Whether their values or velocities are held.
    held: BTreeSet<usize>,
    /// Whether their values are held or guessed.
    placed: BTreeSet<usize>,
}

impl Starts {
    fn of(mechanism: &Mechanism) -> Self {
        let held = mechanism.starts.iter().filter(|start| start.held);
        let placed = mechanism.starts.iter().filter(|start| !start.velocity);
        Self {
            held: held.map(|start| start.coordinate).collect(),
            placed: placed.map(|start| start.coordinate).collect(),
        }
    }

    /// Whether a coordinate with this value can be eliminated: not if it is held, or if its
    /// guess is the only one that tells where the coordinates in its value are.
    fn spares(&self, graph: &Graph, coordinate: usize, value: ExprId) -> bool {
        let place = |symbol| match symbol {
            Symbol::Coordinate(i) => Some(i as usize),
            _ => None,
        };
        let others = graph.symbols(value).into_iter().filter_map(place);
        let others: Vec<usize> = others.collect();
        let told = others.is_empty() || others.iter().any(|i| self.placed.contains(i));
        !self.held.contains(&coordinate) && (told || !self.placed.contains(&coordinate))
    }
}

/// The coordinates that can be eliminated, with their values. Those that decide the start
/// stay, and at least one coordinate does.
pub(super) fn explicit(mechanism: &mut Mechanism) -> Vec<Explicit> {
    let starts = Starts::of(mechanism);
    let graph = &mut mechanism.graph;
    let rows = mechanism.constraints.iter();
    let mut residuals: Vec<ExprId> = rows.map(|row| row.residual).collect();
    let mut found: Vec<Explicit> = Vec::new();
    for (row, constraint) in mechanism.constraints.iter().enumerate() {
        if found.len() + 1 == mechanism.coordinates.len() {
            break;
        }
        if !constraint.holonomic {
            continue;
        }
        let Some((coordinate, value)) = solved(graph, residuals[row], &starts) else {
            continue;
        };
        let mut insert = |e: &mut ExprId| *e = inserted(graph, *e, coordinate, value);
        residuals.iter_mut().for_each(&mut insert);
        // Values that were found earlier may contain this coordinate: a chain may stand in any
        // order.
        found.iter_mut().for_each(|e| insert(&mut e.value));
        found.push(Explicit {
            coordinate,
            row,
            value,
        });
    }
    found
}

/// The coordinate that an equation gives; if it gives several, the one declared last, since
/// descriptions go from the ground outwards.
fn solved(graph: &mut Graph, residual: ExprId, starts: &Starts) -> Option<(usize, ExprId)> {
    let symbols = graph.symbols(residual);
    let candidates = symbols.into_iter().rev().filter_map(|symbol| match symbol {
        Symbol::Coordinate(k) => Some((symbol, k as usize)),
        _ => None,
    });
    for (symbol, k) in candidates {
        let slope = graph.differentiate(residual, symbol);
        let inverse = graph.as_number(slope).and_then(|slope| slope.powi(-1));
        if let Some(inverse) = inverse.filter(|_| !graph.is_zero(slope)) {
            let zero = graph.integer(0);
            let rest = inserted(graph, residual, k, zero);
            let value = graph.scale(rest, Number::MINUS_ONE * inverse);
            if starts.spares(graph, k, value) {
                return Some((k, value));
            }
        }
    }
    None
}

/// An expression with a coordinate replaced.
fn inserted(graph: &mut Graph, e: ExprId, coordinate: usize, value: ExprId) -> ExprId {
    graph.substitute(e, &|symbol| match symbol {
        Symbol::Coordinate(i) if i as usize == coordinate => Some(value),
        _ => None,
    })
}
