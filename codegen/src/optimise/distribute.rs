//! Puts factors into sums where their products with the terms are computed all the same.
//!
//! In:  a program.
//! Out: the same with `a (f x ± g y)` as `(a f) x ± (a g) y`, where there is `a f` and `a g`.
//!
//! Constraints have entries `L cos φ` of their Jacobian, and `L cos φ φ̇²` beside them.

use super::dead::ordered;
use super::program::{Operation, Program, Value};
use rustc_hash::FxHashMap;

/// A sum's terms: subtracted or added.
type Terms = Vec<(bool, Value)>;

/// A program that grows, beside the one that it comes from.
struct Distributed<'a> {
    program: &'a Program,
    uses: Vec<usize>,
    grown: Program,
    /// What takes the place of values.
    moved: FxHashMap<Value, Value>,
    /// The terms of those that have become sums.
    sums: FxHashMap<Value, Terms>,
}

/// The program with factors put into sums; never costlier.
pub(super) fn distribute(program: &Program) -> Program {
    let mut done = Distributed {
        program,
        uses: program.uses(),
        grown: program.clone(),
        moved: FxHashMap::default(),
        sums: FxHashMap::default(),
    };
    for (value, operation) in program.operations() {
        match operation {
            Operation::Product(factors) => done.open(value, factors),
            Operation::Sum(terms) => done.flatten(value, terms),
            _ => {}
        }
    }
    if done.moved.is_empty() {
        return done.grown;
    }
    let instead = |value: Value| done.moved.get(&value).copied().unwrap_or(value);
    ordered(done.grown.list(), &done.grown.outputs, &instead)
}

impl Distributed<'_> {
    /// Puts a factor of a product into another one that is a sum, if it can be.
    fn open(&mut self, value: Value, factors: &[Value]) {
        for (place, sum) in factors.iter().enumerate() {
            let Operation::Sum(terms) = self.program.operation(*sum) else {
                continue;
            };
            // Of one term is what only changes a sign.
            if terms.len() < 2 || self.uses[sum.index()] > 1 {
                continue;
            }
            for (other, factor) in factors.iter().enumerate() {
                if other == place {
                    continue;
                }
                let Some(terms) = self.multiplied(*factor, terms) else {
                    continue;
                };
                let sum = self.grown.push(Operation::Sum(terms.clone()));
                let rest = (0..factors.len()).filter(|k| *k != place && *k != other);
                let mut left: Vec<Value> = rest.map(|k| factors[k]).collect();
                if left.is_empty() {
                    self.moved.insert(value, sum);
                    self.sums.insert(value, terms);
                } else {
                    left.push(sum);
                    let product = self.grown.push(Operation::Product(left));
                    self.moved.insert(value, product);
                }
                return;
            }
        }
    }

    /// Terms times a factor, of which all products are there that are not less than there were.
    fn multiplied(&mut self, factor: Value, terms: &[(bool, Value)]) -> Option<Terms> {
        let known = |program: &Program, other: Value| {
            let mut pair = vec![factor, other];
            pair.sort_unstable();
            program.value(&Operation::Product(pair))
        };
        let mut opened = Vec::with_capacity(terms.len());
        for (minus, term) in terms {
            if let Some(product) = known(self.program, *term) {
                opened.push((*minus, vec![product]));
                continue;
            }
            let Operation::Product(factors) = self.program.operation(*term) else {
                return None;
            };
            if self.uses[term.index()] > 1 {
                return None;
            }
            let mut found = factors.iter().enumerate();
            let (place, product) =
                found.find_map(|(place, x)| Some((place, known(self.program, *x)?)))?;
            let mut left = factors.clone();
            left[place] = product;
            opened.push((*minus, left));
        }
        let mut product = |factors: Vec<Value>| match factors[..] {
            [only] => only,
            _ => self.grown.push(Operation::Product(factors)),
        };
        Some(
            opened
                .into_iter()
                .map(|(minus, factors)| (minus, product(factors)))
                .collect(),
        )
    }

    /// A sum with the terms of sums that its terms have become, which nothing else reads.
    fn flatten(&mut self, value: Value, terms: &[(bool, Value)]) {
        let mut flat = Terms::new();
        let mut opens = false;
        for (minus, term) in terms {
            match self.sums.get(term).filter(|_| self.uses[term.index()] == 1) {
                Some(inner) => {
                    flat.extend(inner.iter().map(|(inner, x)| (minus ^ inner, *x)));
                    opens = true;
                }
                None => flat.push((*minus, *term)),
            }
        }
        if opens && terms.len() > 1 {
            let sum = self.grown.push(Operation::Sum(flat));
            self.moved.insert(value, sum);
        }
    }
}
