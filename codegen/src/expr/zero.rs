//! Whether an expression is zero wherever it is defined.
//!
//! In:  an expression.
//! Out: whether it is zero, but for round-off, at random values of its symbols.
//!
//! An analytic function that vanishes at random points vanishes everywhere, with probability
//! one (Schwartz 1980, for polynomials). What is round-off is told by a running error bound
//! (Wilkinson 1963), carried along with each value.

use super::{ExprId, Function, Function2, Graph, Node, Number, Symbolic};
use rustc_hash::{FxBuildHasher, FxHashMap};
use std::hash::BuildHasher;

/// Random points that are tried.
const POINTS: u32 = 8;
/// At how many of them an expression must be defined, and zero.
const ENOUGH: usize = 3;
/// How much larger than the bound of its error, which is one of first order, a value may be.
const MARGIN: f64 = 4.0;

/// A value and a bound of its rounding error.
#[derive(Clone, Copy, Debug)]
struct Bounded {
    value: f64,
    error: f64,
}

impl Bounded {
    const UNKNOWN: Bounded = Bounded {
        value: f64::NAN,
        error: f64::NAN,
    };

    /// The result of an operation, rounded, that errors of its operands change so much.
    fn rounded(value: f64, error: f64) -> Self {
        Self {
            value,
            error: error + f64::EPSILON * value.abs(),
        }
    }

    fn plus(self, other: Self) -> Self {
        Self::rounded(self.value + other.value, self.error + other.error)
    }

    fn times(self, other: Self) -> Self {
        let error = self.value.abs() * other.error + other.value.abs() * self.error;
        Self::rounded(self.value * other.value, error)
    }

    /// A function of it.
    fn through(self, function: impl Fn(f64) -> f64) -> Self {
        let value = function(self.value);
        let beside = [self.value - self.error, self.value + self.error];
        let changes = beside.map(|x| (function(x) - value).abs());
        Self::rounded(
            value,
            changes[0].max(changes[1]) + f64::EPSILON * value.abs(),
        )
    }

    /// Whether it is zero, but for round-off; `None` where it is not defined.
    fn is_zero(self) -> Option<bool> {
        let defined = self.value.is_finite() && self.error.is_finite();
        defined.then_some(self.value.abs() <= MARGIN * self.error)
    }
}

impl<S: Symbolic> Graph<S> {
    /// Whether an expression is zero for all values of its symbols for which it is defined. What
    /// is not analytic, or hardly ever defined, is not called zero.
    pub fn is_zero_everywhere(&self, e: ExprId) -> bool {
        let nodes = self.reachable(&[e]);
        let points = (0..POINTS).filter_map(|point| self.at_random(&nodes, point).is_zero());
        let mut zeros = 0;
        for zero in points {
            if !zero {
                return false;
            }
            zeros += 1;
        }
        zeros >= ENOUGH
    }

    /// The value of the last of some nodes, of which each comes behind its operands.
    fn at_random(&self, nodes: &[ExprId], point: u32) -> Bounded {
        let mut known: FxHashMap<ExprId, Bounded> = FxHashMap::default();
        let mut last = Bounded::UNKNOWN;
        for &e in nodes {
            last = self.bounded(e, &known, point);
            known.insert(e, last);
        }
        last
    }

    fn bounded(&self, e: ExprId, known: &FxHashMap<ExprId, Bounded>, point: u32) -> Bounded {
        let number = |number: &Number| Bounded::rounded(number.to_f64(), 0.0);
        match self.node(e) {
            Node::Number(value) => number(value),
            Node::Pi => Bounded::rounded(std::f64::consts::PI, 0.0),
            Node::Symbol(symbol) => Bounded {
                value: random(&(*symbol, point)),
                error: 0.0,
            },
            Node::Sum(constant, terms) => {
                let terms = terms
                    .iter()
                    .map(|(x, weight)| known[x].times(number(weight)));
                terms.fold(number(constant), Bounded::plus)
            }
            Node::Product(factors) => {
                let power = |(x, exponent): &(ExprId, i32)| known[x].through(|x| x.powi(*exponent));
                let powers = factors.iter().map(power);
                powers.reduce(Bounded::times).unwrap_or(Bounded::UNKNOWN)
            }
            // What is not analytic may be zero here and something else there.
            Node::Function(Function::Abs | Function::Sign | Function::Table(_), _)
            | Node::Function2(Function2::Min | Function2::Max, ..)
            | Node::Select(..) => Bounded::UNKNOWN,
            Node::Function(function, x) => known[x].through(|x| function.apply(x)),
            Node::Function2(function, x, y) => {
                let (x, y) = (known[x], known[y]);
                let by_first = x.through(|x| function.apply(x, y.value));
                let by_second = y.through(|y| function.apply(x.value, y));
                Bounded::rounded(by_first.value, by_first.error + by_second.error)
            }
        }
    }
}

/// A number between −1 and 1.
fn random<T: std::hash::Hash>(what: &T) -> f64 {
    // The upper bits of the hash are those that are mixed well.
    let bits = FxBuildHasher.hash_one(what) >> 32;
    bits as f64 / f64::from(1_u32 << 31) - 1.0
}
