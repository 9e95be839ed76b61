//! Connected components of the constraints.
//!
//! In:  the constraints `g`, their Jacobian `A` and the velocity `b`.
//! Out: coordinates that constraints tie together, and the rows that do.
//!
//! Rows of different components have no coordinate in common, neither in their entries nor in
//! what these depend on: the constraint set is the product of those of its components.

use super::closure::Closure;
use super::equations::ConnectedComponent;
use super::properties::is_scleronomic;
use crate::expr::ExprId;
use crate::model::{Constraint, Graph, Node, Symbol};
use std::collections::{BTreeMap, BTreeSet};

/// The connected components, in the order of their first coordinates; none where all
/// coordinates are in one, or there are no constraints.
pub(super) fn components(
    graph: &Graph,
    constraints: &[Constraint],
    closure: &Closure,
    n: usize,
) -> Vec<ConnectedComponent> {
    let rows = 0..constraints.len();
    let tied: Vec<BTreeSet<usize>> = rows.map(|row| tied(graph, closure, row)).collect();
    let mut first: Vec<usize> = (0..n).collect();
    for coordinates in &tied {
        join(&mut first, coordinates);
    }
    let mut components = BTreeMap::new();
    for (coordinate, first) in first.iter().enumerate() {
        let component = components.entry(*first).or_insert(ConnectedComponent {
            coordinates: Vec::new(),
            rows: Vec::new(),
            scleronomic: true,
        });
        component.coordinates.push(coordinate);
    }
    for (row, coordinates) in tied.iter().enumerate() {
        let of = coordinates.first().map(|coordinate| first[*coordinate]);
        if let Some(component) = of.and_then(|first| components.get_mut(&first)) {
            component.rows.push(row);
            component.scleronomic &=
                is_scleronomic(graph, &constraints[row], closure.residual[row]);
        }
    }
    let is_one = components.len() == 1 || constraints.is_empty();
    let components = components.into_values().filter(|_| !is_one);
    components.collect()
}

/// The coordinates that a row ties together.
fn tied(graph: &Graph, closure: &Closure, row: usize) -> BTreeSet<usize> {
    let entries = closure.jacobian[row].iter().copied();
    let moved = entries.clone().enumerate();
    let moved = moved.filter(|(_, entry)| !graph.is_zero(*entry));
    let mut tied: BTreeSet<usize> = moved.map(|(coordinate, _)| coordinate).collect();
    let others = entries.chain([closure.residual[row], closure.drift[row]]);
    let others: Vec<ExprId> = others.collect();
    for e in graph.reachable(&others) {
        if let Node::Symbol(Symbol::Coordinate(coordinate)) = graph.node(e) {
            tied.insert(*coordinate as usize);
        }
    }
    tied
}

/// Gives all components that some coordinates are in the first of them.
fn join(first: &mut [usize], coordinates: &BTreeSet<usize>) {
    let Some(least) = coordinates
        .iter()
        .map(|coordinate| first[*coordinate])
        .min()
    else {
        return;
    };
    let joined: BTreeSet<usize> = coordinates.iter().map(|c| first[*c]).collect();
    for first in first {
        if joined.contains(first) {
            *first = least;
        }
    }
}
