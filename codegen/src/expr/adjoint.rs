//! All derivatives of one expression, in one sweep from it down to its symbols.
//!
//! In:  an expression, or several, each with the rate of the whole by it.
//! Out: the rates of the whole by the symbols that vary.
//!
//! Each expression on the way learns how fast the whole changes with it, once, whatever the
//! number of symbols. What the whole shares, these rates share: the momenta of a chain of
//! bodies are sums from the last body back, not a sum over all pairs of bodies.
//!
//! Source: Griewank & Walther, Evaluating Derivatives (2008), section 3.2.

use super::{Direction, ExprId, Graph, Node, Number, Symbolic};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// What the rates of expressions are sums of, as far as it is known.
type Rates = FxHashMap<ExprId, Vec<(ExprId, Number)>>;

impl<S: Symbolic> Graph<S> {
    /// `Σ r ∂e/∂symbol` over expressions `e` with rates `r`, for all symbols in them that
    /// vary.
    pub fn adjoints(
        &mut self,
        rated: &[(ExprId, ExprId)],
        varies: &dyn Fn(S) -> bool,
    ) -> BTreeMap<S, ExprId> {
        let roots: Vec<ExprId> = rated.iter().map(|(e, _)| *e).collect();
        let nodes = self.reachable(&roots);
        let mut moves: FxHashMap<ExprId, bool> = FxHashMap::default();
        for &node in &nodes {
            let any = match self.node(node) {
                Node::Symbol(symbol) => varies(*symbol),
                other => other.children().iter().any(|child| moves[child]),
            };
            moves.insert(node, any);
        }
        let mut rates = Rates::default();
        for &(e, rate) in rated {
            rates.entry(e).or_default().push((rate, Number::ONE));
        }
        let mut found = BTreeMap::new();
        for &node in nodes.iter().rev().filter(|node| moves[node]) {
            let Some(terms) = rates.remove(&node) else {
                continue;
            };
            let rate = self.weighted_sum(Number::ZERO, &terms);
            if let Node::Symbol(symbol) = self.node(node) {
                found.insert(*symbol, rate);
            }
            self.pass_on(node, rate, &mut |child, share| {
                if moves[&child] {
                    rates.entry(child).or_default().push(share);
                }
            });
        }
        found
    }

    /// Shows what the rate of an expression contributes to those of its parts.
    fn pass_on(&mut self, e: ExprId, rate: ExprId, show: &mut dyn FnMut(ExprId, (ExprId, Number))) {
        match self.node(e).clone() {
            Node::Sum(_, terms) => {
                for &(term, weight) in &terms {
                    show(term, (rate, weight));
                }
            }
            Node::Product(factors) => {
                for (i, &(base, exponent)) in factors.iter().enumerate() {
                    let mut rest = factors.to_vec();
                    rest[i].1 -= 1;
                    rest.push((rate, 1));
                    let share = self.power_product(&rest);
                    show(base, (share, Number::integer(i64::from(exponent))));
                }
            }
            other => {
                let mut parts = other.children();
                parts.sort_unstable();
                parts.dedup();
                for part in parts {
                    let slope = self.slope_by(e, part);
                    let share = self.mul(rate, slope);
                    show(part, (share, Number::ONE));
                }
            }
        }
    }

    /// How an expression changes with one of those that it is made of.
    fn slope_by(&mut self, e: ExprId, part: ExprId) -> ExprId {
        let parts = self.node(e).children();
        let [zero, one] = [0, 1].map(|value| self.integer(value));
        let rates = parts
            .into_iter()
            .map(|other| (other, if other == part { one } else { zero }));
        let mut direction = Direction::knowing(rates);
        self.derivative_along(e, &mut direction)
    }
}
