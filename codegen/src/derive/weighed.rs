//! Constraint rows that take part in the metric.
//!
//! In:  `M` and `A`.
//! Out: the fewest rows `a` with which `M + Σ w aᵀa` is definite: none where `M` is.
//!
//! The mass matrix of a body in Euler parameters is singular, and so is that of a
//! coordinate without inertia. Whether a mass matrix is singular at all positions is tested at
//! random ones. Only rows that restrict the motions without inertia at every position are
//! named: a row each, if one does by itself, else all that do together. Where neither holds, the
//! runtime lets all rows take part. Rows that couple coordinates which `M` couples already are
//! preferred, so that elimination stays as sparse.
//!
//! A mass matrix that is definite almost everywhere may be singular where the inertia of a
//! coordinate vanishes: that of a rod without mass about a pin, on which a slider runs across the
//! pin. There all rows that restrict the motion take part.

use super::equations::Matrix;
use crate::expr::ExprId;
use crate::model::{Graph, Symbol};
use std::collections::{BTreeMap, BTreeSet};

/// Random positions at which the same rows must do, where all entries are finite.
const POSITIONS: u32 = 4;
/// What is left of a diagonal entry of `M`, relative to it, that is round-off.
const ROUND_OFF: f64 = 1e-10;
/// Coordinates on which an inertia may depend, so that it is looked at where it vanishes.
const FEW: usize = 8;

/// A sparse vector by coordinate.
type Sparse = BTreeMap<usize, f64>;

/// The rows of `A` that take part in the metric, in ascending order.
pub(super) fn weighed(graph: &Graph, mass: &Matrix, jacobian: &Matrix) -> Vec<usize> {
    if jacobian.is_empty() {
        return Vec::new();
    }
    let positions = (1..=POSITIONS).map(Position::at_random);
    let mut numbers = positions.filter_map(|position| position.numbers(graph, mass, jacobian));
    let Some((first_mass, first_jacobian)) = numbers.next() else {
        return Vec::new();
    };
    if without_inertia(&first_mass).is_empty() {
        return where_inertia_vanishes(graph, mass, jacobian);
    }
    let others: Vec<_> = numbers.collect();
    let first = holds_at(&first_mass, &first_jacobian);
    let last = others.iter().all(|(mass, jacobian)| {
        let other = holds_at(mass, jacobian);
        let pairs = first.iter().zip(&other);
        first.len() == other.len() && pairs.clone().all(|(one, other)| one.lasts(other))
    });
    if last {
        return first.into_iter().map(|hold| hold.row).collect();
    }
    // Where they do not hold all motions at one position, nothing does at all of them.
    if first.is_empty() {
        return Vec::new();
    }
    let together = Together::at(&first_mass, &first_jacobian);
    let mut others = others.iter();
    let last = others.all(|(mass, jacobian)| Together::at(mass, jacobian).is_like(&together));
    match last {
        true => together.rows,
        false => Vec::new(),
    }
}

/// All rows that restrict motions without inertia, and how they do together: those of both
/// ends of a rod without mass hold its angle wherever it points, though none of them does alone.
struct Together {
    rows: Vec<usize>,
    /// The motions, of length one.
    motions: Vec<Sparse>,
    /// For two of them that a row restricts, the sum over the rows of the products of a row with
    /// both.
    grips: BTreeMap<(usize, usize), f64>,
}

