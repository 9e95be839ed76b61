//! What the equations tell of a motion before there is one.

use super::equations::Equations;
use crate::expr::ExprId;
use crate::model::{Constraint, Graph, Mechanism, Symbol};

impl Equations {
    /// Whether `M` is the same at all times and positions.
    pub fn has_constant_mass(&self, graph: &Graph) -> bool {
        let moves = |symbol: &Symbol| matches!(symbol, Symbol::Time | Symbol::Coordinate(_));
        let constant = |entry: &ExprId| !graph.symbols(*entry).iter().any(moves);
        self.inertial().iter().all(constant)
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
