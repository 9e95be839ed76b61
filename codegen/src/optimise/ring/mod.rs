//! Expressions in the ring of the sines and cosines they are made of.
//!
//! In:  an expression.
//! Out: the same function, multiplied out as a polynomial in its atoms (symbols, functions,
//!      inverses), with `sin² = 1 − cos²` applied, like terms collected and `sin²` written
//!      again for what is left of `1 − cos²`. No new angle is introduced: the sine of a sum of
//!      angles is expanded only where it was written as one.
//!
//! A polynomial that grows past [`TERMS_MAX`] terms leaves the expression as it
//! was: multiplying out pays for planar linkages, not for long spatial chains. So does
//! one with a coefficient that overflows, and the inverse of one that is zero. The whole
//! is given up where it takes more work than a program is worth.

mod monomial;
mod squares;

use crate::expr::{ExprId, Function, Number};
use crate::model::{Graph, Node};
use monomial::{MonomialId, Monomials};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::hash_map::Entry;
use std::rc::Rc;

/// The largest number of terms of an intermediate polynomial.
const TERMS_MAX: usize = 400;

/// A program of less than this part of the cost is clearly shorter.
const CLEARLY_SHORTER: f64 = 0.98;

/// The largest power that is multiplied out.
const POWER_MAX: u32 = 8;

/// Monomials with their coefficients, none of them zero, in the order of the monomials.
type Polynomial = Rc<[(MonomialId, Number)]>;

/// A polynomial that is added up, in no order.
type Growing = FxHashMap<MonomialId, Number>;

/// The expression as a reduced polynomial, or unchanged where that is refused.
pub fn in_trig_ring(graph: &mut Graph, e: ExprId) -> ExprId {
    let reduced = Ring::new(graph, &mut Polynomials::default(), usize::MAX).reduced(e);
    reduced.unwrap_or(e)
}

/// What is known of the expressions of a graph: each is multiplied out once, whatever
/// asks for it.
#[derive(Clone, Debug, Default)]
pub struct Polynomials {
    known: FxHashMap<ExprId, Polynomial>,
    /// What is too long or has no finite coefficients, and everything that has it in it.
    refused: FxHashSet<ExprId>,
    monomials: Monomials,
    /// Whether polynomials of a program before were tried, and made it clearly shorter.
    tried: bool,
    paid: bool,
}

impl Polynomials {
    /// Whether they are worth the work in a long program: not where they made none of those
    /// before shorter, as in most spatial mechanisms.
    pub(super) fn may_pay(&self) -> bool {
        self.paid || !self.tried
    }

    /// Takes note of what a program costs without them and with them.
    pub(super) fn observe(&mut self, without: usize, with: usize) {
        self.tried = true;
        self.paid |= (with as f64) < CLEARLY_SHORTER * without as f64;
    }
}

/// Polynomials of expressions that share parts, each found once.
pub(super) struct Ring<'a> {
    graph: &'a mut Graph,
    memory: &'a mut Polynomials,
    /// How many terms may still be multiplied or added.
    left: usize,
}

impl<'a> Ring<'a> {
    /// One that multiplies or adds so many terms at most.
    pub fn new(graph: &'a mut Graph, memory: &'a mut Polynomials, most: usize) -> Self {
        let left = most;
        Ring {
            graph,
            memory,
            left,
        }
    }

    /// The expression as a reduced polynomial, or unchanged where that is refused; `None`
    /// where it is too much work.
    pub fn reduced(&mut self, e: ExprId) -> Option<ExprId> {
        let expanded = self.expand(e);
        if self.left == 0 {
            return None;
        }
        if expanded.is_none() {
            self.memory.refused.insert(e);
            return Some(e);
        }
        Some(self.known_expression(e))
    }

