//! Takes common factors out of sums, and shares pairs of factors between products.
//!
//! In:  a program.
//! Out: the cheaper of two: with common factors taken out of the sums first, and
//!      without; then with pairs shared (`share.rs`).

use super::dead::ordered;
use super::program::{Operation, Program, Value, cost};
use super::share::share_pairs;
use crate::expr::Number;
use rustc_hash::FxHashMap;

/// Where collecting factors leaves less than this part of the cost, sharing pairs does not
/// make up for it. Of 427 such programs two were cheaper without, by half a hundredth.
const CLEARLY_CHEAPER: f64 = 0.7;

/// A program, and the same with common factors taken out of its sums, if there are any.
pub(super) struct Collected<'a> {
    program: &'a Program,
    collected: Option<Program>,
    /// What it costs before pairs are shared.
    pub(super) weight: usize,
}

impl<'a> Collected<'a> {
    pub(super) fn of(program: &'a Program) -> Self {
        let collected = collect_factors(program);
        Self {
            program,
            weight: cost(collected.as_ref().unwrap_or(program)).weight(),
            collected,
        }
    }

    /// The program with factors shared; never costlier.
    pub(super) fn shared(&self) -> Program {
        let Some(collected) = &self.collected else {
            return share_pairs(self.program);
        };
        let plain = cost(self.program).weight() as f64;
        let collected_shared = share_pairs(collected);
        if (self.weight as f64) < CLEARLY_CHEAPER * plain {
            return collected_shared;
        }
        let shared = share_pairs(self.program);
        match cost(&collected_shared).weight() < cost(&shared).weight() {
            true => collected_shared,
            false => shared,
        }
    }
}

/// Operations that grow at the end; equal ones are one.
struct Builder {
    program: Program,
}

/// A term of a sum: subtracted or added, and its factors.
type Term = (bool, Vec<Value>);

/// `a·x + a·y + z` becomes `a·(x + y) + z`, the commonest factor first; `None` where no sum has
/// a common factor.
pub(super) fn collect_factors(program: &Program) -> Option<Program> {
    let uses = program.uses();
    let mut builder = Builder {
        program: program.clone(),
    };
    let mut moved: FxHashMap<Value, Value> = FxHashMap::default();
    for (value, operation) in program.operations() {
        let Operation::Sum(terms) = operation else {
            continue;
        };
        let parts: Vec<Term> = terms
            .iter()
            .map(|(minus, x)| match program.operation(*x) {
                Operation::Product(factors) if uses[x.index()] == 1 => (*minus, factors.clone()),
                _ => (*minus, vec![*x]),
            })
            .collect();
        if commonest(&parts).is_some() {
            let collected = builder.collected(parts);
            moved.insert(value, builder.sum(collected));
        }
    }
    if moved.is_empty() {
        return None;
    }
    let grown = builder.program;
    let instead = |value: Value| moved.get(&value).copied().unwrap_or(value);
    Some(ordered(grown.list(), &grown.outputs, &instead))
}

impl Builder {
    /// Takes factors out of terms until no factor is common to two.
    fn collected(&mut self, mut terms: Vec<Term>) -> Vec<Term> {
        while let Some(common) = commonest(&terms) {
            let (having, mut rest): (Vec<Term>, Vec<Term>) = terms
                .into_iter()
                .partition(|(_, factors)| factors.contains(&common));
            let mut inner: Vec<Term> = having
                .into_iter()
                .map(|t| self.without(t, common))
                .collect();
            let minus = inner.iter().all(|(minus, _)| *minus);
            if minus {
                inner.iter_mut().for_each(|term| term.0 = false);
            }
            let inner = self.collected(inner);
            let inner = match <[Term; 1]>::try_from(inner) {
                Ok([(false, factors)]) => factors,
                Ok([term]) => vec![self.sum(vec![term])],
                Err(inner) => vec![self.sum(inner)],
            };
            let mut factors = vec![common];
            factors.extend(inner);
            rest.push((minus, factors));
            terms = rest;
        }
        terms
    }

    fn without(&mut self, (minus, mut factors): Term, common: Value) -> Term {
        if let Some(i) = factors.iter().position(|f| *f == common) {
            factors.remove(i);
        }
        if factors.is_empty() {
            factors.push(self.program.push(Operation::Number(Number::ONE)));
        }
        (minus, factors)
    }

    fn sum(&mut self, terms: Vec<Term>) -> Value {
        let mut values: Vec<(bool, Value)> = terms
            .into_iter()
            .map(|(minus, factors)| (minus, self.product(factors)))
            .collect();
        values.sort_by_key(|(minus, _)| *minus);
        match values[..] {
            [(false, only)] => only,
            _ => self.program.push(Operation::Sum(values)),
        }
    }

    fn product(&mut self, factors: Vec<Value>) -> Value {
        match factors[..] {
            [only] => only,
            _ => self.program.push(Operation::Product(factors)),
        }
    }
}

/// The factor that most terms have, if two have it; the oldest of equals.
fn commonest(terms: &[Term]) -> Option<Value> {
    let mut all: Vec<Value> = Vec::new();
    for (_, factors) in terms {
        for (i, factor) in factors.iter().enumerate() {
            if !factors[..i].contains(factor) {
                all.push(*factor);
            }
        }
    }
    all.sort_unstable();
    let (mut common, mut most, mut from) = (None, 1, 0);
    for (i, factor) in all.iter().enumerate() {
        if all[from] != *factor {
            from = i;
        }
        if i + 1 - from > most {
            (common, most) = (Some(*factor), i + 1 - from);
        }
    }
    common
}
