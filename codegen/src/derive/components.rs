//! Connected components of the constraints and the mass matrix.
//!
//! In:  the constraints `g`, their Jacobian `A` and the velocity `b`; `M`.
//! Out: coordinates that are tied together, and the rows that tie them.
//!
//! Rows of different components have no coordinate in common, neither in their entries nor in
//! what these depend on: the constraint set is the product of those of its components. Nor has
//! `M` an entry between them, so that they are orthogonal in the metric of the kinetic energy:
//! what moves a state onto the set of one takes no momentum from another.

use super::closure::Closure;
use super::equations::{ConnectedComponent, Matrix};
use super::partition::Partition;
use super::properties::is_scleronomic;
use crate::expr::ExprId;
use crate::model::{Constraint, Graph, Node, Symbol};
use std::collections::BTreeSet;

/// The connected components, in the order of their first coordinates; none where all
/// coordinates are in one, or there are no constraints.
pub(super) fn components(
    graph: &Graph,
    constraints: &[Constraint],
    closure: &Closure,
    mass: &Matrix,
) -> Vec<ConnectedComponent> {
    let rows = 0..constraints.len();
    let tied: Vec<BTreeSet<usize>> = rows.map(|row| tied(graph, closure, row)).collect();
    let mut partition = Partition::of(mass.len());
    for coordinates in &tied {
        partition.join(coordinates.iter().copied());
    }
    partition.join_coupled(graph, mass);
    let sets = partition.sets();
    if sets.len() == 1 || constraints.is_empty() {
        return Vec::new();
    }
    let component = |coordinates: Vec<usize>| {
        let is_own = |first: &usize| coordinates.contains(first);
        let rows = (0..tied.len()).filter(|row| tied[*row].first().is_some_and(is_own));
        let rows: Vec<usize> = rows.collect();
        let still = |row: &usize| is_scleronomic(graph, &constraints[*row], closure.residual[*row]);
        ConnectedComponent {
            scleronomic: rows.iter().all(still),
            coordinates,
            rows,
        }
    };
    sets.into_iter().map(component).collect()
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
