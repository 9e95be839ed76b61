//! What the equations tell of a motion before there is one.

use super::equations::Equations;
use crate::expr::{ExprId, Function, Node};
use crate::model::{Constraint, Graph, Mechanism, Symbol};

impl Equations {
    /// Whether `M` is the same at all times and positions.
    pub fn has_constant_mass(&self, graph: &Graph) -> bool {
        let moves = |symbol: &Symbol| matches!(symbol, Symbol::Time | Symbol::Coordinate(_));
        let constant = |entry: &ExprId| !graph.symbols(*entry).iter().any(moves);
        self.inertial().iter().all(constant)
    }

    /// Coordinates that have no unit and are angles: sines are taken of them.
    pub fn unitless_angles(&self, mechanism: &Mechanism) -> Vec<usize> {
        let graph = &mechanism.graph;
        let lacks_unit = |unit: &str| matches!(unit, "" | "1");
        let moves = mechanism.coordinates.len() - mechanism.states;
        let mut angles: Vec<usize> = (0..moves)
            .filter(|j| lacks_unit(&mechanism.coordinates[*j].unit))
            .collect();
        if angles.is_empty() {
            return angles;
        }
        let turned: Vec<ExprId> = graph
            .reachable(&self.expressions())
            .into_iter()
            .filter_map(|e| match graph.node(e) {
                Node::Function(Function::Sin | Function::Cos | Function::Tan, x) => Some(*x),
                _ => None,
            })
            .collect();
        let turned = graph.reachable(&turned);
        angles.retain(|j| {
            let coordinate = Node::Symbol(Symbol::Coordinate(*j as u32));
            turned.iter().any(|e| *graph.node(*e) == coordinate)
        });
        angles
    }

    /// Whether the constraints restrict positions only, to the same ones at all times.
    pub fn are_scleronomic(&self, mechanism: &Mechanism) -> bool {
        let mut rows = mechanism.constraints.iter().zip(&self.residual);
        rows.all(|(row, residual)| is_scleronomic(&mechanism.graph, row, *residual))
    }

    /// Whether nothing is supplied from outside: no power, and no moving constraint.
    pub fn are_conservative(&self, mechanism: &Mechanism) -> bool {
        let still = |e: &ExprId| mechanism.graph.is_zero(*e);
        mechanism.states == 0 && still(&self.energies.power) && self.drift.iter().all(still)
    }
}

/// Whether a constraint restricts positions only, to the same ones at all times.
pub(super) fn is_scleronomic(graph: &Graph, row: &Constraint, residual: ExprId) -> bool {
    row.holonomic && !graph.symbols(residual).contains(&Symbol::Time)
}
