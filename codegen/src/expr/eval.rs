//! Reference evaluation in `f64`: the oracle that programs are checked against.

use super::{ExprId, Graph, Node, Symbolic};
use rustc_hash::FxHashMap;

impl<S: Symbolic> Graph<S> {
    /// The value of an expression, each symbol at the value given for it.
    pub fn evaluate(&self, e: ExprId, values: &dyn Fn(S) -> f64) -> f64 {
        self.evaluate_all(&[e], values)[0]
    }

    /// The values of several expressions; what they share is evaluated once.
    pub fn evaluate_all(&self, roots: &[ExprId], values: &dyn Fn(S) -> f64) -> Vec<f64> {
        let mut known: FxHashMap<ExprId, f64> = FxHashMap::default();
        for e in self.reachable(roots) {
            let value = self.evaluate_node(e, &known, values);
            known.insert(e, value);
        }
        roots.iter().map(|root| known[root]).collect()
    }

    /// The value of an expression that contains no symbol, if it is finite.
    pub fn constant_value(&self, e: ExprId) -> Option<f64> {
        if !self.symbols(e).is_empty() {
            return None;
        }
        Some(self.evaluate(e, &|_| f64::NAN)).filter(|value| value.is_finite())
    }

    fn evaluate_node(
        &self,
        e: ExprId,
        known: &FxHashMap<ExprId, f64>,
        values: &dyn Fn(S) -> f64,
    ) -> f64 {
        match self.node(e) {
            Node::Number(value) => value.to_f64(),
            Node::Pi => std::f64::consts::PI,
            Node::Symbol(symbol) => values(*symbol),
            Node::Sum(constant, terms) => {
                let term = |(x, weight): &(ExprId, super::Number)| weight.to_f64() * known[x];
                terms
                    .iter()
                    .map(term)
                    .fold(constant.to_f64(), |sum, term| sum + term)
            }
            Node::Product(factors) => {
                let power = |(x, exponent): &(ExprId, i32)| known[x].powi(*exponent);
                factors.iter().map(power).product()
            }
            Node::Function(function, x) => function.apply(known[x]),
            Node::Function2(function, x, y) => function.apply(known[x], known[y]),
            Node::Select(comparison, [a, b, then, otherwise]) => {
                known[if comparison.holds(known[a], known[b]) {
                    then
                } else {
                    otherwise
                }]
            }
        }
    }
}
