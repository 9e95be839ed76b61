//! Shares pairs of factors between products.
//!
//! In:  a program.
//! Out: the same with the pair of factors that most products have as a product of its
//!      own, again and again while two products have one.
//!
//! A long program has many pairs, and build scripts are compiled without optimisation, so each
//! replacement counts only the pairs that it changes. Entries of the ranking that are out of
//! date by then are dropped when they come up.

use super::dead::ordered;
use super::program::{Operation, Program, Value};
use rustc_hash::FxHashMap;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The place behind the end of a list.
const END: usize = usize::MAX;

/// Two factors, the older one first.
type Pair = (Value, Value);

/// Products, by the pairs of factors they have.
struct Pairs {
    /// The factors of each operation, sorted; none where it is no product.
    products: Vec<Vec<Value>>,
    /// The place of a pair in what follows.
    places: FxHashMap<Pair, usize>,
    pairs: Vec<Pair>,
    /// How many products have a pair.
    counts: Vec<usize>,
    /// Where the list of those that have it, and some that had, begins in `links`.
    having: Vec<usize>,
    /// Products, each with the place of the next one of its list; see [`END`].
    links: Vec<(usize, usize)>,
    /// The pairs, those that most products have first, the oldest of equals; an entry is
    /// out of date where the count is another one by now.
    ranking: BinaryHeap<(usize, Reverse<Pair>, usize)>,
    /// Pairs that more products have than their entries say.
    grown: Vec<usize>,
}

impl Pairs {
    fn of(operations: &[Operation]) -> Self {
        let mut pairs = Pairs {
            products: Vec::with_capacity(operations.len()),
            places: FxHashMap::default(),
            pairs: Vec::new(),
            counts: Vec::new(),
            having: Vec::new(),
            links: Vec::new(),
            ranking: BinaryHeap::new(),
            grown: Vec::new(),
        };
        for (i, operation) in operations.iter().enumerate() {
            let mut factors = match operation {
                Operation::Product(factors) => factors.clone(),
                _ => Vec::new(),
            };
            factors.sort_unstable();
            for (k, &a) in factors.iter().enumerate() {
                for (m, &b) in factors.iter().enumerate().skip(k + 1) {
                    if is_first(&factors, k, m) {
                        pairs.count(i, (a, b));
                    }
                }
            }
            pairs.products.push(factors);
        }
        (0..pairs.pairs.len()).for_each(|place| pairs.rank(place));
        pairs
    }

    /// Counts a product that has a pair.
    fn count(&mut self, product: usize, pair: Pair) -> usize {
        let next = self.pairs.len();
        let place = *self.places.entry(pair).or_insert(next);
        if place == next {
            self.pairs.push(pair);
            self.counts.push(0);
            self.having.push(END);
        }
        self.counts[place] += 1;
        self.links.push((product, self.having[place]));
        self.having[place] = self.links.len() - 1;
        place
    }

    /// The pair that most products have, if two have it, and these products.
    fn commonest(&mut self) -> Option<(Pair, Vec<usize>)> {
        loop {
            let (said, Reverse(pair), place) = self.ranking.pop()?;
            let count = self.counts[place];
            if count == said {
                let mut products = Vec::with_capacity(count);
                let mut link = std::mem::replace(&mut self.having[place], END);
                while let Some(&(product, next)) = self.links.get(link) {
                    products.push(product);
                    link = next;
                }
                products.sort_unstable();
                products.dedup();
                products.retain(|product| has(&self.products[*product], pair));
                return Some((pair, products));
            }
            if count > 1 && count < said {
                self.ranking.push((count, Reverse(pair), place));
            }
        }
    }

    /// Replaces a pair in a product by the product of the two; the new factors, that one
    /// last.
    fn replace(&mut self, product: usize, (a, b): Pair, by: Value) -> Vec<Value> {
        let old = self.products[product].clone();
        let mut kept = old.clone();
        for value in [a, b] {
            if let Some(i) = kept.iter().position(|factor| *factor == value) {
                kept.remove(i);
            }
        }
        // Pairs that went with one of the two.
        for (k, &x) in old.iter().enumerate() {
            for (m, &y) in old.iter().enumerate().skip(k + 1) {
                let touched = x == a || x == b || y == a || y == b;
                if touched && is_first(&old, k, m) && !has(&kept, (x, y)) {
                    let place = self.places[&(x, y)];
                    self.counts[place] -= 1;
                }
            }
        }
        if kept.contains(&by) {
            if !has(&kept, (by, by)) {
                let place = self.count(product, (by, by));
                self.grown.push(place);
            }
        } else {
            let mut last = None;
            for &x in &kept {
                if last != Some(x) {
                    let place = self.count(product, (x.min(by), x.max(by)));
                    self.grown.push(place);
                }
                last = Some(x);
            }
        }
        let place = kept.partition_point(|factor| *factor <= by);
        let mut written = kept.clone();
        written.push(by);
        kept.insert(place, by);
        self.products[product] = kept;
        written
    }

    /// Counts the products that have a pair still, twice, and ranks what has grown.
    fn done(&mut self, pair: Pair, mut products: Vec<usize>) {
        let place = self.places[&pair];
        products.retain(|product| has(&self.products[*product], pair));
        self.counts[place] = products.len();
        for product in products {
            self.links.push((product, self.having[place]));
            self.having[place] = self.links.len() - 1;
        }
        self.grown.push(place);
        self.grown.sort_unstable();
        self.grown.dedup();
        for place in std::mem::take(&mut self.grown) {
            self.rank(place);
        }
    }

    fn rank(&mut self, place: usize) {
        if self.counts[place] > 1 {
            let entry = (self.counts[place], Reverse(self.pairs[place]), place);
            self.ranking.push(entry);
        }
    }
}

/// Whether equal factors stand first at these places of a sorted product.
fn is_first(factors: &[Value], k: usize, m: usize) -> bool {
    let (a, b) = (factors[k], factors[m]);
    (k == 0 || factors[k - 1] != a) && (m == k + 1 || factors[m - 1] != b)
}

/// Whether a product has both factors.
fn has(factors: &[Value], (a, b): Pair) -> bool {
    match factors.iter().position(|factor| *factor == a) {
        Some(i) if a == b => factors.get(i + 1) == Some(&b),
        Some(_) => factors.contains(&b),
        None => false,
    }
}

/// The commonest pair of factors becomes a product of its own, again and again.
pub(super) fn share_pairs(program: &Program) -> Program {
    let mut operations: Vec<Operation> = program.list().to_vec();
    let mut pairs = Pairs::of(&operations);
    // Products that turned out to be another one: the same factors in another order.
    let mut moved: FxHashMap<Value, Value> = FxHashMap::default();
    while let Some((pair @ (a, b), products)) = pairs.commonest() {
        let is_pair = |product: &&usize| pairs.products[**product] == [a, b];
        let known = products.iter().find(is_pair).copied();
        let shared = known.unwrap_or(operations.len());
        if shared == operations.len() {
            operations.push(Operation::Product(vec![a, b]));
            pairs.products.push(Vec::new());
        }
        for &product in &products {
            if product == shared || pairs.products[product] == [a, b] {
                pairs.products[product].clear();
                if product != shared {
                    moved.insert(Value::at(product), Value::at(shared));
                }
                continue;
            }
            let factors = pairs.replace(product, pair, Value::at(shared));
            operations[product] = Operation::Product(factors);
        }
        pairs.done(pair, products);
    }
    let instead = |value: Value| moved.get(&value).copied().unwrap_or(value);
    ordered(&operations, &program.outputs, &instead)
}
