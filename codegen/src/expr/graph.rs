//! Hash-consed expressions: equal expressions are one node.
//!
//! In:  symbols and numbers, combined by the constructors.
//! Out: [`ExprId`]s. Children have smaller ids than their parents, so ascending
//!      order is an order of evaluation.
//!
//! Canonical form: a sum is a constant and terms with numeric coefficients, like
//! terms collected; a product is a list of bases with whole exponents, without a
//! coefficient; both sorted by id. A sum inside a sum stays whole: what the
//! description shares stays shared. Products are flattened, never expanded.

use super::{Function, Function2, Number, Test};
use rustc_hash::{FxBuildHasher, FxHashMap};
use std::collections::BTreeMap;
use std::collections::hash_map::Entry;
use std::fmt::Debug;
use std::hash::{BuildHasher, Hash};

/// An expression of a graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ExprId(u32);

impl ExprId {
    /// Its place in the graph, in order of creation.
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The expression at a place.
    pub(super) fn at(index: usize) -> Self {
        ExprId(u32::try_from(index).unwrap_or(u32::MAX))
    }
}

/// What an expression may depend on. The graph knows of it only that there are several.
pub trait Symbolic: Copy + Debug + Eq + Hash + Ord {
    /// Whether its name is a letter with an accent in LaTeX, which exponents stand above.
    fn has_accent(self) -> bool;
}

/// One node of the graph.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Node<S> {
    /// A number.
    Number(Number),
    /// The ratio of a circle's circumference to its diameter.
    Pi,
    /// A symbol.
    Symbol(S),
    /// `constant + Σ coefficient · term`; at least one term, and not just `1 · x`.
    Sum(Number, Box<[(ExprId, Number)]>),
    /// `Π base ^ exponent`; exponents not zero, and not just `x ^ 1`.
    Product(Box<[(ExprId, i32)]>),
    /// A function of one argument.
    Function(Function, ExprId),
    /// A function of two arguments.
    Function2(Function2, ExprId, ExprId),
    /// `if left ⋈ right then … else …`, where that makes a difference.
    Select(Test, [ExprId; 4]),
}

/// The mark of a symbol, one bit; others may have the same.
pub(super) fn mark<S: Hash>(symbol: &S) -> u64 {
    // The upper bits of the hash are those that are mixed well.
    1 << (FxBuildHasher.hash_one(symbol) >> 58)
}

/// Derivatives that are known, by what they are derivatives of.
pub(super) type Memo = FxHashMap<ExprId, ExprId>;

/// Expressions, each once, over symbols of some kind.
#[derive(Clone, Debug)]
pub struct Graph<S> {
    nodes: Vec<Node<S>>,
    /// Of each node, the marks of all symbols that it is made of.
    marks: Vec<u64>,
    index: FxHashMap<Node<S>, ExprId>,
    pub(super) partials: FxHashMap<S, Memo>,
}

impl<S> Default for Graph<S> {
    fn default() -> Self {
        Self {
            nodes: Vec::new(),
            marks: Vec::new(),
            index: FxHashMap::default(),
            partials: FxHashMap::default(),
        }
    }
}

impl<S: Symbolic> Graph<S> {
    /// An empty graph.
    pub fn new() -> Self {
        Self::default()
    }

    /// The node of an expression.
    pub fn node(&self, e: ExprId) -> &Node<S> {
        &self.nodes[e.index()]
    }

