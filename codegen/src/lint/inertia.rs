//! Coordinates that move without kinetic energy and that no constraint restricts.

use super::basis::{Basis, norm};
use super::numbers::{Numbers, Place};
use crate::diagnostic::{Diagnostic, Diagnostics};

/// A unit vector with a larger part outside the span of `M` and `A` is free there.
const FREE: f64 = 1e-4;

/// Warns of coordinates along which neither `M` nor `A` has anything to say, at
/// every random position.
pub fn massless(numbers: &Numbers, found: &mut Diagnostics) {
    let samples = numbers.samples();
    let Some((first, others)) = samples.split_first() else {
        return;
    };
    let everywhere = |i: &usize| {
        others
            .iter()
            .all(|place| free_at(numbers, place).contains(i))
    };
    for i in free_at(numbers, first).into_iter().filter(everywhere) {
        let coordinate = &numbers.mechanism.coordinates[i];
        let name = &coordinate.name;
        let message =
            format!("`{name}` can move without kinetic energy and no constraint restricts it");
        let help =
            format!("give it inertia, for example `kinetic 1/2*m*der({name})^2;`, or a constraint");
        found.push(Diagnostic::warning(coordinate.span, message).help(help));
    }
}

/// The coordinates that can move freely at a place: as many as there are free
/// directions, those that take the greatest part in them.
fn free_at(numbers: &Numbers, place: &Place) -> Vec<usize> {
    let n = place.q.len();
    let mut basis = Basis::default();
    for row in numbers.jacobian(place).iter().chain(&numbers.mass(place)) {
        if row.iter().any(|x| !x.is_finite()) {
            return Vec::new();
        }
        basis.add(row);
    }
    let mut free = Vec::new();
    loop {
        let parts = (0..n).map(|i| basis.outside(i, n));
        let most = parts
            .enumerate()
            .max_by(|(_, a), (_, b)| norm(a).total_cmp(&norm(b)));
        match most {
            Some((i, part)) if norm(&part) > FREE && !free.contains(&i) => {
                basis.add(&part);
                free.push(i);
            }
            _ => return free,
        }
    }
}
