//! Shares pairs of factors between products, and takes common factors out of sums.
//!
//! In:  a program.
//! Out: the cheaper of two: with common factors taken out of the sums first, and
//!      without. Then the pair of factors that most products have becomes a
//!      product of its own, again and again while two products have one.

use super::count::cost;
use super::dead::ordered;
use super::program::{Operation, Program, Slot, Value};
use crate::expr::Number;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

/// The program with factors shared; never costlier.
pub(super) fn factor(program: &Program) -> Program {
    let shared = share_pairs(program);
    let collected = share_pairs(&collect_factors(program));
    let candidates = [shared, collected, program.clone()];
    let [first, rest @ ..] = candidates;
    rest.into_iter().fold(first, |best, other| {
        if cost(&other).weight() < cost(&best).weight() {
            other
        } else {
            best
        }
    })
}

/// Operations that grow at the end; equal ones are one.
struct Builder {
    program: Program,
}

/// A term of a sum: subtracted or added, and its factors.
type Term = (bool, Vec<Value>);

/// `a·x + a·y + z` becomes `a·(x + y) + z`, the commonest factor first.
pub(super) fn collect_factors(program: &Program) -> Program {
    let uses = program.uses();
    let mut builder = Builder {
        program: program.clone(),
    };
    let mut moved: BTreeMap<Value, Value> = BTreeMap::new();
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
        let collected = builder.collected(parts.clone());
        if collected != parts {
            moved.insert(value, builder.sum(collected));
        }
    }
    let grown = builder.program;
    let operations: Vec<Operation> = grown.operations().map(|(_, o)| o.clone()).collect();
    redirected(&operations, &grown.outputs, &moved)
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
    let mut counts: BTreeMap<Value, usize> = BTreeMap::new();
    for (_, factors) in terms {
        let distinct: BTreeSet<Value> = factors.iter().copied().collect();
        distinct
            .into_iter()
            .for_each(|f| *counts.entry(f).or_insert(0) += 1);
    }
    let most = counts.values().copied().max().filter(|most| *most > 1)?;
    counts
        .into_iter()
        .find(|(_, count)| *count == most)
        .map(|(factor, _)| factor)
}

/// The program with some of its values replaced everywhere.
fn redirected(
    operations: &[Operation],
    outputs: &[(Slot, Value)],
    moved: &BTreeMap<Value, Value>,
) -> Program {
    let target = |value: &Value| moved.get(value).copied().unwrap_or(*value);
    let operations: Vec<Operation> = operations
        .iter()
        .map(|operation| match operation {
            Operation::Sum(terms) => {
                Operation::Sum(terms.iter().map(|(minus, x)| (*minus, target(x))).collect())
            }
            Operation::Product(factors) => Operation::Product(factors.iter().map(target).collect()),
            Operation::Quotient(x, y) => Operation::Quotient(target(x), target(y)),
            Operation::Function(f, x) => Operation::Function(*f, target(x)),
            Operation::Function2(f, x, y) => Operation::Function2(*f, target(x), target(y)),
            Operation::Select(c, parts) => Operation::Select(*c, parts.map(|x| target(&x))),
            Operation::Input(i, law) => Operation::Input(*i, target(law)),
            Operation::Number(_) | Operation::Pi | Operation::Symbol(_) => operation.clone(),
        })
        .collect();
    let outputs: Vec<_> = outputs
        .iter()
        .map(|(slot, value)| (*slot, target(value)))
        .collect();
    ordered(&operations, &outputs)
}

type Pair = (Value, Value);

/// Products, by the pairs of factors they have.
struct Pairs {
    products: BTreeMap<usize, Vec<Value>>,
    having: BTreeMap<Pair, BTreeSet<usize>>,
    /// The pairs, those that most products have first.
    ranking: BTreeSet<(Reverse<usize>, Pair)>,
}

impl Pairs {
    fn of(operations: &[Operation]) -> Self {
        let mut pairs = Pairs {
            products: BTreeMap::new(),
            having: BTreeMap::new(),
            ranking: BTreeSet::new(),
        };
        for (i, operation) in operations.iter().enumerate() {
            if let Operation::Product(factors) = operation {
                pairs.insert(i, factors.clone());
            }
        }
        pairs
    }

    fn insert(&mut self, product: usize, mut factors: Vec<Value>) {
        factors.sort_unstable();
        for pair in distinct_pairs(&factors) {
            self.change(pair, |products| products.insert(product));
        }
        self.products.insert(product, factors);
    }

    fn remove(&mut self, product: usize) -> Vec<Value> {
        let factors = self.products.remove(&product).unwrap_or_default();
        for pair in distinct_pairs(&factors) {
            self.change(pair, |products| products.remove(&product));
        }
        factors
    }

    /// Changes which products have a pair, and its rank with that.
    fn change(&mut self, pair: Pair, by: impl FnOnce(&mut BTreeSet<usize>) -> bool) {
        let products = self.having.entry(pair).or_default();
        self.ranking.remove(&(Reverse(products.len()), pair));
        by(products);
        if products.is_empty() {
            self.having.remove(&pair);
        } else {
            self.ranking.insert((Reverse(products.len()), pair));
        }
    }

    /// The pair that most products have, if two have it; the first of equals.
    fn commonest(&self) -> Option<Pair> {
        let (Reverse(most), pair) = self.ranking.first()?;
        (*most > 1).then_some(*pair)
    }
}

fn distinct_pairs(sorted: &[Value]) -> BTreeSet<Pair> {
    let mut pairs = BTreeSet::new();
    for (i, a) in sorted.iter().enumerate() {
        pairs.extend(sorted[i + 1..].iter().map(|b| (*a, *b)));
    }
    pairs
}

/// The commonest pair of factors becomes a product of its own, again and again.
pub(super) fn share_pairs(program: &Program) -> Program {
    let mut operations: Vec<Operation> = program.operations().map(|(_, o)| o.clone()).collect();
    let mut pairs = Pairs::of(&operations);
    // Products that turned out to be another one: the same factors in another order.
    let mut moved: BTreeMap<Value, Value> = BTreeMap::new();
    while let Some(pair @ (a, b)) = pairs.commonest() {
        let products: Vec<usize> = pairs.having[&pair].iter().copied().collect();
        let is_pair = |product: &&usize| pairs.products[product] == [a, b];
        let shared = products
            .iter()
            .find(is_pair)
            .copied()
            .unwrap_or(operations.len());
        if shared == operations.len() {
            operations.push(Operation::Product(vec![a, b]));
        }
        for product in products {
            let mut factors = pairs.remove(product);
            if product == shared {
                continue;
            }
            for value in [a, b] {
                if let Some(i) = factors.iter().position(|f| *f == value) {
                    factors.remove(i);
                }
            }
            if factors.is_empty() {
                moved.insert(Value::at(product), Value::at(shared));
                continue;
            }
            factors.push(Value::at(shared));
            operations[product] = Operation::Product(factors.clone());
            pairs.insert(product, factors);
        }
    }
    redirected(&operations, &program.outputs, &moved)
}
