//! Constraint equations that say nothing: whose derivatives vanish where they hold,
//! or that follow from others.

use super::basis::{Basis, norm};
use super::numbers::{Numbers, Place};
use crate::diagnostic::{Diagnostic, Diagnostics, Span};
use std::collections::BTreeSet;

/// Derivatives that shrink below this on the way to where the equation holds may vanish
/// there: an error of 1e-16 at a double zero leaves a slope of 1e-8.
const VANISHED: f64 = 1e-4;
/// They do if this part of what the equation would be at their zero is no more than its error and
/// round-off: next to a double zero `e` the slope is `√(2·e·curvature)`.
const IS_ZERO: f64 = 0.25;
/// A coefficient below this is round-off.
const TAKES_PART: f64 = 1e-5;
/// What is true at this many random positions is taken to be true.
pub const ENOUGH: usize = 2;

/// The equations for positions whose derivatives vanish where they hold by
/// themselves, from every random position.
pub fn flat(numbers: &Numbers) -> BTreeSet<usize> {
    let rows = numbers.positions().into_iter();
    rows.filter(|&row| is_flat(numbers, row)).collect()
}

fn is_flat(numbers: &Numbers, row: usize) -> bool {
    let starts = numbers.random_positions();
    let judged: Vec<bool> = starts
        .filter_map(|start| flattens(numbers, row, &start))
        .collect();
    judged.len() >= ENOUGH && judged.iter().all(|flat| *flat)
}

/// Whether the derivatives vanish on the way from a place to one where the equation
/// holds; `None` if there is none.
fn flattens(numbers: &Numbers, row: usize, start: &Place) -> Option<bool> {
    let all: Vec<usize> = (0..start.q.len()).collect();
    let slope = |place: &Place| norm(&numbers.values_and_jacobian(&[row], &all, place).1[0]);
    let end = numbers.assemble(&[row], &all, start)?;
    let (errors, holds) = numbers.errors(&[row], &end);
    let (before, after) = (slope(start), slope(&end));
    let moved: Vec<f64> = start.q.iter().zip(&end.q).map(|(a, b)| a - b).collect();
    // The equation at the zero of its derivatives, if it is quadratic: where a distance is far
    // smaller than the coordinates, its square has small derivatives, too.
    let extremum = after * after * norm(&moved) / (2.0 * before);
    let round_off = f64::EPSILON * before * norm(&start.q).max(1.0);
    let is_double = IS_ZERO * extremum <= errors[0].abs() + round_off;
    holds.then_some(after <= VANISHED * before && is_double)
}

/// Warns of equations whose derivatives vanish where they hold.
pub fn warn_of_flat(numbers: &Numbers, flat: &BTreeSet<usize>, found: &mut Diagnostics) {
    for &row in flat {
        let constraint = numbers.constraint(row);
        let message = format!(
            "the derivatives of `{}` vanish where it holds",
            constraint.text
        );
        let warning = Diagnostic::warning(constraint.span, message);
        let help = "write it so that it passes through zero there: \
                    `phi = 0` instead of `1 - cos(phi) = 0`, `a = b` instead of `norm2(a - b) = 0`";
        found.push(warning.labelled("no force can keep it").help(help));
    }
}

/// Warns of equations that follow from others.
pub fn warn_of_redundant(numbers: &Numbers, flat: &BTreeSet<usize>, found: &mut Diagnostics) {
    let samples = numbers.samples().iter();
    let mut judged: Vec<_> = samples.map(|place| dependent(numbers, place)).collect();
    if judged.len() < ENOUGH || judged.iter().any(Vec::is_empty) {
        return;
    }
    // Random positions may all come to lie on a branch of which the motion knows nothing.
    let start = numbers.assembled();
    judged.extend(start.map(|place| dependent(numbers, &place)));
    let Some((first, others)) = judged.split_first() else {
        return;
    };
    for (row, partners) in first {
        let everywhere = others
            .iter()
            .all(|there| there.iter().any(|(r, _)| r == row));
        if everywhere && !flat.contains(row) {
            found.push(redundant(numbers, *row, partners));
        }
    }
}

fn redundant(numbers: &Numbers, row: usize, partners: &[usize]) -> Diagnostic {
    let span = numbers.constraint(row).span;
    let message = format!(
        "`{}` follows from the other constraints",
        numbers.constraint(row).text
    );
    let help = "it may stay: the motion is the same without it, but the reactions are not unique";
    let mut warning = Diagnostic::warning(span, message).help(help);
    let places = partners.iter().map(|&r| numbers.constraint(r).span);
    let places: BTreeSet<Span> = places.collect();
    for place in places.into_iter().filter(|place| *place != span) {
        warning = warning.also(place, "from this");
    }
    warning
}

/// The rows of `A` that depend on rows above them, each with those.
fn dependent(numbers: &Numbers, place: &Place) -> Vec<(usize, Vec<usize>)> {
    let mut basis = Basis::default();
    let mut found = Vec::new();
    for (row, slopes) in numbers.jacobian(place).iter().enumerate() {
        if let Some(coefficients) = basis.add(slopes) {
            let partners = coefficients.iter().enumerate();
            let partners = partners
                .filter(|(_, c)| c.abs() > TAKES_PART)
                .map(|(r, _)| r);
            found.push((row, partners.collect()));
        }
    }
    found
}
