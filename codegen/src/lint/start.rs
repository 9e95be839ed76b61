//! A start whose held values contradict the constraints, or leave the branch of motion open.

use super::branch;
use super::least_squares::minimise;
use super::numbers::{Numbers, Place};
use crate::diagnostic::{Diagnostic, Diagnostics, Span, figure};
use std::collections::BTreeMap;

/// An equation for velocities holds if its error is smaller than this, relative to
/// its terms: a run accepts as much beside a singular configuration.
const HOLDS: f64 = 5e-7;

/// An error smaller than this, relative to the largest one, is what the search left.
const ROUND_OFF: f64 = 1e-6;

/// Warns of start values that are no numbers with the parameters at their defaults;
/// whether there are any.
fn not_finite(numbers: &Numbers, found: &mut Diagnostics) -> bool {
    let (guess, _) = numbers.start();
    let mut any = false;
    for start in &numbers.mechanism.starts {
        if numbers.values(&[start.value], &guess)[0].is_finite() {
            continue;
        }
        any = true;
        let message = "this start value is not finite at the defaults of the parameters";
        let help = "a divisor is zero there, or a root or logarithm has no value";
        found.push(Diagnostic::warning(start.span, message).help(help));
    }
    any
}

/// Warns of a start that can't be assembled, with what each equation lacks: of the
/// constraints, and of the equations of the start behind them.
pub fn unassembled(numbers: &Numbers, found: &mut Diagnostics) {
    if not_finite(numbers, found) {
        return;
    }
    let rows = numbers.positions();
    let (guess, held) = numbers.start();
    let free: Vec<usize> = (0..held.len()).filter(|&i| !held[i]).collect();
    // At the guess all derivatives may vanish, so that no direction is better than another:
    // other guesses are tried, too.
    let disturbed = (1..=6).map(|seed| {
        let (mut place, random) = (guess.clone(), numbers.random(seed));
        free.iter().for_each(|&i| place.q[i] = random.q[i]);
        place
    });
    let mut best: Option<(f64, Vec<f64>)> = None;
    for place in [guess.clone()].into_iter().chain(disturbed) {
        let Some(end) = numbers.assemble(&rows, &free, &place) else {
            continue;
        };
        let (errors, holds) = numbers.errors(&rows, &end);
        if holds {
            return unassembled_velocities(numbers, &end, found);
        }
        let size = errors.iter().map(|e| e * e).sum();
        if best.as_ref().is_none_or(|(least, _)| size < *least) {
            best = Some((size, errors));
        }
    }
    if let Some((_, errors)) = best {
        let given = held.contains(&true) || of_start(numbers, &rows);
        let (message, help) = match given {
            true => (
                "the start can't be assembled: the constraints don't hold together with the held \
                 values",
                "write `~` for a value that may change, or correct the lengths",
            ),
            false => (
                "the start can't be assembled: no position was found at which all constraints hold",
                "correct the constraints or the lengths in them, or guess nearer with `~`",
            ),
        };
        let errors = rows.iter().copied().zip(errors);
        warn(numbers, (message, help), false, errors, found);
    }
}

fn unassembled_velocities(numbers: &Numbers, place: &Place, found: &mut Diagnostics) {
    let n = place.q.len();
    let (mut v, mut held) = (vec![0.0; n], vec![false; n]);
    for start in numbers
        .mechanism
        .starts
        .iter()
        .filter(|start| start.velocity)
    {
        v[start.coordinate] = numbers.values(&[start.value], place)[0];
        held[start.coordinate] = start.held;
    }
    let (rows, jacobian, drift) = numbers.velocity_level(place);
    let free: Vec<usize> = (0..n).filter(|&i| !held[i]).collect();
    let at = |x: &[f64]| {
        let mut v = v.clone();
        free.iter().zip(x).for_each(|(&i, x)| v[i] = *x);
        v
    };
    let speed = |v: &[f64]| -> Vec<f64> {
        let rows = jacobian.iter().zip(&drift);
        rows.map(|(row, b)| row.iter().zip(v).map(|(a, v)| a * v).sum::<f64>() + b)
            .collect()
    };
    let slopes: Vec<Vec<f64>> = jacobian
        .iter()
        .map(|row| free.iter().map(|&j| row[j]).collect())
        .collect();
    let guess: Vec<f64> = free.iter().map(|&i| v[i]).collect();
    let Some(x) = minimise(&guess, &|x| (speed(&at(x)), slopes.clone())) else {
        return;
    };
    let v = at(&x);
    let errors = speed(&v);
    let is_small = |error: f64, size: f64| error.abs() <= HOLDS * size;
    let slopes_at = |at: &Place| numbers.velocity_level(at).1;
    if !numbers.are_small(&errors, &is_small, (&jacobian, &v), &slopes_at) {
        let given = held.contains(&true) || of_start(numbers, &rows);
        let (message, help) = match given {
            true => (
                "the start can't be assembled: the held velocities contradict the constraints",
                "write `~` for a velocity that may change, or leave it out",
            ),
            false => (
                "the start can't be assembled: no velocities satisfy all constraints",
                "correct the constraints that contradict one another here",
            ),
        };
        let errors = rows.into_iter().zip(errors);
        return warn(numbers, (message, help), true, errors, found);
    }
    branch::untold(numbers, place, (&v, &free), found);
}

/// Whether an equation of the start is among the rows, which holds a value, too.
fn of_start(numbers: &Numbers, rows: &[usize]) -> bool {
    let constraints = numbers.mechanism.constraints.len();
    rows.iter().any(|row| *row >= constraints)
}

/// Warns at the first entry of the start block that gives a position, or a `velocity` (or the
/// first one of all, or the first constraint), with the error of each equation beside it.
fn warn(
    numbers: &Numbers,
    (message, help): (&str, &str),
    velocity: bool,
    errors: impl Iterator<Item = (usize, f64)>,
    found: &mut Diagnostics,
) {
    let mechanism = numbers.mechanism;
    let starts = || mechanism.starts.iter();
    let held = starts().filter(|start| start.held && start.velocity == velocity);
    let entries = held.chain(starts()).map(|start| start.span);
    let constraints = mechanism.constraints.iter();
    let constraints = constraints.chain(&mechanism.start_equations);
    let Some(span) = entries.chain(constraints.map(|row| row.span)).next() else {
        return;
    };
    let errors: Vec<(usize, f64)> = errors.collect();
    let largest = errors
        .iter()
        .fold(0.0, |most: f64, (_, e)| most.max(e.abs()));
    let lacking = errors
        .into_iter()
        .filter(|(_, e)| e.abs() > ROUND_OFF * largest);
    let mut beside: BTreeMap<Span, Vec<String>> = BTreeMap::new();
    for (row, error) in lacking {
        beside
            .entry(numbers.constraint(row).span)
            .or_default()
            .push(figure(error));
    }
    let mut warning = Diagnostic::warning(span, message).help(help);
    for (place, errors) in beside {
        warning = warning.also(
            place,
            format!("left minus right stays {}", errors.join(", ")),
        );
    }
    found.push(warning);
}
