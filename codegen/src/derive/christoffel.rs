//! The Coriolis matrix by Christoffel symbols [PH 2.3]:
//! `c_ij = ½ Σ_k (∂m_ij/∂q_k + ∂m_ik/∂q_j − ∂m_jk/∂q_i) q̇_k`.
//!
//! With it `Ṁ − 2C` is skew-symmetric. The simulation does not need it: it uses
//! the product `C q̇`, which `force` derives from `T` at a fraction of the cost.

use super::equations::Matrix;
use crate::expr::{ExprId, Number};
use crate::model::{Graph, Symbol};
use std::collections::{BTreeMap, BTreeSet};

/// `C(q, q̇)`, `N × N`, from the mass matrix.
pub fn coriolis_matrix(graph: &mut Graph, mass: &Matrix) -> Matrix {
    let slopes = Slopes::of(graph, mass);
    let indices = 0..mass.len();
    let rows = indices.clone().map(|i| {
        let row = indices.clone();
        row.map(|j| slopes.entry(graph, i, j)).collect()
    });
    rows.collect()
}

/// The derivatives of the mass matrix that are not zero: large ones are sparse.
struct Slopes {
    /// `∂m_ij/∂q_k`, by `(i, j)` and `k`.
    by_entry: BTreeMap<(usize, usize), BTreeMap<usize, ExprId>>,
    /// The `k` for which `∂m_ik/∂q_j` is one of these derivatives, by `(i, j)`.
    columns: BTreeMap<(usize, usize), Vec<usize>>,
}

impl Slopes {
    fn of(graph: &mut Graph, mass: &Matrix) -> Self {
        let mut by_entry = BTreeMap::new();
        let mut columns: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
        for (i, row) in mass.iter().enumerate() {
            for (k, &m) in row.iter().enumerate() {
                let mut of_entry = BTreeMap::new();
                for symbol in graph.symbols(m) {
                    let Symbol::Coordinate(j) = symbol else {
                        continue;
                    };
                    let slope = graph.differentiate(m, symbol);
                    if !graph.is_zero(slope) {
                        of_entry.insert(j as usize, slope);
                        columns.entry((i, j as usize)).or_default().push(k);
                    }
                }
                if !of_entry.is_empty() {
                    by_entry.insert((i, k), of_entry);
                }
            }
        }
        Self { by_entry, columns }
    }

    /// `c_ij`.
    fn entry(&self, graph: &mut Graph, i: usize, j: usize) -> ExprId {
        let half = Number::Exact(1, 2);
        let of_entry = self
            .by_entry
            .get(&(i, j))
            .into_iter()
            .flat_map(BTreeMap::keys);
        let of_rows = [(i, j), (j, i)]
            .into_iter()
            .flat_map(|pair| self.columns.get(&pair));
        let ks: BTreeSet<usize> = of_entry.chain(of_rows.flatten()).copied().collect();
        let mut terms = Vec::new();
        for k in ks {
            let parts = [((i, j), k, half), ((i, k), j, half), ((j, k), i, -half)];
            let parts = parts.into_iter().filter_map(|(entry, by, weight)| {
                let slope = self.by_entry.get(&entry)?.get(&by)?;
                Some((*slope, weight))
            });
            let symbol = graph.weighted_sum(Number::ZERO, &parts.collect::<Vec<_>>());
            let velocity = u32::try_from(k).unwrap_or(u32::MAX);
            let velocity = graph.symbol(Symbol::Velocity(velocity));
            terms.push(graph.mul(symbol, velocity));
        }
        graph.sum(terms)
    }
}
