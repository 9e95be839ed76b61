//! Expressions in the ring of the sines and cosines they are made of.
//!
//! In:  an expression.
//! Out: the same function, multiplied out as a polynomial in its atoms (symbols,
//!      functions, inverses), with `sin² = 1 − cos²` applied and like terms
//!      collected. Never a new angle: the sine of a sum of angles is expanded
//!      only where it was written as one.
//!
//! A polynomial that grows past [`TERMS_MAX`] terms leaves the expression as it
//! was: multiplying out pays for planar linkages, not for long spatial chains. So does
//! one with a coefficient that overflows, and the inverse of one that is zero.

use crate::expr::{ExprId, Function, Graph, Node, Number};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;

/// The largest number of terms of an intermediate polynomial.
const TERMS_MAX: usize = 400;

/// The largest power that is multiplied out.
const POWER_MAX: u32 = 8;

/// A product of powers of atoms, sorted by atom.
type Monomial = Vec<(ExprId, i32)>;
type Polynomial = BTreeMap<Monomial, Number>;

/// The expression as a reduced polynomial, or unchanged where that is refused.
pub fn in_trig_ring(graph: &mut Graph, e: ExprId) -> ExprId {
    Ring::new(graph).reduced(e)
}

/// Polynomials of expressions that share parts, each found once.
pub(super) struct Ring<'a> {
    graph: &'a mut Graph,
    known: FxHashMap<ExprId, Polynomial>,
    /// What is too long or has no finite coefficients, and everything that has it in it.
    refused: FxHashSet<ExprId>,
}

impl<'a> Ring<'a> {
    pub fn new(graph: &'a mut Graph) -> Self {
        Ring {
            graph,
            known: FxHashMap::default(),
            refused: FxHashSet::default(),
        }
    }

    /// The expression as a reduced polynomial, or unchanged where that is refused.
    pub fn reduced(&mut self, e: ExprId) -> ExprId {
        if self.expand(e).is_none() {
            self.refused.insert(e);
            return e;
        }
        let polynomial = self.known[&e].clone();
        self.expression(&polynomial)
    }

    fn expand(&mut self, e: ExprId) -> Option<()> {
        let mut pending = vec![(e, false)];
        while let Some((node, ready)) = pending.pop() {
            if self.refused.contains(&node) {
                return None;
            }
            if self.known.contains_key(&node) {
                continue;
            }
            if ready {
                let is_sound = |p: &Polynomial| p.values().all(|number| number.is_finite());
                let polynomial = self.expand_node(node).filter(is_sound);
                if polynomial.is_none() {
                    self.refused.insert(node);
                }
                self.known.insert(node, polynomial?);
            } else {
                pending.push((node, true));
                let children = self.graph.node(node).children();
                pending.extend(children.into_iter().map(|child| (child, false)));
            }
        }
        Some(())
    }

    fn expand_node(&mut self, e: ExprId) -> Option<Polynomial> {
        match self.graph.node(e).clone() {
            Node::Number(value) => Some(constant(value)),
            Node::Sum(number, terms) => {
                let mut sum = constant(number);
                for (x, weight) in terms {
                    for (monomial, coefficient) in &self.known[&x] {
                        accumulate(&mut sum, monomial.clone(), *coefficient * weight);
                    }
                }
                (sum.len() <= TERMS_MAX).then_some(sum)
            }
            Node::Product(factors) => {
                let mut product = constant(Number::ONE);
                for (base, exponent) in factors {
                    product = self.times_power(product, base, exponent)?;
                }
                Some(product)
            }
            // What stands inside a function is reduced on its own.
            _ => {
                let mut reduced: FxHashMap<ExprId, ExprId> = FxHashMap::default();
                for child in self.graph.node(e).children() {
                    let polynomial = self.known[&child].clone();
                    reduced.insert(child, self.expression(&polynomial));
                }
                let atom = self.graph.rebuild(e, &|child| reduced[&child]);
                self.atomic(atom)
            }
        }
    }

