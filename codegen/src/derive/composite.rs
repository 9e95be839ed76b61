//! The mass matrix from bodies that move as one.
//!
//! In:  a kinetic energy in velocities that bodies share.
//! Out: `M`.
//!
//! Each shared velocity is replaced by what it is made of, the last one first. That adds the
//! inertia of its body, and of all bodies behind it, to that of the body before. These are the
//! sweeps of the composite-rigid-body algorithm (Featherstone, Rigid Body Dynamics Algorithms
//! (2008), section 6.2): the work for an entry is proportional to the number of velocities
//! that its body has in common with the one before it; derivatives of momenta would take that
//! for every outboard body.

use super::equations::Matrix;
use super::reduced::Reduced;
use crate::expr::{Arithmetic, ExprId, Symmetric};
use crate::model::Graph;

/// `M = Jᵀ M̃ J` of `n` coordinates.
pub(super) fn mass_matrix(graph: &mut Graph, reduced: &Reduced, n: usize) -> Matrix {
    let count = reduced.count;
    let rest = of_coordinates(graph, reduced, n, |entry| entry);
    let zero = graph.integer(0);
    let entry = |i, j| rest.entry(count + i, count + j).unwrap_or(zero);
    let row = |i| (0..n).map(|j| entry(i, j)).collect();
    (0..n).map(row).collect()
}

/// `M̃` after the replacement of all velocities that bodies share, in any arithmetic: what is
/// left are the entries of the `n` coordinates, behind those velocities.
pub(super) fn of_coordinates<A: Arithmetic>(
    arithmetic: &mut A,
    reduced: &Reduced,
    n: usize,
    value: impl Fn(ExprId) -> A::Value,
) -> Symmetric<A::Value> {
    let entries = reduced.mass.iter();
    let entries = entries.map(|&(i, j, entry)| ((i, j), value(entry)));
    let mut rest = Symmetric::of(entries, reduced.count + n);
    for (place, parts) in parts(reduced).iter().enumerate().rev() {
        let parts: Vec<_> = parts.iter().map(|&(i, g)| (i, value(g))).collect();
        rest.replace(arithmetic, place, &parts);
    }
    rest
}

/// For each shared velocity, the places of its parts and their coefficients.
pub(super) fn parts(reduced: &Reduced) -> Vec<Vec<(usize, ExprId)>> {
    let mut parts = vec![Vec::new(); reduced.count];
    for &(row, place, entry) in &reduced.links {
        parts[row].push((place, entry));
    }
    parts
}

impl Arithmetic for Graph {
    type Value = ExprId;

    fn plus(&mut self, x: Option<ExprId>, y: Option<ExprId>) -> Option<ExprId> {
        match (x, y) {
            (Some(x), Some(y)) => Some(self.add(x, y)).filter(|sum| !self.is_zero(*sum)),
            (one, None) | (None, one) => one,
        }
    }

    fn plus_product(
        &mut self,
        x: Option<ExprId>,
        a: Option<ExprId>,
        b: Option<ExprId>,
    ) -> Option<ExprId> {
        let product = a.zip(b).map(|(a, b)| self.mul(a, b));
        let product = product.filter(|product| !self.is_zero(*product));
        self.plus(x, product)
    }
}