    /// The number of distinct expressions.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there is no expression yet.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    fn intern(&mut self, node: Node<S>) -> ExprId {
        match self.index.entry(node) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(free) => {
                let id = ExprId::at(self.nodes.len());
                let mut marks = match free.key() {
                    Node::Symbol(symbol) => mark(symbol),
                    _ => 0,
                };
                let known = &self.marks;
                free.key()
                    .for_each_child(&mut |child| marks |= known[child.index()]);
                self.marks.push(marks);
                self.nodes.push(free.key().clone());
                *free.insert(id)
            }
        }
    }

    /// Whether an expression is made of symbols with some of these marks: if not, it is made of
    /// none of the symbols that have them.
    pub(super) fn is_marked(&self, e: ExprId, marks: u64) -> bool {
        self.marks[e.index()] & marks != 0
    }

    /// A number.
    pub fn number(&mut self, value: Number) -> ExprId {
        self.intern(Node::Number(value))
    }

    /// A whole number.
    pub fn integer(&mut self, value: i64) -> ExprId {
        self.number(Number::integer(value))
    }

    /// π.
    pub fn pi(&mut self) -> ExprId {
        self.intern(Node::Pi)
    }

    /// A symbol.
    pub fn symbol(&mut self, symbol: S) -> ExprId {
        self.intern(Node::Symbol(symbol))
    }

    /// `Σ terms`, like terms collected.
    pub fn sum(&mut self, terms: impl IntoIterator<Item = ExprId>) -> ExprId {
        let weighted: Vec<_> = terms.into_iter().map(|term| (term, Number::ONE)).collect();
        self.weighted_sum(Number::ZERO, &weighted)
    }

    /// `constant + Σ coefficient · term`, like terms collected.
    pub fn weighted_sum(&mut self, constant: Number, terms: &[(ExprId, Number)]) -> ExprId {
        let mut constant = constant;
        let mut collected: BTreeMap<ExprId, Number> = BTreeMap::new();
        for &(term, weight) in terms {
            self.collect(term, weight, &mut constant, &mut collected);
        }
        collected.retain(|_, weight| !weight.is_zero());
        let terms: Vec<_> = collected.into_iter().collect();
        match terms[..] {
            [] => self.number(constant),
            [(term, weight)] if weight.is_one() && constant.is_zero() => term,
            _ => self.intern(Node::Sum(constant, terms.into())),
        }
    }

    /// Adds `weight · term` to a sum. A sum of one term is taken apart, a longer
    /// one stays whole.
    fn collect(
        &self,
        term: ExprId,
        weight: Number,
        constant: &mut Number,
        terms: &mut BTreeMap<ExprId, Number>,
    ) {
        let mut add = |term, weight: Number| {
            let entry = terms.entry(term).or_insert(Number::ZERO);
            *entry = *entry + weight;
        };
        match self.node(term) {
            Node::Number(value) => *constant = *constant + *value * weight,
            Node::Sum(inner, parts) if parts.len() == 1 => {
                *constant = *constant + *inner * weight;
                add(parts[0].0, parts[0].1 * weight);
            }
            _ => add(term, weight),
        }
    }

    /// `a + b`.
    pub fn add(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.sum([a, b])
    }

    /// `a − b`.
    pub fn sub(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.weighted_sum(Number::ZERO, &[(a, Number::ONE), (b, Number::MINUS_ONE)])
    }

    /// `−a`.
    pub fn neg(&mut self, a: ExprId) -> ExprId {
        self.scale(a, Number::MINUS_ONE)
    }

    /// `factor · a`.
    pub fn scale(&mut self, a: ExprId, factor: Number) -> ExprId {
        self.weighted_sum(Number::ZERO, &[(a, factor)])
    }

    /// `Π factors`, powers of equal bases collected.
    pub fn product(&mut self, factors: impl IntoIterator<Item = ExprId>) -> ExprId {
        let powers: Vec<_> = factors.into_iter().map(|factor| (factor, 1)).collect();
        self.power_product(&powers)
    }

    /// `a · b`.
    pub fn mul(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.product([a, b])
    }

    /// `a / b`. Where `b` is the number zero the result is not finite.
    pub fn div(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.power_product(&[(a, 1), (b, -1)])
    }

    /// `base ^ exponent`, whole exponent.
    pub fn powi(&mut self, base: ExprId, exponent: i32) -> ExprId {
        self.power_product(&[(base, exponent)])
    }

    /// `Π base ^ exponent`, numeric coefficients moved in front.
    pub fn power_product(&mut self, factors: &[(ExprId, i32)]) -> ExprId {
        let mut coefficient = Number::ONE;
        let mut powers: BTreeMap<ExprId, i32> = BTreeMap::new();
        let mut pending: Vec<(ExprId, i32)> = factors.to_vec();
        while let Some((base, exponent)) = pending.pop() {
            if exponent != 0 {
                self.multiply(base, exponent, &mut coefficient, &mut powers, &mut pending);
            }
        }
        powers.retain(|_, exponent| *exponent != 0);
        if coefficient.is_zero() {
            return self.number(Number::ZERO);
        }
        let powers: Vec<_> = powers.into_iter().collect();
        let product = match powers[..] {
            [] => return self.number(coefficient),
            [(base, 1)] => base,
            _ => self.intern(Node::Product(powers.into())),
        };
        self.scale(product, coefficient)
    }

    /// Takes one power of a product apart, as far as its form allows.
    fn multiply(
        &mut self,
        base: ExprId,
        exponent: i32,
        coefficient: &mut Number,
        powers: &mut BTreeMap<ExprId, i32>,
        pending: &mut Vec<(ExprId, i32)>,
    ) {
        let mut scale = |value: Number| {
            let power = value.powi(exponent).unwrap_or(Number::float(f64::INFINITY));
            *coefficient = *coefficient * power;
        };
        match self.node(base).clone() {
            Node::Number(value) => scale(value),
            Node::Product(inner) => {
                pending.extend(inner.iter().map(|&(b, e)| (b, e.saturating_mul(exponent))));
            }
            Node::Sum(constant, terms) if constant.is_zero() && terms.len() == 1 => {
                scale(terms[0].1);
                pending.push((terms[0].0, exponent));
            }
            Node::Sum(constant, terms) if terms[0].1.is_negative() => {
                scale(Number::MINUS_ONE);
                let opposite: Vec<_> = terms.iter().map(|&(t, w)| (t, -w)).collect();
                let positive = self.weighted_sum(-constant, &opposite);
                bump(powers, positive, exponent);
            }
            Node::Function(Function::Sqrt, inside) => {
                let total = powers.remove(&base).unwrap_or(0).saturating_add(exponent);
                pending.push((inside, total / 2));
                bump(powers, base, total % 2);
            }
            _ => bump(powers, base, exponent),
        }
    }

    /// `base ^ exponent` for any exponent: whole powers stay products, halves
    /// become square roots, the rest is left to the power function.
    pub fn pow(&mut self, base: ExprId, exponent: ExprId) -> ExprId {
        let halves = self.as_number(exponent).map(|n| n * Number::integer(2));
        match halves
            .and_then(Number::as_integer)
            .and_then(|h| i32::try_from(h).ok())
        {
            Some(halves) if halves % 2 == 0 => self.powi(base, halves / 2),
            Some(halves) => {
                let root = self.function(Function::Sqrt, base);
                self.powi(root, halves)
            }
            None => self.function2(Function2::Pow, base, exponent),
        }
    }

    /// A function of one argument, folded where the value is exact and with the
    /// sign of the argument moved out of even and odd functions.
    pub fn function(&mut self, function: Function, x: ExprId) -> ExprId {
        if let Some(value) = self.as_number(x).and_then(|n| exact_value(function, n)) {
            return self.number(value);
        }
        let parity = match function {
            Function::Cos | Function::Cosh | Function::Abs => 1,
            Function::Exp | Function::Ln | Function::Sqrt | Function::Acos | Function::Table(_) => {
                0
            }
            _ => -1,
        };
        if parity == 0 || !self.leads_negative(x) {
            return self.intern(Node::Function(function, x));
        }
        let opposite = self.negated_inside(x);
        let value = self.intern(Node::Function(function, opposite));
        if parity > 0 { value } else { self.neg(value) }
    }

    /// `−x` with the sign carried to every term of a sum.
    fn negated_inside(&mut self, x: ExprId) -> ExprId {
        match self.node(x).clone() {
            Node::Sum(constant, terms) => {
                let terms: Vec<_> = terms.iter().map(|&(t, w)| (t, -w)).collect();
                self.weighted_sum(-constant, &terms)
            }
            _ => self.neg(x),
        }
    }

    fn leads_negative(&self, x: ExprId) -> bool {
        match self.node(x) {
            Node::Number(value) => value.is_negative(),
            Node::Sum(_, terms) => terms[0].1.is_negative(),
            _ => false,
        }
    }

    /// A function of two arguments; of two rational numbers one is the smaller.
    pub fn function2(&mut self, function: Function2, x: ExprId, y: ExprId) -> ExprId {
        if let Some(x_is_less) = self.is_less(x, y) {
            match function {
                Function2::Min => return if x_is_less { x } else { y },
                Function2::Max => return if x_is_less { y } else { x },
                Function2::Atan2 | Function2::Pow => {}
            }
        }
        self.intern(Node::Function2(function, x, y))
    }

    /// Whether one number is less than another, where both are rational.
    fn is_less(&self, x: ExprId, y: ExprId) -> Option<bool> {
        let difference = self.as_number(x)? + -self.as_number(y)?;
        matches!(difference, Number::Exact(..)).then(|| difference.is_negative())
    }

    /// `if left ⋈ right then … else …`.
    pub fn select(
        &mut self,
        test: impl Into<Test>,
        left: ExprId,
        right: ExprId,
        then: ExprId,
        otherwise: ExprId,
    ) -> ExprId {
        if then == otherwise {
            return then;
        }
        self.intern(Node::Select(test.into(), [left, right, then, otherwise]))
    }

    /// The number that an expression is, if it is one.
    pub fn as_number(&self, e: ExprId) -> Option<Number> {
        match self.node(e) {
            Node::Number(value) => Some(*value),
            _ => None,
        }
    }

    /// Whether an expression is the number zero.
    pub fn is_zero(&self, e: ExprId) -> bool {
        self.as_number(e).is_some_and(Number::is_zero)
    }
}

fn bump(powers: &mut BTreeMap<ExprId, i32>, base: ExprId, exponent: i32) {
    let entry = powers.entry(base).or_insert(0);
    *entry = entry.saturating_add(exponent);
}

/// The value of a function at a number where it is rational.
fn exact_value(function: Function, x: Number) -> Option<Number> {
    match function {
        Function::Abs => Some(if x.is_negative() { -x } else { x }),
        Function::Sign if x.is_negative() => Some(Number::MINUS_ONE),
        Function::Sign if !x.is_zero() => Some(Number::ONE),
        Function::Sqrt => x.exact_sqrt(),
        Function::Ln if x.is_one() => Some(Number::ZERO),
        Function::Acos if x.is_one() => Some(Number::ZERO),
        _ if !x.is_zero() => None,
        Function::Cos | Function::Cosh | Function::Exp => Some(Number::ONE),
        Function::Ln | Function::Acos | Function::Table(_) => None,
        _ => Some(Number::ZERO),
    }
}
