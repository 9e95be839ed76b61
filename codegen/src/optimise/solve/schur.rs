//! `M` first, then the Schur complement.
//!
//! In:  entries of `M` and `A`.
//! Out: `M = L D Lᵀ`, `W = L⁻¹Aᵀ`, `S = Wᵀ D⁻¹ W = A M⁻¹ Aᵀ = Λ E Λᵀ`, and solves with
//!      them. The shorter way where coordinates that meet in `M` are few.

use super::algebra::{Algebra, Entry, Sparse};
use super::factors::Factors;
use super::order::minimum_degree;
use std::collections::BTreeSet;

/// A factorised `M` and `S`.
pub(super) struct Schur {
    /// The factors of `M`.
    pub mass: Factors,
    /// The factors of `S`.
    pub schur: Factors,
    /// `W`, a row for each constraint.
    rows: Vec<Vec<Entry>>,
    /// `D⁻¹ W`, likewise.
    scaled_rows: Vec<Vec<Entry>>,
}

impl Schur {
    /// `None` where `M` or `S` has a pivot that is zero by structure: a coordinate
    /// without inertia, or a constraint row that follows from the others. Likewise
    /// where the program becomes too long.
    pub fn of(
        algebra: &mut Algebra,
        mass: &Sparse,
        jacobian: &Sparse,
        (n, r): (usize, usize),
    ) -> Option<Self> {
        let mass = algebra.factorise(mass, minimum_degree(mass, n));
        if mass.given_up {
            return None;
        }
        let row = |i| (0..n).map(|j| jacobian.get(&(i, j)).copied()).collect();
        let rows: Vec<Vec<Entry>> = (0..r).map(|i| algebra.forward(&mass, row(i))).collect();
        let scaled_rows: Vec<Vec<Entry>> =
            rows.iter().map(|row| algebra.scaled(&mass, row)).collect();
        let mut schur = Sparse::new();
        let meeting = meeting(&rows, n);
        for (i, row) in rows.iter().enumerate() {
            if algebra.is_too_long() {
                return None;
            }
            for &j in meeting[i].range(..=i) {
                if let Some(entry) = algebra.dot(row, &scaled_rows[j], None) {
                    schur.insert((i, j), entry);
                    schur.insert((j, i), entry);
                }
            }
        }
        let schur = algebra.factorise(&schur, minimum_degree(&schur, r));
        (!schur.given_up).then_some(Self {
            mass,
            schur,
            rows,
            scaled_rows,
        })
    }

    /// `x` of `M x + Aᵀλ = driving`, `A x = target`.
    pub fn solve(
        &self,
        algebra: &mut Algebra,
        driving: Vec<Entry>,
        target: &[Entry],
    ) -> Vec<Entry> {
        let mut driving = algebra.forward(&self.mass, driving);
        let rows = self.scaled_rows.iter().zip(target);
        let gaps: Vec<Entry> = rows
            .map(|(row, target)| algebra.dot(row, &driving, *target))
            .collect();
        let gaps = algebra.forward(&self.schur, gaps);
        let gaps = algebra.scaled(&self.schur, &gaps);
        let multipliers = algebra.backward(&self.schur, gaps);
        for (row, multiplier) in self.rows.iter().zip(&multipliers) {
            for (entry, w) in driving.iter_mut().zip(row) {
                *entry = algebra.minus_product(*entry, *w, *multiplier);
            }
        }
        let driven = algebra.scaled(&self.mass, &driving);
        algebra.backward(&self.mass, driven)
    }
}

/// By row, the rows that have an entry where it has one.
fn meeting(rows: &[Vec<Entry>], n: usize) -> Vec<BTreeSet<usize>> {
    let present = |row: &Vec<Entry>| -> Vec<usize> {
        let entries = row.iter().enumerate();
        entries.filter_map(|(j, entry)| entry.map(|_| j)).collect()
    };
    let present: Vec<Vec<usize>> = rows.iter().map(present).collect();
    let mut by_coordinate = vec![Vec::new(); n];
    for (i, row) in present.iter().enumerate() {
        row.iter().for_each(|&j| by_coordinate[j].push(i));
    }
    let meeting = |row: &Vec<usize>| {
        row.iter()
            .flat_map(|&j| &by_coordinate[j])
            .copied()
            .collect()
    };
    present.iter().map(meeting).collect()
}
