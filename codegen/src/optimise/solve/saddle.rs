//! Coordinates and multipliers in one elimination.
//!
//! In:  entries of `M` and `A`.
//! Out: `[M Aᵀ; A 0] = L D Lᵀ` in an order that fills in little, and solves with it. The
//!      shorter way where coordinates meet in `M` in long rows, whose `A M⁻¹ Aᵀ` is full.
//!
//! The pivot of a multiplier when some coordinates `C` and rows `B` are eliminated is
//! `−e`, and `e = max (a v)² / vᵀMv` over the motions `v` in which only coordinates of
//! `C` move and the rows of `B` hold. Where all coordinates move the same maximum is the
//! squared distance of the row from those of `B` in the metric `M⁻¹`, so `e` is never
//! above it: rows that are nearly dependent show in `e` before. Since a multiplier comes
//! after all coordinates of its row, the rows `B` and this one lie in `C` whole, and `e`
//! is zero only where they are dependent. The sizes `a M⁻¹ aᵀ` that pivots are compared
//! with, and the pivots of `M`, are those of the whole `M`.

use super::algebra::{Algebra, Entry, Pivot, Signed, Sparse};
use super::factors::Factors;
use super::order::{minimum_degree, saddle_order};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

/// A factorised saddle point matrix.
pub(super) struct Saddle {
    factors: Factors,
    /// The factors of `M`.
    pub mass: Factors,
    /// Bounds of the pivots of `A M⁻¹ Aᵀ` from below, and its diagonal entries.
    pub row_pivots: Vec<Pivot>,
}

impl Saddle {
    /// `None` where a pivot is zero by structure or the program becomes too long.
    pub fn of(
        algebra: &mut Algebra,
        mass: &Sparse,
        jacobian: &Sparse,
        (n, r): (usize, usize),
    ) -> Option<Self> {
        let mut matrix = mass.clone();
        for (&(i, j), &entry) in jacobian {
            matrix.insert((n + i, j), entry);
            matrix.insert((j, n + i), entry);
        }
        let order = saddle_order(&matrix, n, n + r);
        let factors = algebra.factorise(&matrix, order);
        if factors.given_up {
            return None;
        }
        let whole = algebra.factorise(mass, minimum_degree(mass, n));
        if whole.given_up {
            return None;
        }
        let squares = algebra.squares(&whole, jacobian, r)?;
        let pivots = &factors.pivots[n..];
        let row_pivots = pivots
            .iter()
            .zip(squares)
            .map(|(((minus, pivot), _), square)| ((!minus, *pivot), square))
            .collect();
        Some(Self {
            factors,
            mass: whole,
            row_pivots,
        })
    }

    /// `x` of `M x + Aᵀλ = driving`, `A x = target`.
    pub fn solve(
        &self,
        algebra: &mut Algebra,
        driving: Vec<Entry>,
        target: &[Entry],
    ) -> Vec<Entry> {
        let n = driving.len();
        let mut x = driving;
        x.extend(target);
        let x = algebra.forward(&self.factors, x);
        let x = algebra.scaled(&self.factors, &x);
        let mut x = algebra.backward(&self.factors, x);
        x.truncate(n);
        x
    }
}

impl Algebra {
    /// `a M⁻¹ aᵀ` for each row `a` of `A`; `None` where one is zero by structure or the
    /// program becomes too long.
    pub fn squares(&mut self, mass: &Factors, jacobian: &Sparse, r: usize) -> Option<Vec<Signed>> {
        let mut rows: Vec<Vec<(usize, Signed)>> = vec![Vec::new(); r];
        for (&(i, j), &entry) in jacobian {
            rows[i].push((j, entry));
        }
        let inverse = self.inverse_entries(mass, &rows)?;
        let between = |i: usize, j: usize| inverse.get(&(i.min(j), i.max(j))).copied().flatten();
        let mut squares = Vec::with_capacity(r);
        for row in &rows {
            let entries: Vec<Entry> = row.iter().map(|(_, entry)| Some(*entry)).collect();
            let mut turned = Vec::with_capacity(row.len());
            for (i, _) in row {
                let line: Vec<Entry> = row.iter().map(|(j, _)| between(*i, *j)).collect();
                turned.push(self.dot(&line, &entries, None));
            }
            squares.push(self.dot(&entries, &turned, None)?);
        }
        Some(squares)
    }

    /// The entries of `M⁻¹` where rows have coordinates, by coordinates in ascending
    /// order, without the rest of it: `Z = D⁻¹ L⁻¹ + (1 − Lᵀ) Z` (Takahashi, Fagan & Chin
    /// 1973, "Formation of a sparse bus impedance matrix and its application to short
    /// circuit study").
    fn inverse_entries(
        &mut self,
        mass: &Factors,
        rows: &[Vec<(usize, Signed)>],
    ) -> Option<BTreeMap<(usize, usize), Entry>> {
        let mut place = vec![0; mass.order.len()];
        for (step, &i) in mass.order.iter().enumerate() {
            place[i] = step;
        }
        // The one that is eliminated first comes first.
        let ordered = |i: usize, j: usize| if place[i] <= place[j] { (i, j) } else { (j, i) };
        let wanted = |row: &Vec<(usize, Signed)>| -> Vec<(usize, usize)> {
            let pairs = row.iter().enumerate();
            pairs
                .flat_map(|(k, (i, _))| row[..=k].iter().map(|(j, _)| ordered(*i, *j)))
                .collect()
        };
        let mut pending: Vec<(usize, usize)> = rows.iter().flat_map(wanted).collect();
        let mut needed: BTreeSet<(Reverse<usize>, Reverse<usize>)> = BTreeSet::new();
        while let Some((i, j)) = pending.pop() {
            if needed.insert((Reverse(place[i]), Reverse(place[j]))) {
                pending.extend(mass.columns[i].iter().map(|(k, _)| ordered(*k, j)));
            }
        }
        // Descending: what an entry is made of comes before it.
        let mut entries = BTreeMap::new();
        for (Reverse(first), Reverse(second)) in needed {
            if self.is_too_long() {
                return None;
            }
            let (i, j) = (mass.order[first], mass.order[second]);
            let mut entry = (i == j).then_some(mass.inverse[i]);
            for &(k, factor) in &mass.columns[i] {
                let other = entries.get(&(k.min(j), k.max(j))).copied().flatten();
                entry = self.minus_product(entry, Some(factor), other);
            }
            entries.insert((i.min(j), i.max(j)), entry);
        }
        Some(entries)
    }
}
