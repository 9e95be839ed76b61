//! Positions at which a mass matrix is singular that is definite almost everywhere.
//!
//! In:  `M`.
//! Out: for each coordinate, a position at which a block of `M` is singular that depends on it,
//!      if there is one.
//!
//! Where the inertia of a coordinate vanishes: that of a rod without mass about a pin, on which
//! a slider runs across the pin. Where motions without kinetic energy take several coordinates:
//! two rods without mass with a particle at their end, where they are in line. As the positions
//! are those at which one function of the coordinates, the determinant, is zero, they are found
//! along lines of one coordinate each. Of many coordinates that are coupled, each with few others,
//! each two are looked at by themselves.

use super::equations::Matrix;
use super::partition::Partition;
use super::trial::{Position, ROUND_OFF, Sparse, decompose, inertia};
use crate::expr::ExprId;
use crate::model::{Graph, Node, Symbol};
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// A block with at most so many coordinates is searched as a whole.
const FEW: usize = 8;
/// Of many coordinates, the coupled pairs are searched if there are at most so many for each
/// coordinate: in a long chain each is coupled with all.
const NEIGHBOURS: usize = 4;
/// A block is searched if its expressions times the coordinates that they depend on are at most so
/// many: more would take noticeable time.
const MOST_WORK: usize = 50_000;
/// Positions of a coordinate at which a block is sampled.
const SAMPLES: usize = 16;
/// A pivot that vanishes is searched for where a sample is at most this part of an inertia.
const SMALL: f64 = 0.3;
/// Narrowings of an interval by the golden section.
const NARROWINGS: usize = 40;

/// A position in each line along which a block of `M` becomes singular.
pub(super) fn singular_positions(graph: &Graph, mass: &Matrix) -> Vec<Position> {
    let blocks = blocks(graph, mass).into_iter();
    blocks
        .filter(|block| block.work <= MOST_WORK)
        .flat_map(|block| {
            let search = |coordinate: &u32| Line::along(graph, &block, *coordinate).singular();
            block
                .coordinates
                .iter()
                .filter_map(search)
                .collect::<Vec<_>>()
        })
        .collect()
}

/// A block on the diagonal of `M`.
struct Block {
    size: usize,
    /// All entries, row by row.
    entries: Vec<ExprId>,
    /// The coordinates that the entries depend on.
    coordinates: Vec<u32>,
    /// How many expressions the entries are made of, times the number of these coordinates.
    work: usize,
}

fn blocks(graph: &Graph, mass: &Matrix) -> Vec<Block> {
    let mut partition = Partition::of(mass.len());
    partition.join_coupled(graph, mass);
    let searched = partition.sets().into_iter().flat_map(|rows| {
        if rows.len() <= FEW {
            return vec![rows];
        }
        let coupled = |i: &usize, j: &usize| i < j && !graph.is_zero(mass[*i][*j]);
        let pairs = rows.iter().flat_map(|i| rows.iter().map(move |j| (i, j)));
        let pairs = pairs.filter(|(i, j)| coupled(i, j));
        let pairs: Vec<Vec<usize>> = pairs.map(|(i, j)| vec![*i, *j]).collect();
        match pairs.len() <= rows.len() * NEIGHBOURS {
            true => pairs,
            false => Vec::new(),
        }
    });
    searched.map(|rows| block(graph, mass, &rows)).collect()
}

fn block(graph: &Graph, mass: &Matrix, rows: &[usize]) -> Block {
    let pairs = rows.iter().flat_map(|i| rows.iter().map(|j| (*i, *j)));
    let entries: Vec<ExprId> = pairs.map(|(i, j)| mass[i][j]).collect();
    let coordinate = |e: &ExprId| match graph.node(*e) {
        Node::Symbol(Symbol::Coordinate(i)) => Some(*i),
        _ => None,
    };
    let reachable = graph.reachable(&entries);
    let coordinates: BTreeSet<u32> = reachable.iter().filter_map(coordinate).collect();
    Block {
        size: rows.len(),
        work: reachable.len() * coordinates.len(),
        entries,
        coordinates: coordinates.into_iter().collect(),
    }
}

