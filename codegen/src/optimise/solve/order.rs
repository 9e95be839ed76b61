//! Orders of elimination of sparse symmetric matrices.
//!
//! In:  where a matrix has entries.
//! Out: an order in which elimination fills in little.
//!
//! Sources: minimum degree and minimum fill (Tinney & Walker 1967, "Direct solutions of
//! sparse network equations by optimally ordered triangular factorization").

use super::algebra::Sparse;
use std::collections::BTreeSet;

/// What is still to be eliminated: by row, the rows it has an entry with.
struct Elimination {
    neighbours: Vec<BTreeSet<usize>>,
    left: BTreeSet<usize>,
}

impl Elimination {
    fn of(matrix: &Sparse, size: usize) -> Self {
        let mut neighbours: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); size];
        for &(i, j) in matrix.keys().filter(|(i, j)| i != j) {
            neighbours[i].insert(j);
            neighbours[j].insert(i);
        }
        Self {
            neighbours,
            left: (0..size).collect(),
        }
    }

    /// Eliminates a row and returns its neighbours, which are then one another's.
    fn eliminate(&mut self, row: usize) -> BTreeSet<usize> {
        self.left.remove(&row);
        let around = std::mem::take(&mut self.neighbours[row]);
        for &i in &around {
            self.neighbours[i].remove(&row);
            self.neighbours[i].extend(around.iter().copied().filter(|&j| j != i));
        }
        around
    }

    /// How many entries the elimination of a row would bring.
    fn fill(&self, row: usize) -> usize {
        let around = &self.neighbours[row];
        let missing =
            |i: &usize| around.len() - 1 - around.intersection(&self.neighbours[*i]).count();
        around.iter().map(missing).sum::<usize>() / 2
    }
}

/// An order by minimum degree; of equals the first.
pub(super) fn minimum_degree(matrix: &Sparse, size: usize) -> Vec<usize> {
    let mut elimination = Elimination::of(matrix, size);
    let mut order = Vec::with_capacity(size);
    loop {
        let neighbours = &elimination.neighbours;
        let next = elimination
            .left
            .iter()
            .min_by_key(|&&i| (neighbours[i].len(), i));
        let Some(&next) = next else {
            return order;
        };
        elimination.eliminate(next);
        order.push(next);
    }
}

/// An order of a saddle point matrix `[M Aᵀ; A 0]` with `n` coordinates by minimum fill,
/// in which a multiplier comes after all coordinates of its row; of equals the one with
/// fewer neighbours, then the first.
pub(super) fn saddle_order(matrix: &Sparse, n: usize, size: usize) -> Vec<usize> {
    let mut elimination = Elimination::of(matrix, size);
    let mut awaited: Vec<usize> = elimination.neighbours.iter().map(BTreeSet::len).collect();
    awaited[..n].fill(0);
    let rows: Vec<Vec<usize>> = elimination.neighbours[..n]
        .iter()
        .map(|around| around.iter().copied().filter(|&i| i >= n).collect())
        .collect();
    let key = |elimination: &Elimination, i: usize| {
        (elimination.fill(i), elimination.neighbours[i].len(), i)
    };
    let ready = (0..size).filter(|&i| awaited[i] == 0);
    let mut queue: BTreeSet<_> = ready.map(|i| key(&elimination, i)).collect();
    let mut keys = vec![None; size];
    queue.iter().for_each(|&entry| keys[entry.2] = Some(entry));
    let mut order = Vec::with_capacity(size);
    while let Some((_, _, next)) = queue.pop_first() {
        order.push(next);
        let around = elimination.eliminate(next);
        let freed = rows.get(next).map_or(&[][..], Vec::as_slice);
        freed.iter().for_each(|&row| awaited[row] -= 1);
        // The fill of whatever is next to a row that has new neighbours may have changed.
        let mut touched: BTreeSet<usize> = around
            .iter()
            .copied()
            .chain(freed.iter().copied())
            .collect();
        for i in &around {
            touched.extend(&elimination.neighbours[*i]);
        }
        for i in touched.into_iter().filter(|&i| awaited[i] == 0) {
            if let Some(old) = keys[i].take() {
                queue.remove(&old);
            }
            let entry = key(&elimination, i);
            keys[i] = Some(entry);
            queue.insert(entry);
        }
    }
    order
}
