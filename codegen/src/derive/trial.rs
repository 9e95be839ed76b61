//! Numbers of `M` and `A` at trial positions, and motions without kinetic energy there.
//!
//! In:  a position, of which coordinates are random but for one that is given.
//! Out: [`Numbers`]: the sparse rows of both matrices; [`Numbers::without_inertia`].

use super::equations::Matrix;
use crate::expr::ExprId;
use crate::model::{Graph, Symbol};
use std::collections::BTreeMap;

/// What is left of a pivot of `M`, relative to the inertia of its coordinate, that is
/// round-off.
pub(super) const ROUND_OFF: f64 = 1e-10;

/// A sparse vector by coordinate.
pub(super) type Sparse = BTreeMap<usize, f64>;

/// A position at which expressions are evaluated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Position {
    /// The number of the random position.
    pub(super) random: u32,
    /// A coordinate that is not at random, and its value.
    pub(super) moved: Option<(u32, f64)>,
}

impl Position {
    pub(super) fn at_random(random: u32) -> Self {
        Self {
            random,
            moved: None,
        }
    }

    pub(super) fn value(self, symbol: Symbol) -> f64 {
        // Fractional parts of multiples of irrational numbers, between 0.3 and 1.3.
        let number = |i: u32, stride: f64| 0.3 + (stride * f64::from(i)).fract();
        let spread = |i: u32, stride: f64| number(i + 7 * self.random, stride);
        match (symbol, self.moved) {
            (Symbol::Coordinate(i), Some((moved, value))) if i == moved => value,
            (Symbol::Coordinate(i), _) => spread(i, 0.618_033_988_749_894_9),
            // Parameters and inputs are the same at all positions, as in a run.
            (Symbol::Parameter(i) | Symbol::Input(i), _) => number(i + 7, 0.414_213_562_373_095),
            (Symbol::Velocity(i), _) => spread(i, 0.732_050_807_568_877),
            _ => 1.0,
        }
    }

    /// The values of some expressions.
    pub(super) fn values(self, graph: &Graph, expressions: &[ExprId]) -> Vec<f64> {
        graph.evaluate_all(expressions, &|symbol| self.value(symbol))
    }

    /// `M` and `A`, if all their entries are finite.
    pub(super) fn numbers(
        self,
        graph: &Graph,
        mass: &Matrix,
        jacobian: &Matrix,
    ) -> Option<Numbers> {
        let entries = |matrix: &Matrix| -> Option<Vec<Sparse>> {
            let sparse = |row: &Vec<_>| {
                let values = self.values(graph, row).into_iter().enumerate();
                let row: Sparse = values.filter(|(_, x)| *x != 0.0).collect();
                row.values().all(|x| x.is_finite()).then_some(row)
            };
            matrix.iter().map(sparse).collect()
        };
        let mass = entries(mass)?;
        Some(Numbers {
            inertia: inertia(&mass),
            mass,
            jacobian: entries(jacobian)?,
        })
    }
}

/// The entries of `M` and `A` that differ from zero, row by row.
#[derive(Clone, Debug)]
pub(super) struct Numbers {
    pub(super) mass: Vec<Sparse>,
    pub(super) jacobian: Vec<Sparse>,
    /// The largest inertia that each coordinate has at the positions seen so far.
    inertia: Vec<f64>,
}

impl Numbers {
    /// Takes note of how much inertia coordinates have at another position.
    pub(super) fn observe(&mut self, other: &Self) {
        for (most, inertia) in self.inertia.iter_mut().zip(&other.inertia) {
            *most = most.max(*inertia);
        }
    }

    /// A basis of the motions without kinetic energy.
    pub(super) fn without_inertia(&self) -> Vec<Sparse> {
        let columns = decompose(&self.mass, &self.inertia);
        let none = columns
            .iter()
            .enumerate()
            .filter(|(_, pair)| pair.1.is_none());
        none.map(|(k, _)| {
            let mut motion = Sparse::from([(k, 1.0)]);
            for (i, (_, column)) in columns.iter().enumerate().skip(k + 1) {
                let moved = column.as_ref().map_or(0.0, |column| dot(column, &motion));
                if moved != 0.0 {
                    motion.insert(i, -moved);
                }
            }
            motion
        })
        .collect()
    }
}

/// The diagonal of `M`.
pub(super) fn inertia(mass: &[Sparse]) -> Vec<f64> {
    let entry = |(k, row): (usize, &Sparse)| row.get(&k).copied().unwrap_or(0.0);
    mass.iter().enumerate().map(entry).collect()
}

/// The pivots and columns of `M = U D Uᵀ`, last row first; no column where the pivot is
/// round-off of an inertia.
pub(super) fn decompose(mass: &[Sparse], inertia: &[f64]) -> Vec<(f64, Option<Sparse>)> {
    let mut rest = mass.to_vec();
    let mut columns = vec![(0.0, None); mass.len()];
    for k in (0..mass.len()).rev() {
        let row = std::mem::take(&mut rest[k]);
        let above: Sparse = row.range(..k).map(|(i, x)| (*i, *x)).collect();
        for i in above.keys() {
            rest[*i].remove(&k);
        }
        let pivot = row.get(&k).copied().unwrap_or(0.0);
        columns[k].0 = pivot;
        // The runtime refuses a negative mass.
        if pivot <= ROUND_OFF * inertia[k] {
            continue;
        }
        for (i, x) in &above {
            for (j, y) in &above {
                *rest[*i].entry(*j).or_insert(0.0) -= x * y / pivot;
            }
        }
        columns[k].1 = Some(above.into_iter().map(|(i, x)| (i, x / pivot)).collect());
    }
    columns
}

pub(super) fn dot(x: &Sparse, y: &Sparse) -> f64 {
    let (short, long) = if x.len() < y.len() { (x, y) } else { (y, x) };
    let product = |(i, x): (&usize, &f64)| long.get(i).map_or(0.0, |y| x * y);
    short.iter().map(product).sum()
}
