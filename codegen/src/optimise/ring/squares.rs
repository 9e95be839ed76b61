//! Squares of sines where a polynomial is left with `1 − cos²`.
//!
//! In:  the terms of a polynomial in which no sine is squared.
//! Out: the same polynomial with `sin²` for each factor `1 − cos²` that shortens it. It
//!      costs less so, and near the zeros of the sine the difference would have lost the
//!      digits that the square keeps.

use super::monomial::collected;
use crate::expr::{ExprId, Function, Number};
use crate::model::{Graph, Node};
use std::collections::BTreeMap;

/// The powers of a monomial, sorted by atom, and its coefficient.
pub(super) type Term = (Vec<(ExprId, i32)>, Number);

/// The terms with `m (1 − cos² x)` written as `m sin² x`.
pub(super) fn with_sines_squared(mut terms: Vec<Term>, graph: &mut Graph) -> Vec<Term> {
    for (cosine, angle) in squared_cosines(&terms, graph) {
        let sine = graph.function(Function::Sin, angle);
        terms = divided(terms, cosine, sine);
    }
    terms
}

/// The cosines that are squared somewhere, with their angles.
fn squared_cosines(terms: &[Term], graph: &Graph) -> Vec<(ExprId, ExprId)> {
    let mut found: Vec<(ExprId, ExprId)> = terms
        .iter()
        .flat_map(|(powers, _)| powers.iter())
        .filter(|(_, n)| *n >= 2)
        .filter_map(|&(atom, _)| match graph.node(atom) {
            Node::Function(Function::Cos, angle) => Some((atom, *angle)),
            _ => None,
        })
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// The terms, those that differ in squares of one cosine divided by `1 − cos²`.
fn divided(terms: Vec<Term>, cosine: ExprId, sine: ExprId) -> Vec<Term> {
    // What multiplies the squares, and the polynomial in the square of the cosine.
    let mut groups: BTreeMap<Vec<(ExprId, i32)>, BTreeMap<i32, Number>> = BTreeMap::new();
    for (mut powers, coefficient) in terms {
        let mut squares = 0;
        if let Some((_, n)) = powers
            .iter_mut()
            .find(|(atom, n)| *atom == cosine && *n > 0)
        {
            squares = *n / 2;
            *n %= 2;
        }
        powers.retain(|(_, n)| *n != 0);
        // A quotient by another cosine may have left what was there already.
        let polynomial = groups.entry(powers).or_default();
        let sum = polynomial.entry(squares).or_insert(Number::ZERO);
        *sum = *sum + coefficient;
    }
    let mut written = Vec::new();
    for (rest, mut polynomial) in groups {
        polynomial.retain(|_, coefficient| !coefficient.is_zero());
        let mut sines = 0;
        while let Some(quotient) = quotient(&polynomial) {
            polynomial = quotient;
            sines += 2;
        }
        for (squares, coefficient) in polynomial {
            let squares = [(cosine, 2 * squares), (sine, sines)];
            written.push((collected([&rest[..], &squares].concat()), coefficient));
        }
    }
    written
}

/// The quotient by `1 − y` of a polynomial in `y`, where it has fewer terms. Its
/// coefficients are the partial sums of those of the polynomial.
fn quotient(polynomial: &BTreeMap<i32, Number>) -> Option<BTreeMap<i32, Number>> {
    let highest = *polynomial.keys().next_back()?;
    let mut sum = Number::ZERO;
    let mut quotient = BTreeMap::new();
    for power in 0..=highest {
        sum = sum + polynomial.get(&power).copied().unwrap_or(Number::ZERO);
        if !sum.is_zero() {
            quotient.insert(power, sum);
        }
    }
    (sum.is_zero() && quotient.len() < polynomial.len()).then_some(quotient)
}
