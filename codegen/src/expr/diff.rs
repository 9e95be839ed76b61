//! Derivatives: partial ones, and ones along a direction.
//!
//! Both are one forward pass over the shared graph (a seed for each symbol, the
//! chain rule at each node), memoised node by node, so what the expression
//! shares its derivative shares too.

use super::graph::{Memo, mark};
use super::{ExprId, Function, Function2, Graph, Node, Number, Symbolic};
use std::hash::Hash;

/// A derivative along given seeds `dsymbol`; reuse it to reuse its memory.
#[derive(Debug)]
pub struct Direction<S> {
    seeds: Vec<(S, ExprId)>,
    memo: Memo,
    /// The marks of all symbols that change; what has none of them does not.
    marks: u64,
}

impl<S: Hash> Default for Direction<S> {
    fn default() -> Self {
        Self::new(Vec::new())
    }
}

impl<S: Hash> Direction<S> {
    /// The direction in which each symbol changes at the rate beside it.
    pub fn new(seeds: Vec<(S, ExprId)>) -> Self {
        let marks = seeds.iter().map(|(symbol, _)| mark(symbol));
        Self {
            marks: marks.fold(0, |all, mark| all | mark),
            seeds,
            memo: Memo::default(),
        }
    }

    /// The direction in which these expressions change at the rates beside them.
    pub(super) fn knowing(rates: impl Iterator<Item = (ExprId, ExprId)>) -> Self {
        Self {
            seeds: Vec::new(),
            memo: rates.collect(),
            marks: u64::MAX,
        }
    }
}

impl<S: Symbolic> Graph<S> {
    /// `∂e/∂symbol`.
    pub fn differentiate(&mut self, e: ExprId, by: S) -> ExprId {
        let one = self.integer(1);
        let memo = self.partials.remove(&by).unwrap_or_default();
        let mut direction = Direction {
            memo,
            ..Direction::new(vec![(by, one)])
        };
        let derivative = self.derivative_along(e, &mut direction);
        self.partials.insert(by, direction.memo);
        derivative
    }

    /// `Σ ∂e/∂symbol · dsymbol` over the seeds of a direction.
    pub fn derivative_along(&mut self, e: ExprId, direction: &mut Direction<S>) -> ExprId {
        // Children come first.
        let is_known =
            |e: ExprId| direction.memo.contains_key(&e) || !self.is_marked(e, direction.marks);
        for node in self.reachable_but(&[e], &is_known) {
            let derivative = self.chain(node, direction);
            direction.memo.insert(node, derivative);
        }
        let zero = self.integer(0);
        direction.memo.get(&e).copied().unwrap_or(zero)
    }

    /// The chain rule at one node whose children are done, as far as they change.
    fn chain(&mut self, e: ExprId, direction: &Direction<S>) -> ExprId {
        let zero = self.integer(0);
        let d = |x: &ExprId| direction.memo.get(x).copied().unwrap_or(zero);
        match self.node(e).clone() {
            Node::Number(_) | Node::Pi => zero,
            Node::Symbol(symbol) => {
                let seed = direction.seeds.iter().find(|(s, _)| *s == symbol);
                seed.map_or(zero, |(_, rate)| *rate)
            }
            Node::Sum(_, terms) => {
                let terms: Vec<_> = terms.iter().map(|(x, weight)| (d(x), *weight)).collect();
                self.weighted_sum(Number::ZERO, &terms)
            }
            Node::Product(factors) => self.product_rule(&factors, &d),
            Node::Function(function, x) if self.is_zero(d(&x)) => {
                let _ = function;
                zero
            }
            Node::Function(function, x) => {
                let outer = self.slope(function, x, e);
                self.mul(outer, d(&x))
            }
            Node::Function2(function, x, y) => self.slope2(function, [x, y], e, [d(&x), d(&y)]),
            Node::Select(comparison, [a, b, then, otherwise]) => {
                let (then, otherwise) = (d(&then), d(&otherwise));
                self.select(comparison, a, b, then, otherwise)
            }
        }
    }

    fn product_rule(&mut self, factors: &[(ExprId, i32)], d: &dyn Fn(&ExprId) -> ExprId) -> ExprId {
        let mut terms = Vec::new();
        for (i, (base, exponent)) in factors.iter().enumerate() {
            let rate = d(base);
            if self.is_zero(rate) {
                continue;
            }
            let mut rest = factors.to_vec();
            rest[i].1 -= 1;
            rest.push((rate, 1));
            let term = self.power_product(&rest);
            terms.push((term, Number::integer(i64::from(*exponent))));
        }
        self.weighted_sum(Number::ZERO, &terms)
    }

    /// `f'(x)`, where `value` is `f(x)`.
    fn slope(&mut self, function: Function, x: ExprId, value: ExprId) -> ExprId {
        let one = self.integer(1);
        match function {
            Function::Sin => self.function(Function::Cos, x),
            Function::Cos => {
                let sin = self.function(Function::Sin, x);
                self.neg(sin)
            }
            Function::Tan | Function::Tanh => {
                let square = self.powi(value, 2);
                if function == Function::Tan {
                    self.add(one, square)
                } else {
                    self.sub(one, square)
                }
            }
            Function::Asin | Function::Acos => {
                let square = self.powi(x, 2);
                let inside = self.sub(one, square);
                let root = self.function(Function::Sqrt, inside);
                let slope = self.powi(root, -1);
                if function == Function::Asin {
                    slope
                } else {
                    self.neg(slope)
                }
            }
            Function::Atan => {
                let square = self.powi(x, 2);
                let below = self.add(one, square);
                self.powi(below, -1)
            }
            Function::Sinh => self.function(Function::Cosh, x),
            Function::Cosh => self.function(Function::Sinh, x),
            Function::Exp => value,
            Function::Ln => self.powi(x, -1),
            Function::Sqrt => {
                let inverse = self.powi(value, -1);
                self.scale(inverse, Number::Exact(1, 2))
            }
            Function::Abs => self.function(Function::Sign, x),
            Function::Sign => self.integer(0),
            Function::Table(lookup) => match lookup.slope() {
                Some(slope) => self.function(Function::Table(slope), x),
                None => self.integer(0),
            },
        }
    }

    fn slope2(
        &mut self,
        function: Function2,
        [x, y]: [ExprId; 2],
        value: ExprId,
        [dx, dy]: [ExprId; 2],
    ) -> ExprId {
        match function {
            Function2::Atan2 => {
                let squares = [self.powi(x, 2), self.powi(y, 2)];
                let below = self.sum(squares);
                let (left, right) = (self.mul(y, dx), self.mul(x, dy));
                let above = self.sub(left, right);
                self.div(above, below)
            }
            Function2::Min => self.select(super::Comparison::Less, y, x, dy, dx),
            Function2::Max => self.select(super::Comparison::Less, x, y, dy, dx),
            Function2::Pow => {
                let over = self.div(value, x);
                let by_base = self.product([y, over, dx]);
                if self.is_zero(dy) {
                    return by_base;
                }
                let log = self.function(Function::Ln, x);
                let by_exponent = self.product([log, value, dy]);
                self.add(by_base, by_exponent)
            }
        }
    }
}
