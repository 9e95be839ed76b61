//! What an expression is made of, found once for each node of the graph.

use super::symbol::{Graph, Node, Symbol};
use crate::expr::{ExprId, Function2, Number};

/// What an expression is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Analysis {
    /// Time occurs.
    pub time: bool,
    /// A coordinate occurs.
    pub coordinate: bool,
    /// An external signal occurs.
    pub input: bool,
    /// A state of the first order occurs.
    pub state: bool,
    /// An acceleration, or the rate of a state, occurs.
    pub acceleration: bool,
    /// `abs`, `sign`, `min`, `max` or `if` occurs, and not of constants alone.
    pub kinked: bool,
    /// The degree in the velocities; [`NOT_POLYNOMIAL`] stands for more than two
    /// and for everything that isn't a polynomial in them.
    pub degree: u8,
    /// The value, if no symbol occurs; NaN where it is not defined.
    pub value: Option<f64>,
}

/// The degree of what is no polynomial of degree two or less.
pub const NOT_POLYNOMIAL: u8 = 3;

impl Analysis {
    /// Whether it has the same value all along a run.
    pub fn is_fixed(&self) -> bool {
        let moves = self.coordinate || self.velocity() || self.acceleration;
        !(self.time || moves || self.input || self.state)
    }

    /// Whether a velocity occurs.
    pub fn velocity(&self) -> bool {
        self.degree > 0
    }
}

/// Analysis of the nodes that were asked for, by index.
#[derive(Debug, Default)]
pub struct Analyses {
    /// The velocities from here on are states of the first order.
    pub first_state: Option<u32>,
    known: Vec<Option<Analysis>>,
}

impl Analyses {
    /// The analysis of an expression. What it shares with earlier ones is not
    /// visited again.
    pub fn of(&mut self, graph: &Graph, e: ExprId) -> Analysis {
        self.known.resize(self.known.len().max(graph.len()), None);
        let mut pending = vec![e];
        while let Some(&node) = pending.last() {
            if self.known[node.index()].is_some() {
                pending.pop();
                continue;
            }
            let before = pending.len();
            let children = graph.node(node).children();
            pending.extend(
                children
                    .into_iter()
                    .filter(|c| self.known[c.index()].is_none()),
            );
            if pending.len() == before {
                self.known[node.index()] = Some(self.derive(graph.node(node)));
                pending.pop();
            }
        }
        self.get(e)
    }

    fn get(&self, e: ExprId) -> Analysis {
        self.known
            .get(e.index())
            .copied()
            .flatten()
            .unwrap_or_default()
    }

    fn derive(&self, node: &Node) -> Analysis {
        let mut analysis = self.merge(node);
        match node {
            Node::Symbol(Symbol::Time) => analysis.time = true,
            Node::Symbol(Symbol::Coordinate(_)) => analysis.coordinate = true,
            Node::Symbol(Symbol::Velocity(i)) => match self.first_state {
                Some(first) if *i >= first => analysis.state = true,
                _ => analysis.degree = 1,
            },
            Node::Symbol(Symbol::Input(_)) => analysis.input = true,
            Node::Symbol(Symbol::Acceleration(_)) => analysis.acceleration = true,
            Node::Product(factors) => analysis.degree = self.product_degree(factors),
            Node::Function(function, _) => {
                analysis.kinked |= !function.is_differentiable();
                analysis.degree = opaque(analysis.degree);
            }
            Node::Function2(function, ..) => {
                analysis.kinked |= matches!(function, Function2::Min | Function2::Max);
                analysis.degree = opaque(analysis.degree);
            }
            Node::Select(test, _) => {
                analysis.kinked |= !test.smooth;
                analysis.degree = opaque(analysis.degree);
            }
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Sum(..) => {}
        }
        analysis.value = self.value(node);
        // A constant is smooth, whatever it is made of.
        analysis.kinked &= analysis.value.is_none();
        analysis
    }

    fn merge(&self, node: &Node) -> Analysis {
        let mut all = Analysis::default();
        for child in node.children() {
            let analysis = self.get(child);
            all.time |= analysis.time;
            all.coordinate |= analysis.coordinate;
            all.input |= analysis.input;
            all.state |= analysis.state;
            all.acceleration |= analysis.acceleration;
            all.kinked |= analysis.kinked;
            all.degree = all.degree.max(analysis.degree);
        }
        all
    }

    fn product_degree(&self, factors: &[(ExprId, i32)]) -> u8 {
        let mut degree = 0_i64;
        for (base, exponent) in factors {
            match self.get(*base).degree {
                0 => {}
                _ if *exponent < 0 => return NOT_POLYNOMIAL,
                inner => degree += i64::from(inner) * i64::from(*exponent),
            }
        }
        u8::try_from(degree.min(i64::from(NOT_POLYNOMIAL))).unwrap_or(NOT_POLYNOMIAL)
    }

    fn value(&self, node: &Node) -> Option<f64> {
        let of = |e: &ExprId| self.get(*e).value;
        match node {
            Node::Number(number) => Some(number.to_f64()),
            Node::Pi => Some(std::f64::consts::PI),
            Node::Symbol(_) => None,
            Node::Sum(constant, terms) => {
                let add = |sum, term: &(ExprId, Number)| Some(sum + term.1.to_f64() * of(&term.0)?);
                terms.iter().try_fold(constant.to_f64(), add)
            }
            Node::Product(factors) => {
                let multiply =
                    |product, (base, power): &(ExprId, i32)| Some(product * of(base)?.powi(*power));
                factors.iter().try_fold(1.0, multiply)
            }
            Node::Function(function, x) => Some(function.apply(of(x)?)),
            Node::Function2(function, x, y) => Some(function.apply(of(x)?, of(y)?)),
            Node::Select(comparison, [a, b, then, otherwise]) => {
                let holds = comparison.holds(of(a)?, of(b)?);
                if holds { of(then) } else { of(otherwise) }
            }
        }
    }
}

fn opaque(degree: u8) -> u8 {
    if degree == 0 { 0 } else { NOT_POLYNOMIAL }
}