    fn expand(&mut self, e: ExprId) -> Option<()> {
        let mut pending = vec![(e, false)];
        while let Some((node, ready)) = pending.pop() {
            if self.left == 0 {
                return None;
            }
            if self.memory.refused.contains(&node) {
                return None;
            }
            if self.memory.known.contains_key(&node) {
                continue;
            }
            if ready {
                let is_sound = |p: &Polynomial| p.iter().all(|(_, number)| number.is_finite());
                let polynomial = self.expand_node(node).filter(is_sound);
                if polynomial.is_none() {
                    self.memory.refused.insert(node);
                }
                self.memory.known.insert(node, polynomial?);
            } else {
                pending.push((node, true));
                let show = &mut |child| pending.push((child, false));
                self.graph.node(node).for_each_child(show);
            }
        }
        Some(())
    }

    fn expand_node(&mut self, e: ExprId) -> Option<Polynomial> {
        match self.graph.node(e).clone() {
            Node::Number(value) => Some(self.constant(value)),
            Node::Sum(number, terms) => {
                let mut sum = Growing::default();
                accumulate(&mut sum, Monomials::ONE, number);
                for (x, weight) in terms {
                    self.spend(self.memory.known[&x].len());
                    for &(monomial, coefficient) in self.memory.known[&x].iter() {
                        accumulate(&mut sum, monomial, coefficient * weight);
                    }
                }
                (sum.len() <= TERMS_MAX).then(|| self.grown(sum))
            }
            Node::Product(factors) => {
                let mut product = self.constant(Number::ONE);
                for (base, exponent) in factors {
                    product = self.times_power(product, base, exponent)?;
                }
                Some(product)
            }
            // What stands inside a function is reduced on its own.
            _ => {
                let mut reduced: FxHashMap<ExprId, ExprId> = FxHashMap::default();
                for child in self.graph.node(e).children() {
                    reduced.insert(child, self.known_expression(child));
                }
                let atom = self.graph.rebuild(e, &|child| reduced[&child]);
                Some(self.atomic(atom))
            }
        }
    }

    fn spend(&mut self, terms: usize) {
        self.left = self.left.saturating_sub(terms);
    }

    /// A rebuilt function as a polynomial: a weighted atom, or a number.
    fn atomic(&mut self, e: ExprId) -> Polynomial {
        match self.graph.node(e) {
            Node::Number(value) => {
                let value = *value;
                self.constant(value)
            }
            Node::Sum(number, terms) if number.is_zero() && terms.len() == 1 => {
                let (atom, weight) = terms[0];
                [(self.memory.monomials.of(&[(atom, 1)]), weight)].into()
            }
            _ => [(self.memory.monomials.of(&[(e, 1)]), Number::ONE)].into(),
        }
    }

    fn times_power(
        &mut self,
        mut product: Polynomial,
        base: ExprId,
        exponent: i32,
    ) -> Option<Polynomial> {
        let factor = self.memory.known[&base].clone();
        if exponent.unsigned_abs() > POWER_MAX {
            return None;
        }
        if exponent > 0 {
            for _ in 0..exponent {
                product = self.times(&product, &factor)?;
            }
            return Some(product);
        }
        // Zero was not seen to be zero before: its inverse stays as it was written.
        if factor.is_empty() {
            return None;
        }
        // The inverse of one term is a term; the inverse of a sum is an atom.
        let inverse: Polynomial = match factor[..] {
            [(monomial, coefficient)] => {
                let powers: Vec<(ExprId, i32)> = self.memory.monomials.powers(monomial);
                let powers: Vec<(ExprId, i32)> = powers
                    .into_iter()
                    .map(|(atom, n)| (atom, n * exponent))
                    .collect();
                let monomial = self.memory.monomials.of(&powers);
                [(monomial, coefficient.powi(exponent)?)].into()
            }
            _ => {
                let atom = self.known_expression(base);
                let monomial = self.memory.monomials.of(&[(atom, exponent)]);
                [(monomial, Number::ONE)].into()
            }
        };
        self.times(&product, &inverse)
    }

    fn times(&mut self, a: &Polynomial, b: &Polynomial) -> Option<Polynomial> {
        let mut product = Growing::default();
        self.spend(a.len() * b.len());
        for &(left, x) in a.iter() {
            for &(right, y) in b.iter() {
                let weight = x * y;
                for &(minus, monomial) in self.product(left, right).iter() {
                    let weight = if minus { -weight } else { weight };
                    accumulate(&mut product, monomial, weight);
                }
                if product.len() > TERMS_MAX {
                    return None;
                }
            }
        }
        Some(self.grown(product))
    }

