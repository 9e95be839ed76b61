//! Partial derivatives by coordinates and velocities, and derivatives in time.

use crate::expr::ExprId;
use crate::model::{Graph, Symbol};

/// The symbols of `n` velocities.
pub(super) fn velocities(n: usize) -> impl Iterator<Item = Symbol> + Clone {
    (0..u32::try_from(n).unwrap_or(u32::MAX)).map(Symbol::Velocity)
}

/// The symbols of `n` coordinates.
pub(super) fn coordinates(n: usize) -> impl Iterator<Item = Symbol> + Clone {
    (0..u32::try_from(n).unwrap_or(u32::MAX)).map(Symbol::Coordinate)
}

/// `∂e/∂symbol` for each symbol, in order.
pub(super) fn gradient(
    graph: &mut Graph,
    e: ExprId,
    symbols: impl Iterator<Item = Symbol>,
) -> Vec<ExprId> {
    let present = graph.symbols(e);
    let mut by = |symbol| match present.contains(&symbol) {
        true => graph.differentiate(e, symbol),
        false => graph.integer(0),
    };
    symbols.map(&mut by).collect()
}

/// `Σ eᵢ sᵢ`.
pub(super) fn against(graph: &mut Graph, entries: &[ExprId], symbol: fn(u32) -> Symbol) -> ExprId {
    let mut terms = Vec::new();
    for (i, &entry) in (0..).zip(entries) {
        let factor = graph.symbol(symbol(i));
        terms.push(graph.mul(entry, factor));
    }
    graph.sum(terms)
}

/// How derivatives by all coordinates or velocities are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sweep {
    /// One symbol after the other: the shortest formulas of few bodies.
    Forward,
    /// All at once, from the expression back: formulas that grow no faster than the
    /// expression.
    Back,
}

impl Sweep {
    /// `∂e/∂symbol` for each symbol, in order.
    pub(super) fn gradient(
        self,
        graph: &mut Graph,
        e: ExprId,
        symbols: impl Iterator<Item = Symbol>,
    ) -> Vec<ExprId> {
        if self == Sweep::Forward {
            return gradient(graph, e, symbols);
        }
        let found = graph.gradient(e);
        let zero = graph.integer(0);
        let entry = |symbol| found.get(&symbol).copied().unwrap_or(zero);
        symbols.map(entry).collect()
    }
}

/// The derivatives in time, at frozen velocities, of several expressions.
pub(super) fn rates(graph: &mut Graph, expressions: &[ExprId], n: usize) -> Vec<ExprId> {
    let symbols = coordinates(n).chain([Symbol::Time]);
    let mut flow = graph.frozen_flow(symbols);
    expressions
        .iter()
        .map(|&e| graph.derivative_along(e, &mut flow))
        .collect()
}
