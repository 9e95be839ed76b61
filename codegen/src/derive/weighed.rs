//! Constraint rows that take part in the metric.
//!
//! In:  `M` and `A`.
//! Out: [`Weighed`]: the fewest rows `a` with which `M + Σ w aᵀa` is definite, none where `M` is;
//!      whether there are positions at which that isn't, either.
//!
//! The mass matrix of a body in Euler parameters is singular, and so is that of a
//! coordinate without inertia. Whether a mass matrix is singular at all positions is tested at
//! random ones. Only rows that restrict the motions without inertia at every position are
//! named: a row each, if one does by itself, else all that do together. Where neither holds, the
//! runtime lets all rows take part. Rows that couple coordinates which `M` couples already are
//! preferred, so that elimination stays as sparse.
//!
//! A mass matrix that is definite almost everywhere may be singular at some positions. All rows
//! take part that restrict the motions without inertia there; where none does, constraints may
//! become dependent there, too, without a row that becomes weak in the metric.

use super::equations::Matrix;
use super::trial::{Numbers, Position, ROUND_OFF, Sparse, dot};
use super::vanishing::singular_positions;
use crate::model::Graph;
use std::collections::{BTreeMap, BTreeSet};

/// Random positions at which the same rows must do, where all entries are finite.
const POSITIONS: u32 = 4;

/// What is known of the metric.
#[derive(Clone, Debug, Default)]
pub(super) struct Weighed {
    /// The rows of `A` that take part in it, in ascending order.
    pub(super) rows: Vec<usize>,
    /// Whether the metric is singular at some positions.
    pub(super) degenerates: bool,
}

/// What takes part in the metric; nothing where `M` is not derived.
pub(super) fn weighed(graph: &Graph, mass: Option<&Matrix>, jacobian: &Matrix) -> Weighed {
    let Some(mass) = mass.filter(|_| !jacobian.is_empty()) else {
        return Weighed::default();
    };
    let positions = (1..=POSITIONS).map(Position::at_random);
    let mut numbers = positions.filter_map(|position| position.numbers(graph, mass, jacobian));
    let Some(first) = numbers.next() else {
        return Weighed::default();
    };
    if first.without_inertia().is_empty() {
        return where_singular(graph, mass, jacobian, &first);
    }
    let others: Vec<Numbers> = numbers.collect();
    Weighed {
        rows: everywhere(&first, &others),
        degenerates: false,
    }
}

/// The rows that restrict motions without inertia at all positions.
fn everywhere(first: &Numbers, others: &[Numbers]) -> Vec<usize> {
    let holds = holds_at(first);
    let last = others.iter().all(|numbers| {
        let other = holds_at(numbers);
        let pairs = holds.iter().zip(&other);
        holds.len() == other.len() && pairs.clone().all(|(one, other)| one.lasts(other))
    });
    if last {
        return holds.into_iter().map(|hold| hold.row).collect();
    }
    // If no rows hold all motions at one position, none do so at all positions.
    if holds.is_empty() {
        return Vec::new();
    }
    let together = Together::at(first);
    let mut others = others.iter();
    match others.all(|numbers| Together::at(numbers).is_like(&together)) {
        true => together.rows,
        false => Vec::new(),
    }
}

/// The rows that restrict motions without inertia at some positions.
fn where_singular(graph: &Graph, mass: &Matrix, jacobian: &Matrix, usual: &Numbers) -> Weighed {
    let (mut rows, mut degenerates) = (BTreeSet::new(), false);
    for position in singular_positions(graph, mass) {
        let Some(mut numbers) = position.numbers(graph, mass, jacobian) else {
            continue;
        };
        numbers.observe(usual);
        match holds_at(&numbers).is_empty() {
            true => degenerates = true,
            false => rows.extend(restricting(&numbers.jacobian, &numbers.without_inertia())),
        }
    }
    Weighed {
        rows: rows.into_iter().collect(),
        degenerates,
    }
}

/// All rows that restrict motions without inertia, and how they do so together: the rows of both
/// ends of a rod without mass hold its angle wherever it points, though none of them does alone.
struct Together {
    rows: Vec<usize>,
    /// The motions, of length one.
    motions: Vec<Sparse>,
    /// For each two motions that one row restricts, the sum over all rows of the product of the row
    /// with the one times that with the other.
    grips: BTreeMap<(usize, usize), f64>,
}

