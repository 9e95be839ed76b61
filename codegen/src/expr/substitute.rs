//! Substitution of symbols by expressions.

use super::{ExprId, Graph, Node, Symbolic};
use rustc_hash::FxHashMap;

impl<S: Symbolic> Graph<S> {
    /// The expression with symbols replaced; `None` leaves a symbol as it is.
    pub fn substitute(&mut self, e: ExprId, replacement: &dyn Fn(S) -> Option<ExprId>) -> ExprId {
        let mut known: FxHashMap<ExprId, ExprId> = FxHashMap::default();
        for node in self.reachable(&[e]) {
            let replaced = match self.node(node).clone() {
                Node::Symbol(symbol) => replacement(symbol).unwrap_or(node),
                _ => self.rebuild(node, &|child| known[&child]),
            };
            known.insert(node, replaced);
        }
        known[&e]
    }

    /// The node again, made of other children.
    pub fn rebuild(&mut self, e: ExprId, child: &dyn Fn(ExprId) -> ExprId) -> ExprId {
        match self.node(e).clone() {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => e,
            Node::Sum(constant, terms) => {
                let terms: Vec<_> = terms.iter().map(|&(x, w)| (child(x), w)).collect();
                self.weighted_sum(constant, &terms)
            }
            Node::Product(factors) => {
                let factors: Vec<_> = factors.iter().map(|&(x, n)| (child(x), n)).collect();
                self.power_product(&factors)
            }
            Node::Function(function, x) => self.function(function, child(x)),
            Node::Function2(function, x, y) => self.function2(function, child(x), child(y)),
            Node::Select(comparison, [a, b, then, otherwise]) => self.select(
                comparison,
                child(a),
                child(b),
                child(then),
                child(otherwise),
            ),
        }
    }
}