/// A line of one coordinate, along which the pivots of a block are looked at.
struct Line<'a> {
    graph: &'a Graph,
    block: &'a Block,
    coordinate: u32,
    /// The largest inertia that the coordinates of the block have.
    inertia: Vec<f64>,
}

impl<'a> Line<'a> {
    fn along(graph: &'a Graph, block: &'a Block, coordinate: u32) -> Self {
        let mut line = Self {
            graph,
            block,
            coordinate,
            inertia: vec![0.0; block.size],
        };
        for sample in 0..SAMPLES {
            let seen = inertia(&line.mass_at(place(sample)));
            for (most, inertia) in line.inertia.iter_mut().zip(seen) {
                *most = most.max(inertia);
            }
        }
        line
    }

    fn at(&self, value: f64) -> Position {
        Position {
            random: 1,
            moved: Some((self.coordinate, value)),
        }
    }

    fn mass_at(&self, value: f64) -> Vec<Sparse> {
        let values = self.at(value).values(self.graph, &self.block.entries);
        let rows = values.chunks(self.block.size);
        rows.map(|row| row.iter().copied().enumerate().collect())
            .collect()
    }

    /// The smallest pivot, relative to the inertia of its coordinate.
    fn smallest_pivot(&self, value: f64) -> f64 {
        let columns = decompose(&self.mass_at(value), &self.inertia);
        let pairs = columns.iter().zip(&self.inertia);
        pairs.fold(f64::INFINITY, |least, ((pivot, _), inertia)| {
            least.min(pivot / inertia)
        })
    }

    /// Where the smallest pivot is zero.
    fn singular(&self) -> Option<Position> {
        let pivots: Vec<f64> = (0..SAMPLES)
            .map(|k| self.smallest_pivot(place(k)))
            .collect();
        let nearest = (0..SAMPLES).min_by(|i, j| pivots[*i].total_cmp(&pivots[*j]))?;
        let middle = nearest.clamp(1, SAMPLES - 2);
        // A pivot that is a square looks like a parabola, whose vertex may be between samples.
        let vertex = vertex(middle, &pivots);
        let is_singular = |value: &f64| self.smallest_pivot(*value) <= ROUND_OFF;
        let lowest = || self.lowest(place(nearest) - SPACING, place(nearest) + SPACING);
        let found = Some(vertex).filter(is_singular);
        let found = found.or_else(|| {
            let searched = pivots[nearest] <= SMALL;
            searched.then(lowest).filter(is_singular)
        });
        found.map(|value| self.at(value))
    }

    /// Where the smallest pivot is least in an interval.
    fn lowest(&self, mut from: f64, mut to: f64) -> f64 {
        let part = 2.0 / (1.0 + 5.0_f64.sqrt());
        let inside = |from: f64, to: f64| [to - part * (to - from), from + part * (to - from)];
        let [mut left, mut right] = inside(from, to);
        let [mut at_left, mut at_right] = [left, right].map(|value| self.smallest_pivot(value));
        for _ in 0..NARROWINGS {
            if at_left < at_right {
                (to, right, at_right) = (right, left, at_left);
                left = inside(from, to)[0];
                at_left = self.smallest_pivot(left);
            } else {
                (from, left, at_left) = (left, right, at_right);
                right = inside(from, to)[1];
                at_right = self.smallest_pivot(right);
            }
        }
        (from + to) / 2.0
    }
}

/// The distance of the samples of a line.
const SPACING: f64 = 2.0 * PI / SAMPLES as f64;

/// The place of a sample in a line, over a turn.
fn place(sample: usize) -> f64 {
    sample as f64 * SPACING - PI
}

/// The vertex of the parabola through the pivots at three samples.
fn vertex(middle: usize, pivots: &[f64]) -> f64 {
    let [before, here, after] = [-1, 0, 1].map(|step| pivots[middle.wrapping_add_signed(step)]);
    let (slope, curvature) = ((after - before) / 2.0, after + before - 2.0 * here);
    place(middle) - SPACING * slope / curvature
}