impl Together {
    fn at(numbers: &Numbers) -> Self {
        let (jacobian, mut motions) = (&numbers.jacobian, numbers.without_inertia());
        let rows = restricting(jacobian, &motions);
        for motion in &mut motions {
            let size = dot(motion, motion).sqrt();
            motion.values_mut().for_each(|x| *x /= size);
        }
        let mut grips = BTreeMap::new();
        for row in &rows {
            let products = motions.iter().map(|motion| dot(&jacobian[*row], motion));
            let products = products.enumerate().filter(|(_, product)| *product != 0.0);
            let products: Vec<(usize, f64)> = products.collect();
            for (i, one) in &products {
                for (j, other) in &products {
                    *grips.entry((*i, *j)).or_insert(0.0) += one * other;
                }
            }
        }
        Self {
            rows,
            motions,
            grips,
        }
    }

    /// Whether the same rows hold the same motions as firmly at another position.
    fn is_like(&self, other: &Self) -> bool {
        let most = self.grips.values().fold(0.0, |most: f64, x| most.max(*x));
        let motions = self.motions.iter().zip(&other.motions);
        let mut products = motions.map(|(one, other)| dot(one, other));
        let mut grips = self.grips.iter().zip(&other.grips);
        self.rows == other.rows
            && self.motions.len() == other.motions.len()
            && self.grips.len() == other.grips.len()
            && products.all(|product| product >= 1.0 - ROUND_OFF)
            && grips.all(|((a, x), (b, y))| a == b && (x - y).abs() <= ROUND_OFF * most)
    }
}

/// A row and how it holds a motion without inertia.
struct Hold {
    row: usize,
    /// The row times the motion of length one.
    grip: f64,
    /// The cosine of the angle between the two.
    cosine: f64,
}

impl Hold {
    /// Whether the row restricts the motion at all positions, not by chance at these: its gradient
    /// is parallel to the motion at both positions, or constant. Any other gradient may become
    /// perpendicular to the motion somewhere.
    fn lasts(&self, other: &Self) -> bool {
        let along = self.cosine.min(other.cosine) > 1.0 - ROUND_OFF;
        let constant = (self.grip - other.grip).abs() <= ROUND_OFF * self.grip;
        self.row == other.row && (along || constant)
    }
}

/// The rows at one position, in ascending order; none where they do not hold every motion
/// without inertia.
fn holds_at(numbers: &Numbers) -> Vec<Hold> {
    let (mass, jacobian) = (&numbers.mass, &numbers.jacobian);
    let mut motions = numbers.without_inertia();
    let mut order: Vec<usize> = (0..jacobian.len()).collect();
    order.sort_by_key(|row| (joined(mass, &jacobian[*row]), jacobian[*row].len()));
    let mut holds = Vec::new();
    for row in order {
        holds.extend(take_hold(&mut motions, row, &jacobian[row]));
        if motions.is_empty() {
            holds.sort_by_key(|hold| hold.row);
            return holds;
        }
    }
    Vec::new()
}

/// The rows that restrict some of these motions.
fn restricting(jacobian: &[Sparse], motions: &[Sparse]) -> Vec<usize> {
    let restricts = |row: &Sparse, motion: &Sparse| {
        let most = (dot(row, row) * dot(motion, motion)).sqrt();
        dot(row, motion).abs() > ROUND_OFF.sqrt() * most
    };
    let any = |row: &usize| {
        motions
            .iter()
            .any(|motion| restricts(&jacobian[*row], motion))
    };
    (0..jacobian.len()).filter(any).collect()
}

/// How many pairs of coordinates a row would join that `M` does not.
fn joined(mass: &[Sparse], row: &Sparse) -> usize {
    let pairs = row.keys().flat_map(|i| row.keys().map(move |j| (i, j)));
    pairs.filter(|(i, j)| !mass[**i].contains_key(j)).count()
}

/// How a row restricts one of the motions, if it restricts any; that motion is then removed,
/// and the others are combined with it so that the row does not restrict them.
fn take_hold(motions: &mut Vec<Sparse>, row: usize, entries: &Sparse) -> Option<Hold> {
    let size = |x: &Sparse| dot(x, x).sqrt();
    let grip = |motion: &Sparse| dot(entries, motion).abs() / size(motion);
    let grips = motions.iter().map(grip).enumerate();
    let (place, grip) = grips.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let cosine = grip / size(entries);
    // The cosine of a row of zeros is NaN, with which comparisons are false.
    let restricts = cosine > ROUND_OFF.sqrt();
    if !restricts {
        return None;
    }
    let held = motions.swap_remove(place);
    let whole = dot(entries, &held);
    for motion in motions {
        let share = dot(entries, motion) / whole;
        if share != 0.0 {
            for (j, x) in &held {
                *motion.entry(*j).or_insert(0.0) -= share * x;
            }
        }
    }
    Some(Hold { row, grip, cosine })
}
