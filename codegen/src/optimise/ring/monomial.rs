//! Products of powers of atoms.
//!
//! Each is kept once, and so is each product of two: where polynomials are multiplied, the
//! same pairs come again and again.

use crate::expr::ExprId;
use crate::model::Graph;
use rustc_hash::FxHashMap;
use std::cmp::Ordering;
use std::rc::Rc;

/// A monomial of [`Monomials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct MonomialId(u32);

/// A product of two monomials as a sum: each part added or (`true`) subtracted.
type Parts = Rc<[(bool, MonomialId)]>;

/// All monomials that were met.
#[derive(Clone, Debug)]
pub(super) struct Monomials {
    /// Powers of atoms, sorted by atom.
    powers: Vec<Rc<[(ExprId, i32)]>>,
    ids: FxHashMap<Rc<[(ExprId, i32)]>, MonomialId>,
    products: FxHashMap<u64, Parts>,
    expressions: FxHashMap<MonomialId, ExprId>,
}

impl Default for Monomials {
    fn default() -> Self {
        let one: Rc<[(ExprId, i32)]> = Rc::default();
        Self {
            powers: vec![one.clone()],
            ids: FxHashMap::from_iter([(one, Self::ONE)]),
            products: FxHashMap::default(),
            expressions: FxHashMap::default(),
        }
    }
}

impl Monomials {
    /// The product of nothing.
    pub const ONE: MonomialId = MonomialId(0);

    /// The monomial of powers that are sorted by atom.
    pub fn of(&mut self, powers: &[(ExprId, i32)]) -> MonomialId {
        if let Some(&known) = self.ids.get(powers) {
            return known;
        }
        let id = MonomialId(u32::try_from(self.powers.len()).unwrap_or(u32::MAX));
        let powers: Rc<[(ExprId, i32)]> = powers.into();
        self.powers.push(powers.clone());
        self.ids.insert(powers, id);
        id
    }

    /// Its powers, sorted by atom.
    pub fn powers(&self, monomial: MonomialId) -> Vec<(ExprId, i32)> {
        self.powers[monomial.0 as usize].to_vec()
    }

    /// The powers of a product of two, sorted by atom.
    pub fn joined(&self, a: MonomialId, b: MonomialId) -> Vec<(ExprId, i32)> {
        let [a, b] = [a, b].map(|id| &self.powers[id.0 as usize][..]);
        collected([a, b].concat())
    }

    /// The product of two, if it was found before.
    pub fn product(&self, a: MonomialId, b: MonomialId) -> Option<Parts> {
        self.products.get(&pair(a, b)).cloned()
    }

    /// Takes note of the product of two.
    pub fn keep_product(&mut self, a: MonomialId, b: MonomialId, parts: Parts) -> Parts {
        self.products.insert(pair(a, b), parts.clone());
        parts
    }

    /// It as an expression.
    pub fn expression(&mut self, monomial: MonomialId, graph: &mut Graph) -> ExprId {
        let powers = &self.powers[monomial.0 as usize];
        let known = self.expressions.entry(monomial);
        *known.or_insert_with(|| graph.power_product(powers))
    }

    /// The order of two by their powers.
    pub fn compare(&self, a: MonomialId, b: MonomialId) -> Ordering {
        let [a, b] = [a, b].map(|id| &self.powers[id.0 as usize]);
        let differs = a.iter().zip(b.iter()).find(|(a, b)| a != b);
        differs.map_or(a.len().cmp(&b.len()), |(a, b)| a.cmp(b))
    }
}

/// Powers sorted by atom, those of equal atoms joined.
pub(super) fn collected(mut powers: Vec<(ExprId, i32)>) -> Vec<(ExprId, i32)> {
    powers.sort_unstable_by_key(|(atom, _)| *atom);
    let mut joined: Vec<(ExprId, i32)> = Vec::with_capacity(powers.len());
    for (atom, n) in powers {
        match joined.last_mut() {
            Some((last, sum)) if *last == atom => *sum += n,
            _ => joined.push((atom, n)),
        }
    }
    joined.retain(|(_, n)| *n != 0);
    joined
}

fn pair(a: MonomialId, b: MonomialId) -> u64 {
    u64::from(a.0) << 32 | u64::from(b.0)
}
