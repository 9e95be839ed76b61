//! What expressions are made of.

use super::bits::Growing;
use super::{ExprId, Function, Function2, Graph, Node, Number, Symbolic};
use std::collections::BTreeSet;

impl<S> Node<S> {
    /// The expressions it is made of.
    pub fn children(&self) -> Vec<ExprId> {
        let mut children = Vec::new();
        self.for_each_child(&mut |child| children.push(child));
        children
    }

    /// Shows the expressions it is made of, in order.
    pub(crate) fn for_each_child(&self, show: &mut dyn FnMut(ExprId)) {
        match self {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => {}
            Node::Sum(_, terms) => {
                for (term, _) in terms {
                    show(*term);
                }
            }
            Node::Product(factors) => {
                for (base, _) in factors {
                    show(*base);
                }
            }
            Node::Function(_, x) => show(*x),
            Node::Function2(_, x, y) => {
                show(*x);
                show(*y);
            }
            Node::Select(_, parts) => {
                for part in parts {
                    show(*part);
                }
            }
        }
    }
}

impl<S: Symbolic> Graph<S> {
    /// Every expression that some roots are made of, in an order of evaluation.
    pub fn reachable(&self, roots: &[ExprId]) -> Vec<ExprId> {
        self.reachable_but(roots, &|_| false)
    }

    /// Every expression that some roots are made of, in an order of evaluation, but for those that
    /// are known and those that only known ones are made of.
    pub(super) fn reachable_but(
        &self,
        roots: &[ExprId],
        known: &dyn Fn(ExprId) -> bool,
    ) -> Vec<ExprId> {
        let mut seen = Growing::below(self.len());
        let mut pending = Vec::new();
        for &root in roots {
            if !known(root) && seen.insert(root.index()) {
                pending.push(root);
            }
        }
        while let Some(e) = pending.pop() {
            self.node(e).for_each_child(&mut |child| {
                if !known(child) && seen.insert(child.index()) {
                    pending.push(child);
                }
            });
        }
        seen.ascending().into_iter().map(ExprId::at).collect()
    }

    /// How many nodes it takes to write expressions out, one number for each; a part that
    /// is used twice counts twice.
    pub fn lengths(&self, roots: &[ExprId]) -> Vec<u64> {
        let mut lengths = vec![0_u64; self.len()];
        for e in self.reachable(roots) {
            let mut length = 1_u64;
            self.node(e).for_each_child(&mut |child| {
                length = length.saturating_add(lengths[child.index()]);
            });
            lengths[e.index()] = length;
        }
        roots.iter().map(|root| lengths[root.index()]).collect()
    }

    /// The numbers that expressions are made of, but for those of tables.
    pub fn numbers(&self, roots: &[ExprId]) -> Vec<Number> {
        let mut numbers = Vec::new();
        for e in self.reachable(roots) {
            numbers.extend(self.own_numbers(e));
        }
        numbers
    }

    /// Whether the numbers that expressions are made of are finite, also those of tables.
    pub fn has_finite_numbers(&self, roots: &[ExprId]) -> bool {
        let is_finite = |e: ExprId| match self.node(e) {
            Node::Function(Function::Table(lookup), _) => {
                let pieces = &lookup.table.pieces;
                pieces.iter().flatten().all(|number| number.is_finite())
            }
            _ => self.own_numbers(e).all(|number| number.is_finite()),
        };
        self.reachable(roots).into_iter().all(is_finite)
    }

    /// The numbers in a node.
    fn own_numbers(&self, e: ExprId) -> impl Iterator<Item = Number> {
        let (number, terms) = match self.node(e) {
            Node::Number(number) => (Some(*number), &[][..]),
            Node::Sum(constant, terms) => (Some(*constant), &terms[..]),
            _ => (None, &[][..]),
        };
        number
            .into_iter()
            .chain(terms.iter().map(|(_, weight)| *weight))
    }

    /// Every symbol an expression is made of.
    pub fn symbols(&self, e: ExprId) -> BTreeSet<S> {
        let symbol = |e: ExprId| match self.node(e) {
            Node::Symbol(symbol) => Some(*symbol),
            _ => None,
        };
        self.reachable(&[e])
            .into_iter()
            .filter_map(symbol)
            .collect()
    }

    /// Whether an expression is made of a symbol among others.
    pub fn depends_on(&self, e: ExprId, symbol: S) -> bool {
        self.symbols(e).contains(&symbol)
    }

    /// Whether an expression contains `abs`, `sign`, `min`, `max` or `if`.
    pub fn contains_nondifferentiable(&self, e: ExprId) -> bool {
        self.reachable(&[e])
            .into_iter()
            .any(|e| match self.node(e) {
                Node::Function(function, _) => !function.is_differentiable(),
                Node::Function2(function, ..) => {
                    matches!(function, Function2::Min | Function2::Max)
                }
                Node::Select(test, _) => !test.smooth,
                _ => false,
            })
    }
}
