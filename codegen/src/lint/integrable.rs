//! Constraints of velocities that are rates of equations for positions.
//!
//! In:  the coefficients `a` and `b` of rows `a·q̇ + b = 0` near random positions.
//! Out: warnings: a run keeps such a velocity, and nothing keeps the position from drifting, which
//!      beside a singular configuration leads onto another branch of motion.
//!
//! A row is a rate where its coefficients are a gradient: `∂aᵢ/∂qⱼ = ∂aⱼ/∂qᵢ`, `∂aᵢ/∂t = ∂b/∂qᵢ`
//! (Frobenius, without an integrating factor). Rows of constant coefficients, such as those of
//! gears, drift by round-off alone and lose no rank, and are left alone.

use super::basis::norm;
use super::numbers::{Numbers, Place};
use crate::diagnostic::{Diagnostic, Diagnostics};

/// Distance of the positions that differences are taken between.
const ASIDE: f64 = 1e-5;
/// Derivatives are equal to this part of the largest one.
const EQUAL: f64 = 1e-6;

/// Warns of constraints of velocities that are rates of equations for positions.
pub fn rates(numbers: &Numbers, found: &mut Diagnostics) {
    for row in numbers.velocities() {
        if numbers
            .random_positions()
            .all(|place| is_gradient(numbers, row, &place))
        {
            let constraint = numbers.constraint(row);
            let message = format!(
                "`{}` is the rate of an equation for positions",
                constraint.text
            );
            let warning = Diagnostic::warning(constraint.span, message);
            let help = "write that equation as the constraint, with its constant as a parameter: \
                        a run keeps positions to round-off";
            found.push(
                warning
                    .labelled("nothing keeps the positions from drifting")
                    .help(help),
            );
        }
    }
}

/// Whether the coefficients of a row are the gradient of a function, not of a linear one, as far
/// as their derivatives at a place tell.
fn is_gradient(numbers: &Numbers, row: usize, place: &Place) -> bool {
    let n = place.q.len();
    // The time, as the last coordinate, has the coefficient `b`.
    let coefficients = |moved: usize, by: f64| {
        let mut there = place.clone();
        match there.q.get_mut(moved) {
            Some(q) => *q += by,
            None => there.t += by,
        }
        numbers.coefficients(row, &there)
    };
    let derivatives: Vec<Vec<f64>> = (0..=n)
        .map(|j| {
            let (ahead, behind) = (coefficients(j, ASIDE), coefficients(j, -ASIDE));
            let change = ahead.iter().zip(&behind).map(|(a, b)| a - b);
            change.map(|change| change / (2.0 * ASIDE)).collect()
        })
        .collect();
    // A law of time in `b` alone is a speed that is prescribed.
    let changes = derivatives.iter().map(|of| norm(&of[..n]));
    let most = changes.fold(0.0, f64::max);
    // Comparisons with NaN are false, so that what has no value is no gradient.
    let varies = most > EQUAL * norm(&numbers.coefficients(row, place));
    let symmetric = (0..=n)
        .all(|i| (0..i).all(|j| (derivatives[i][j] - derivatives[j][i]).abs() <= EQUAL * most));
    varies && symmetric
}
