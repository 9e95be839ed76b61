//! Coordinates put together, one after the other.
//!
//! In:  which coordinates belong together.
//! Out: [`Partition`]: the sets that this makes of all of them.

use super::equations::Matrix;
use crate::model::Graph;

/// Disjoint sets of coordinates, each named by its first.
#[derive(Clone, Debug)]
pub struct Partition {
    names: Vec<usize>,
}

impl Partition {
    /// Of `n` coordinates, each by itself.
    pub fn of(n: usize) -> Self {
        Self {
            names: (0..n).collect(),
        }
    }

    /// Puts the sets of some coordinates together.
    pub fn join(&mut self, together: impl IntoIterator<Item = usize>) {
        let named: Vec<usize> = together.into_iter().map(|i| self.names[i]).collect();
        let Some(&least) = named.iter().min() else {
            return;
        };
        for name in self.names.iter_mut().filter(|name| named.contains(name)) {
            *name = least;
        }
    }

    /// Puts together the sets of coordinates that a mass matrix couples.
    pub(super) fn join_coupled(&mut self, graph: &Graph, mass: &Matrix) {
        for (i, row) in mass.iter().enumerate() {
            let coupled = (0..row.len()).filter(|j| !graph.is_zero(row[*j]));
            self.join(coupled.chain([i]));
        }
    }

    /// The sets, in the order of their first coordinates.
    pub fn sets(&self) -> Vec<Vec<usize>> {
        let n = self.names.len();
        let first = |k: &usize| self.names[*k] == *k;
        let of = |k: usize| (0..n).filter(|i| self.names[*i] == k).collect();
        (0..n).filter(first).map(of).collect()
    }
}
