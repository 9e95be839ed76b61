//! A start in a singular position whose velocities go with several branches of motion.

use super::basis::{Basis, norm};
use super::numbers::{Numbers, Place};
use crate::diagnostic::{Diagnostic, Diagnostics};

/// How far from the start it is seen what velocities determine elsewhere, along them.
const ASIDE: f64 = 1e-2;
/// The part of a velocity that nothing determines, above which it is one.
const UNDETERMINED: f64 = 1e-3;
/// The part of a row, relative to the whole of it, that is round-off.
const ROUND_OFF: f64 = 1e-6;

/// Warns where the mechanism moves, nothing is guessed of the velocities that are not held, and
/// less of them follows from the constraints than does beside the start.
pub fn untold(
    numbers: &Numbers,
    start: &Place,
    (v, free): (&[f64], &[usize]),
    found: &mut Diagnostics,
) {
    let starts = &numbers.mechanism.starts;
    let speed = norm(v);
    let guesses = starts.iter().any(|start| start.velocity && !start.held);
    if guesses || speed == 0.0 {
        return;
    }
    let determined = span(numbers, start, free);
    let (rows, all) = (numbers.positions(), Vec::from_iter(0..v.len()));
    let beside = places_beside(numbers, start, v).find_map(|moved| {
        let end = numbers.assemble(&rows, &all, &moved)?;
        let there = numbers
            .errors(&rows, &end)
            .1
            .then(|| span(numbers, &end, free))?;
        (there.size() > determined.size()).then_some(there)
    });
    let Some(beside) = beside else {
        return;
    };
    let rest = |basis: &Basis, axis| norm(&basis.outside(axis, free.len()));
    let is_open = |axis: &usize| rest(&determined, *axis) > rest(&beside, *axis) + UNDETERMINED;
    let (Some(axis), Some(given)) = (
        (0..free.len()).find(is_open),
        starts
            .iter()
            .find(|start| start.velocity)
            .or(starts.first()),
    ) else {
        return;
    };
    let name = &numbers.mechanism.coordinates[free[axis]].name;
    let message = "several branches of motion meet at the start, and the velocities given there go \
                   with each of them";
    let help = format!(
        "give `der({name})`, too: `der({name}) ~ …;` chooses the nearest branch, without it the one \
         nearest to the least kinetic energy is taken"
    );
    found.push(Diagnostic::warning(given.span, message).help(help));
}

/// Places next to the start: along the velocities, which may lie in the middle between two
/// branches, and a little aside of them.
fn places_beside<'a>(
    numbers: &'a Numbers,
    start: &'a Place,
    v: &'a [f64],
) -> impl Iterator<Item = Place> + 'a {
    let speed = norm(v);
    [0, 1, 2].into_iter().flat_map(move |seed| {
        let random = numbers.random(seed);
        let aside: Vec<f64> = random.q.iter().zip(&start.q).map(|(a, b)| a - b).collect();
        let share = if seed == 0 { 0.0 } else { 0.5 / norm(&aside) };
        [ASIDE, -ASIDE].map(|distance| {
            let mut moved = start.clone();
            for (q, (v, aside)) in moved.q.iter_mut().zip(v.iter().zip(&aside)) {
                *q += distance * (v / speed + share * aside);
            }
            moved
        })
    })
}

/// What the constraints determine of the free velocities at a place.
fn span(numbers: &Numbers, place: &Place, free: &[usize]) -> Basis {
    let (_, rows, _) = numbers.velocity_level(place);
    let mut basis = Basis::default();
    for row in rows {
        let part: Vec<f64> = free.iter().map(|&j| row[j]).collect();
        if norm(&part) > ROUND_OFF * norm(&row) {
            basis.add(&part);
        }
    }
    basis
}