    /// A rebuilt function as a polynomial: a weighted atom, or a number.
    fn atomic(&mut self, e: ExprId) -> Option<Polynomial> {
        match self.graph.node(e) {
            Node::Number(value) => Some(constant(*value)),
            Node::Sum(number, terms) if number.is_zero() && terms.len() == 1 => {
                Some(Polynomial::from([(vec![(terms[0].0, 1)], terms[0].1)]))
            }
            _ => Some(Polynomial::from([(vec![(e, 1)], Number::ONE)])),
        }
    }

    fn times_power(
        &mut self,
        mut product: Polynomial,
        base: ExprId,
        exponent: i32,
    ) -> Option<Polynomial> {
        let factor = self.known[&base].clone();
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
        let inverse = match factor.iter().next() {
            Some((monomial, coefficient)) if factor.len() == 1 => {
                let powers = monomial
                    .iter()
                    .map(|(atom, n)| (*atom, n * exponent))
                    .collect();
                Polynomial::from([(powers, coefficient.powi(exponent)?)])
            }
            _ => {
                let atom = self.expression(&factor);
                Polynomial::from([(vec![(atom, exponent)], Number::ONE)])
            }
        };
        self.times(&product, &inverse)
    }

    fn times(&mut self, a: &Polynomial, b: &Polynomial) -> Option<Polynomial> {
        let mut product = Polynomial::new();
        for (left, x) in a {
            for (right, y) in b {
                self.add_reduced(&mut product, joined(left, right), *x * *y);
                if product.len() > TERMS_MAX {
                    return None;
                }
            }
        }
        Some(product)
    }

    /// Adds a monomial, with `sin² → 1 − cos²` until no sine is squared.
    fn add_reduced(&mut self, sum: &mut Polynomial, monomial: Monomial, coefficient: Number) {
        let squared = monomial.iter().position(|&(atom, n)| {
            n >= 2 && matches!(self.graph.node(atom), Node::Function(Function::Sin, _))
        });
        let Some(i) = squared else {
            accumulate(sum, monomial, coefficient);
            return;
        };
        let &Node::Function(_, angle) = self.graph.node(monomial[i].0) else {
            return;
        };
        let cos = self.graph.function(Function::Cos, angle);
        let mut lowered = monomial;
        lowered[i].1 -= 2;
        lowered.retain(|(_, n)| *n != 0);
        let with_cos = joined(&lowered, &[(cos, 2)]);
        self.add_reduced(sum, lowered, coefficient);
        self.add_reduced(sum, with_cos, -coefficient);
    }

    fn expression(&mut self, polynomial: &Polynomial) -> ExprId {
        let mut number = Number::ZERO;
        let mut terms = Vec::new();
        for (monomial, coefficient) in polynomial {
            if monomial.is_empty() {
                number = *coefficient;
            } else {
                terms.push((self.graph.power_product(monomial), *coefficient));
            }
        }
        self.graph.weighted_sum(number, &terms)
    }
}

fn constant(value: Number) -> Polynomial {
    if value.is_zero() {
        Polynomial::new()
    } else {
        Polynomial::from([(Vec::new(), value)])
    }
}

fn accumulate(sum: &mut Polynomial, monomial: Monomial, coefficient: Number) {
    let total = sum
        .get(&monomial)
        .map_or(coefficient, |known| *known + coefficient);
    if total.is_zero() {
        sum.remove(&monomial);
    } else {
        sum.insert(monomial, total);
    }
}

fn joined(a: &[(ExprId, i32)], b: &[(ExprId, i32)]) -> Monomial {
    let mut powers: BTreeMap<ExprId, i32> = a.iter().copied().collect();
    for (atom, n) in b {
        *powers.entry(*atom).or_insert(0) += n;
    }
    powers.into_iter().filter(|(_, n)| *n != 0).collect()
}