    /// The product of two monomials, each part added or (`true`) subtracted.
    fn product(&mut self, left: MonomialId, right: MonomialId) -> Rc<[(bool, MonomialId)]> {
        if let Some(known) = self.memory.monomials.product(left, right) {
            return known;
        }
        let mut parts = Vec::new();
        let joined = self.memory.monomials.joined(left, right);
        self.add_reduced(&mut parts, joined, false);
        self.memory
            .monomials
            .keep_product(left, right, parts.into())
    }

    /// Adds a monomial, with `sin² → 1 − cos²` until no sine is squared.
    fn add_reduced(
        &mut self,
        sum: &mut Vec<(bool, MonomialId)>,
        monomial: Vec<(ExprId, i32)>,
        minus: bool,
    ) {
        let squared = monomial.iter().position(|&(atom, n)| {
            n >= 2 && matches!(self.graph.node(atom), Node::Function(Function::Sin, _))
        });
        let Some(i) = squared else {
            sum.push((minus, self.memory.monomials.of(&monomial)));
            return;
        };
        let &Node::Function(_, angle) = self.graph.node(monomial[i].0) else {
            return;
        };
        let cos = self.graph.function(Function::Cos, angle);
        let mut lowered = monomial;
        lowered[i].1 -= 2;
        lowered.retain(|(_, n)| *n != 0);
        let with_cos = [&lowered[..], &[(cos, 2)]].concat();
        self.add_reduced(sum, lowered, minus);
        self.add_reduced(sum, monomial::collected(with_cos), !minus);
    }

    /// The expression of the polynomial of one that is known.
    fn known_expression(&mut self, e: ExprId) -> ExprId {
        let polynomial = self.with_sines_squared(self.memory.known[&e].clone());
        let mut number = Number::ZERO;
        let mut terms = Vec::with_capacity(polynomial.len());
        for &(monomial, coefficient) in polynomial.iter() {
            if monomial == Monomials::ONE {
                number = coefficient;
            } else {
                let term = self.memory.monomials.expression(monomial, self.graph);
                terms.push((term, coefficient));
            }
        }
        self.graph.weighted_sum(number, &terms)
    }

    /// The polynomial as it is written: with `sin²` for `1 − cos²`.
    fn with_sines_squared(&mut self, polynomial: Polynomial) -> Polynomial {
        let monomials = &mut self.memory.monomials;
        let mut terms = Vec::with_capacity(polynomial.len());
        for &(monomial, coefficient) in polynomial.iter() {
            terms.push((monomials.powers(monomial), coefficient));
        }
        let written = squares::with_sines_squared(terms, self.graph);
        // Beside negative powers of a sine, what is written differently may be the same.
        let mut sum = Growing::default();
        for (powers, coefficient) in written {
            accumulate(&mut sum, monomials.of(&powers), coefficient);
        }
        self.grown(sum)
    }

    fn constant(&self, value: Number) -> Polynomial {
        if value.is_zero() {
            Rc::default()
        } else {
            [(Monomials::ONE, value)].into()
        }
    }

    fn grown(&self, sum: Growing) -> Polynomial {
        let mut terms: Vec<(MonomialId, Number)> = sum.into_iter().collect();
        let monomials = &self.memory.monomials;
        terms.sort_unstable_by(|(a, _), (b, _)| monomials.compare(*a, *b));
        terms.into()
    }
}

fn accumulate(sum: &mut Growing, monomial: MonomialId, coefficient: Number) {
    if coefficient.is_zero() {
        return;
    }
    match sum.entry(monomial) {
        Entry::Vacant(free) => {
            free.insert(coefficient);
        }
        Entry::Occupied(mut known) => {
            let total = *known.get() + coefficient;
            if total.is_zero() {
                known.remove();
            } else {
                known.insert(total);
            }
        }
    }
}
