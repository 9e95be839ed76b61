//! Symmetric matrices in which one unknown after the other is taken out.
//!
//! In:  entries in any arithmetic, where what is zero by structure is absent.
//! Out: [`Symmetric`]: what is left of them.

use std::collections::BTreeMap;

/// What entries are computed in.
pub trait Arithmetic {
    /// An entry that is not zero by structure.
    type Value: Copy;

    /// `x + y`.
    fn plus(&mut self, x: Option<Self::Value>, y: Option<Self::Value>) -> Option<Self::Value>;

    /// `x + a·b`.
    fn plus_product(
        &mut self,
        x: Option<Self::Value>,
        a: Option<Self::Value>,
        b: Option<Self::Value>,
    ) -> Option<Self::Value>;
}

/// What is left of a symmetric matrix, row by row.
pub struct Symmetric<V>(Vec<BTreeMap<usize, V>>);

impl<V: Copy> Symmetric<V> {
    /// A matrix with these entries, those of both triangles.
    pub fn of(entries: impl Iterator<Item = ((usize, usize), V)>, size: usize) -> Self {
        let mut rows = vec![BTreeMap::new(); size];
        for ((i, j), entry) in entries {
            rows[i].insert(j, entry);
        }
        Self(rows)
    }

    /// An entry.
    pub fn entry(&self, i: usize, j: usize) -> Option<V> {
        self.0[i].get(&j).copied()
    }

    /// Takes a row out, and its column: what is on the diagonal, and what is beside it.
    pub fn take(&mut self, row: usize) -> (Option<V>, BTreeMap<usize, V>) {
        let mut beside = std::mem::take(&mut self.0[row]);
        let own = beside.remove(&row);
        for i in beside.keys() {
            self.0[*i].remove(&row);
        }
        (own, beside)
    }

    /// Adds a product to an entry.
    pub fn add(
        &mut self,
        arithmetic: &mut impl Arithmetic<Value = V>,
        (i, j): (usize, usize),
        (a, b): (Option<V>, Option<V>),
    ) {
        let sum = arithmetic.plus_product(self.entry(i, j), a, b);
        for (i, j) in [(i, j), (j, i)] {
            match sum {
                Some(sum) => self.0[i].insert(j, sum),
                None => self.0[i].remove(&j),
            };
        }
    }

    /// Replaces an unknown by a sum of others: for `w = Σ g_i u_i`, with `a` on the diagonal
    /// and `b_i` beside it, `m_ij += g_i a g_j + g_i b_j + b_i g_j`.
    pub fn replace(
        &mut self,
        arithmetic: &mut impl Arithmetic<Value = V>,
        place: usize,
        parts: &[(usize, V)],
    ) {
        let (own, beside) = self.take(place);
        for (k, &(i, g)) in parts.iter().enumerate() {
            let b = beside.get(&i).copied();
            let whole = arithmetic.plus_product(b, own, Some(g));
            let twice = arithmetic.plus(whole, b);
            self.add(arithmetic, (i, i), (Some(g), twice));
            for &(j, other) in &parts[..k] {
                self.add(arithmetic, (i, j), (Some(other), whole));
                self.add(arithmetic, (i, j), (Some(g), beside.get(&j).copied()));
            }
            for (&j, &entry) in &beside {
                if parts.iter().all(|(part, _)| *part != j) {
                    self.add(arithmetic, (i, j), (Some(g), Some(entry)));
                }
            }
        }
    }
}
