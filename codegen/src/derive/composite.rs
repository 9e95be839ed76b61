//! The mass matrix from bodies that move as one.
//!
//! In:  a kinetic energy in velocities that bodies share.
//! Out: `M`.
//!
//! A shared velocity is replaced by what it is made of, the last one first: what its body
//! resists with, and those behind it, is added to that of the body before. These are the
//! sweeps of the composite-rigid-body algorithm (Featherstone, Rigid Body Dynamics Algorithms
//! (2008), section 6.2): an entry takes as much work as its body has velocities in common with
//! the one before it, where the derivatives of a momentum take that for each body behind.

use super::equations::Matrix;
use super::reduced::Reduced;
use crate::expr::{ExprId, Graph};
use std::collections::BTreeMap;

/// `M = Jᵀ M̃ J` of `n` coordinates.
pub(super) fn mass_matrix(graph: &mut Graph, reduced: &Reduced, n: usize) -> Matrix {
    let count = reduced.count;
    let mut rest = Rest {
        rows: vec![BTreeMap::new(); count + n],
        zero: graph.integer(0),
    };
    for &(i, j, entry) in &reduced.mass {
        rest.rows[i].insert(j, entry);
    }
    let mut parts = vec![Vec::new(); count];
    for &(row, place, entry) in &reduced.links {
        parts[row].push((place, entry));
    }
    for (place, parts) in parts.iter().enumerate().rev() {
        rest.replace(graph, place, parts);
    }
    let row = |i| (0..n).map(|j| rest.entry(count + i, count + j)).collect();
    (0..n).map(row).collect()
}

/// A symmetric matrix in the velocities that are left, row by row.
struct Rest {
    rows: Vec<BTreeMap<usize, ExprId>>,
    zero: ExprId,
}

impl Rest {
    fn entry(&self, i: usize, j: usize) -> ExprId {
        self.rows[i].get(&j).copied().unwrap_or(self.zero)
    }

    /// For `w = Σ g_i u_i`, with `a` on the diagonal and `b_i` beside it:
    /// `m_ij += g_i a g_j + g_i b_j + b_i g_j`.
    fn replace(&mut self, graph: &mut Graph, place: usize, parts: &[(usize, ExprId)]) {
        let mut beside = std::mem::take(&mut self.rows[place]);
        let own = beside.remove(&place).unwrap_or(self.zero);
        for i in beside.keys() {
            self.rows[*i].remove(&place);
        }
        let zero = self.zero;
        let b = |i: usize| beside.get(&i).copied().unwrap_or(zero);
        for (k, &(i, g)) in parts.iter().enumerate() {
            let turned = graph.mul(own, g);
            let whole = graph.add(b(i), turned);
            let twice = graph.add(whole, b(i));
            self.add(graph, (i, i), (g, twice));
            for &(j, other) in &parts[..k] {
                self.add(graph, (i, j), (other, whole));
                self.add(graph, (i, j), (g, b(j)));
            }
            for (&j, &entry) in &beside {
                if parts.iter().all(|(part, _)| *part != j) {
                    self.add(graph, (i, j), (g, entry));
                }
            }
        }
    }

    /// Adds a product to an entry.
    fn add(&mut self, graph: &mut Graph, (i, j): (usize, usize), (a, b): (ExprId, ExprId)) {
        let product = graph.mul(a, b);
        if !graph.is_zero(product) {
            let sum = graph.add(self.entry(i, j), product);
            self.rows[i].insert(j, sum);
            self.rows[j].insert(i, sum);
        }
    }
}
