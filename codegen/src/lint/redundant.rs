//! Constraint equations that a solve can leave out.
//!
//! In:  constraint rows at random positions that satisfy the constraints.
//! Out: rows that follow from the others at all of them, chosen so that the others are as far
//!      from dependence as can be.
//!
//! A run verifies it: where the rows that stay are nearly dependent, or the rank is another
//! one, it chooses rows by itself.

use super::basis::{INSIDE, dot, norm, subtract};
use super::numbers::{Numbers, Place};
use super::rows::ENOUGH;

/// Rows that are farther from the others than this are independent.
const REGULAR: f64 = 1e-3;

/// The rows that follow from the others wherever the constraints hold, in ascending order.
pub fn rows(numbers: &Numbers) -> Vec<usize> {
    let rows = at_samples(numbers).unwrap_or_default();
    if rows.is_empty() {
        return rows;
    }
    // Rows that follow with some parameters only are solved with: with others they are needed. A
    // mechanism that can't be assembled with others is what it is.
    match at_samples(&numbers.varied()) {
        Some(others) if others.len() != rows.len() => others,
        _ => rows,
    }
}

/// The same with parameters as they are; `None` where the constraints hold at too few positions.
fn at_samples(numbers: &Numbers) -> Option<Vec<usize>> {
    let samples = numbers.samples();
    if samples.len() < ENOUGH {
        return None;
    }
    let mut places: Vec<Vec<Vec<f64>>> = samples
        .iter()
        .map(|place| directions(numbers, place))
        .collect();
    let count = places[0].len();
    let mut left: Vec<usize> = (0..count).collect();
    let mut chosen = Vec::new();
    while let Some(best) = farthest(numbers, &places, &left) {
        left.retain(|row| *row != best);
        places.iter_mut().for_each(|rows| remove(rows, best, &left));
        chosen.push(best);
    }
    // A row that follows at some positions only may be needed at others.
    let follows = |row: &usize| places.iter().all(|rows| norm(&rows[*row]) <= INSIDE);
    Some(
        match left.iter().all(follows) && may_follow_at_start(numbers, &chosen, &left) {
            true => left,
            false => Vec::new(),
        },
    )
}

/// Whether the start does not contradict that rows follow from the chosen ones: random positions
/// may all come to lie on a branch of which the motion knows nothing.
fn may_follow_at_start(numbers: &Numbers, chosen: &[usize], left: &[usize]) -> bool {
    if left.is_empty() {
        return true;
    }
    let Some(start) = numbers.assembled() else {
        return true;
    };
    let mut rows = directions(numbers, &start);
    let order = [chosen, left].concat();
    for (place, &best) in chosen.iter().enumerate() {
        // A start at which rows depend that do not elsewhere is singular, and tells nothing.
        if norm(&rows[best]) <= REGULAR {
            return true;
        }
        remove(&mut rows, best, &order[place + 1..]);
    }
    left.iter().all(|row| norm(&rows[*row]) <= INSIDE)
}

/// The rows of `A` at a place, of length one where each coordinate is measured by its own inertia,
/// or zero.
fn directions(numbers: &Numbers, place: &Place) -> Vec<Vec<f64>> {
    let mass = numbers.mass(place);
    let diagonal = mass.iter().enumerate().map(|(j, row)| row[j]);
    let weights: Vec<f64> = diagonal
        .map(|m| if m > 0.0 { m.sqrt() } else { 1.0 })
        .collect();
    let direction = |row: Vec<f64>| {
        let weighed: Vec<f64> = row.iter().zip(&weights).map(|(a, w)| a / w).collect();
        match norm(&weighed) {
            0.0 => weighed,
            length => weighed.iter().map(|a| a / length).collect(),
        }
    };
    numbers.jacobian(place).into_iter().map(direction).collect()
}

/// The row that is the farthest from those that were removed, where it is the nearest to them; of
/// those that are not in their span a row that restricts positions, if there is one.
fn farthest(numbers: &Numbers, places: &[Vec<Vec<f64>>], left: &[usize]) -> Option<usize> {
    let distance = |row: usize| {
        let distances = places.iter().map(|rows| norm(&rows[row]));
        // What is not a number stays.
        distances.fold(1.0, |least, x| if x >= least { least } else { x })
    };
    let rows = left.iter().map(|&row| (row, distance(row)));
    let outside = rows.filter(|(_, distance)| *distance > INSIDE);
    let restricts_positions = |row: usize| numbers.constraint(row).holonomic;
    let best = outside.max_by(|(row, distance), (other, farther)| {
        let kinds = restricts_positions(*row).cmp(&restricts_positions(*other));
        // Of equals the first one stays.
        let order = kinds.then(distance.total_cmp(farther));
        order.then(other.cmp(row))
    });
    best.map(|(row, _)| row)
}

/// Removes what the rows that are left have along another.
fn remove(rows: &mut [Vec<f64>], best: usize, left: &[usize]) {
    let length = norm(&rows[best]);
    let unit: Vec<f64> = rows[best].iter().map(|x| x / length).collect();
    for &row in left {
        let along = dot(&unit, &rows[row]);
        subtract(&mut rows[row], along, &unit);
    }
}