impl Together {
    fn at(mass: &[Sparse], jacobian: &[Sparse]) -> Self {
        let mut motions = without_inertia(mass);
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
    /// Whether the row restricts the motion at all positions, not by chance at these: its
    /// gradient is parallel to the motion at both, or constant. Any other may become
    /// perpendicular to the motion somewhere.
    fn lasts(&self, other: &Self) -> bool {
        let along = self.cosine.min(other.cosine) > 1.0 - ROUND_OFF;
        let constant = (self.grip - other.grip).abs() <= ROUND_OFF * self.grip;
        self.row == other.row && (along || constant)
    }
}

/// The rows at one position, in ascending order; none where they do not hold every motion
/// without inertia.
fn holds_at(mass: &[Sparse], jacobian: &[Sparse]) -> Vec<Hold> {
    let mut motions = without_inertia(mass);
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

/// A position at which expressions are evaluated.
#[derive(Clone, Copy)]
struct Position {
    /// Which of the random ones.
    random: u32,
    /// A coordinate that differs from it, and its value.
    moved: Option<(u32, f64)>,
}

impl Position {
    fn at_random(random: u32) -> Self {
        Self {
            random,
            moved: None,
        }
    }

    fn value(self, symbol: Symbol) -> f64 {
        // Fractional parts of multiples of irrational numbers, between 0.3 and 1.3.
        let number = |i: u32, stride: f64| 0.3 + (stride * f64::from(i)).fract();
        let spread = |i: u32, stride: f64| number(i + 7 * self.random, stride);
        match (symbol, self.moved) {
            (Symbol::Coordinate(i), Some((moved, value))) if i == moved => value,
            (Symbol::Coordinate(i), _) => spread(i, 0.618_033_988_749_894_9),
            // The same ones everywhere, as in a run.
            (Symbol::Parameter(i) | Symbol::Input(i), _) => number(i + 7, 0.414_213_562_373_095),
            (Symbol::Velocity(i), _) => spread(i, 0.732_050_807_568_877),
            _ => 1.0,
        }
    }

    /// The entries of `M` and `A` that differ from zero, row by row, if all are finite.
    fn numbers(
        self,
        graph: &Graph,
        mass: &Matrix,
        jacobian: &Matrix,
    ) -> Option<(Vec<Sparse>, Vec<Sparse>)> {
        let entries = |matrix: &Matrix| -> Option<Vec<Sparse>> {
            let sparse = |row: &Vec<_>| {
                let values = graph.evaluate_all(row, &|symbol| self.value(symbol));
                let row: Sparse = values
                    .into_iter()
                    .enumerate()
                    .filter(|(_, x)| *x != 0.0)
                    .collect();
                row.values().all(|x| x.is_finite()).then_some(row)
            };
            matrix.iter().map(sparse).collect()
        };
        Some((entries(mass)?, entries(jacobian)?))
    }
}

/// The rows that restrict motions whose inertia vanishes at some positions only.
fn where_inertia_vanishes(graph: &Graph, mass: &Matrix, jacobian: &Matrix) -> Vec<usize> {
    let mut rows = BTreeSet::new();
    for (k, row) in mass.iter().enumerate() {
        for position in zeros_of(graph, row[k]) {
            let numbers = position.numbers(graph, mass, jacobian);
            if let Some((mut mass, jacobian)) = numbers {
                remove(&mut mass, k);
                rows.extend(holding(&mass, &jacobian));
            }
        }
    }
    rows.into_iter().collect()
}

/// Takes a coordinate without inertia out of `M`.
fn remove(mass: &mut [Sparse], coordinate: usize) {
    mass[coordinate].clear();
    for row in mass {
        row.remove(&coordinate);
    }
}

/// The rows that restrict motions without inertia at one position; none where they do not hold
/// all of them.
fn holding(mass: &[Sparse], jacobian: &[Sparse]) -> Vec<usize> {
    if holds_at(mass, jacobian).is_empty() {
        return Vec::new();
    }
    restricting(jacobian, &without_inertia(mass))
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

/// Positions at which an inertia vanishes, where it is a square of one coordinate, from where
/// that is zero or another length.
fn zeros_of(graph: &Graph, inertia: ExprId) -> Vec<Position> {
    let coordinates = graph.symbols(inertia).into_iter();
    let coordinates: Vec<u32> = coordinates
        .filter_map(|symbol| match symbol {
            Symbol::Coordinate(i) => Some(i),
            _ => None,
        })
        .collect();
    if coordinates.len() > FEW {
        return Vec::new();
    }
    let zero = |coordinate: u32| {
        let at = |value: f64| Position {
            random: 1,
            moved: Some((coordinate, value)),
        };
        let inertia_at = |value: f64| graph.evaluate(inertia, &|symbol| at(value).value(symbol));
        let [before, here, after] = [-1.0, 0.0, 1.0].map(inertia_at);
        let (slope, curvature) = ((after - before) / 2.0, after + before - 2.0 * here);
        let lowest = -slope / curvature;
        // False for NaN, too.
        let vanishes = inertia_at(lowest) <= ROUND_OFF * after.max(before);
        vanishes.then(|| at(lowest))
    };
    coordinates.into_iter().filter_map(zero).collect()
}

/// A basis of the motions without kinetic energy: from `M = U D Uᵀ`, last row first.
fn without_inertia(mass: &[Sparse]) -> Vec<Sparse> {
    let mut rest = mass.to_vec();
    let mut columns: Vec<Option<Sparse>> = vec![None; mass.len()];
    for k in (0..mass.len()).rev() {
        let row = std::mem::take(&mut rest[k]);
        let above: Sparse = row.range(..k).map(|(i, x)| (*i, *x)).collect();
        for i in above.keys() {
            rest[*i].remove(&k);
        }
        let pivot = row.get(&k).copied().unwrap_or(0.0);
        // The runtime refuses a negative mass.
        if pivot <= ROUND_OFF * mass[k].get(&k).copied().unwrap_or(0.0) {
            continue;
        }
        for (i, x) in &above {
            for (j, y) in &above {
                *rest[*i].entry(*j).or_insert(0.0) -= x * y / pivot;
            }
        }
        columns[k] = Some(above.into_iter().map(|(i, x)| (i, x / pivot)).collect());
    }
    let none = (0..mass.len()).filter(|k| columns[*k].is_none());
    none.map(|k| {
        let mut motion = Sparse::from([(k, 1.0)]);
        for (i, column) in columns.iter().enumerate().skip(k + 1) {
            let moved = column.as_ref().map_or(0.0, |column| dot(column, &motion));
            if moved != 0.0 {
                motion.insert(i, -moved);
            }
        }
        motion
    })
    .collect()
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
    // False for NaN, too: a row of zeros.
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

fn dot(x: &Sparse, y: &Sparse) -> f64 {
    let (short, long) = if x.len() < y.len() { (x, y) } else { (y, x) };
    let product = |(i, x): (&usize, &f64)| long.get(i).map_or(0.0, |y| x * y);
    short.iter().map(product).sum()
}
