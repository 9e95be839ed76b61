//! A kinetic energy that is negative for some velocities.

use super::numbers::{Numbers, Place};
use crate::diagnostic::{Diagnostic, Diagnostics};

/// What is left of a semidefinite matrix is round-off up to this part of its largest
/// entry.
const ROUND_OFF: f64 = 1e-12;

/// Warns of the summand that makes the kinetic energy negative, at the start or at a
/// random position; whether there is one.
pub fn energy(numbers: &Numbers, found: &mut Diagnostics) -> bool {
    let start = numbers.start().0;
    let mut places = [&start].into_iter().chain(numbers.samples());
    let negative = places.find_map(|place| Some((place, direction(&numbers.mass(place))?)));
    let Some((place, v)) = negative else {
        return false;
    };
    let mass = numbers.mass(place);
    let share = |i: usize| v[i] * mass[i].iter().zip(&v).map(|(m, v)| m * v).sum::<f64>();
    let most = (0..v.len()).min_by(|&i, &j| share(i).total_cmp(&share(j)));
    let coordinate = &numbers.mechanism.coordinates[most.unwrap_or(0)].name;
    let worst = summand(numbers, place, &v);
    let message = format!("the kinetic energy is negative where `{coordinate}` moves");
    let help = "a mass or moment of inertia is negative, or a sign is wrong";
    let span = numbers.mechanism.kinetic[worst].span;
    found.push(Diagnostic::warning(span, message).help(help));
    true
}

/// The summand that has the least energy at a velocity.
fn summand(numbers: &Numbers, place: &Place, v: &[f64]) -> usize {
    let kinetic = numbers.mechanism.kinetic.iter();
    let values: Vec<_> = kinetic.map(|summand| summand.value).collect();
    let back: Vec<f64> = v.iter().map(|v| -v).collect();
    // Terms of first degree cancel.
    let [there, back] = [v, &back].map(|v| numbers.moving(&values, place, v));
    let energy = |i: &usize| there[*i] + back[*i];
    (0..values.len())
        .min_by(|i, j| energy(i).total_cmp(&energy(j)))
        .unwrap_or(0)
}

/// A velocity at which `vᵀ M v` is negative: by Cholesky's elimination, the largest pivot
/// first, which carries the directions along.
fn direction(mass: &[Vec<f64>]) -> Option<Vec<f64>> {
    let n = mass.len();
    if mass.iter().flatten().any(|x| !x.is_finite()) {
        return None;
    }
    let size = |i: usize| match mass[i][i].abs() {
        0.0 => 1.0,
        inertia => 1.0 / inertia.sqrt(),
    };
    let unit = |i: usize| (0..n).map(|j| if i == j { size(i) } else { 0.0 }).collect();
    let mut directions: Vec<Vec<f64>> = (0..n).map(unit).collect();
    let scaled = |i: usize| (0..n).map(|j| size(i) * mass[i][j] * size(j)).collect();
    let mut rest: Vec<Vec<f64>> = (0..n).map(scaled).collect();
    let largest = rest
        .iter()
        .flatten()
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    let floor = ROUND_OFF * largest;
    let mut left: Vec<usize> = (0..n).collect();
    while let Some(place) = (0..left.len()).max_by(|&a, &b| {
        let pivot = |at: usize| rest[left[at]][left[at]];
        pivot(a).total_cmp(&pivot(b))
    }) {
        let p = left[place];
        if rest[p][p] <= floor {
            break;
        }
        left.swap_remove(place);
        let (row, along) = (rest[p].clone(), directions[p].clone());
        for &j in &left {
            let factor = row[j] / row[p];
            let direction = directions[j].iter_mut().zip(&along);
            direction.for_each(|(x, a)| *x -= factor * a);
            left.iter().for_each(|&i| rest[j][i] -= factor * row[i]);
        }
    }
    least(&rest, &directions, &left).and_then(|(v, energy)| (energy < -floor).then_some(v))
}

/// The direction of least energy among what is left and the sums and differences of two.
fn least(rest: &[Vec<f64>], directions: &[Vec<f64>], left: &[usize]) -> Option<(Vec<f64>, f64)> {
    let pairs = left.iter().flat_map(|&i| left.iter().map(move |&j| (i, j)));
    let energies = pairs.map(|(i, j)| match i == j {
        true => (i, j, 0.0, rest[i][i]),
        false => {
            let mixed = rest[i][j];
            let energy = rest[i][i] + rest[j][j] - 2.0 * mixed.abs();
            (i, j, -mixed.signum(), energy)
        }
    });
    let (i, j, sign, energy) = energies.min_by(|a, b| a.3.total_cmp(&b.3))?;
    let sum = directions[i].iter().zip(&directions[j]);
    Some((sum.map(|(x, y)| x + sign * y).collect(), energy))
}
