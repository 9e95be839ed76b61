//! Constraints that are near an extremum, which they do not take where they hold.
//!
//! In:  a position, a row whose gradient is much smaller there than elsewhere.
//! Out: whether the row is only small, and no branches meet where it vanishes.
//!
//! The gradient of `|p − s|² = L²` is far smaller at a distance `L` than at the distance of
//! `p` and `s` from the origin. It vanishes at `p = s`, and there the constraint does not
//! hold. Where branches cross, the gradient grows along itself.

use super::erased::Constrained;
use crate::Real;
use crate::equations::At;
use crate::linalg::{Workspace, add_scaled, dot};
use crate::natural_size::NaturalSizes;
use crate::tolerance::{critical, round_off};

/// Corrections that lead to the extremum; the first one does where the constraint is quadratic.
const CORRECTIONS: usize = 4;
/// How far the first one looks, in sizes of the coordinates.
const LOOK: f64 = 1e-3;
/// A gradient that is smaller by this factor vanishes.
const VANISHED: f64 = 1e-3;

/// A line along the gradient of a row.
struct Line<'a, T> {
    row: usize,
    start: At<'a, T>,
    /// The sizes of the coordinates.
    sizes: &'a [T],
    direction: &'a [T],
    /// The position, and the gradient there, where the row was evaluated last.
    q: &'a mut [T],
    gradient: &'a mut [T],
}

impl<T: Real> Line<'_, T> {
    /// How fast the row changes along the line at a place on it.
    fn slope(&mut self, solver: &mut dyn Constrained<T>, place: T) -> T {
        self.q.copy_from_slice(self.start.q);
        add_scaled(self.q, place, self.direction);
        solver.locate(self.start.t, self.q);
        load_gradient(solver, self.row, self.gradient);
        dot(self.gradient, self.direction)
    }
}

/// Whether the gradient of a row vanishes along itself, at a position that clearly violates the
/// constraint.
pub(super) fn is_near_extremum<T: Real>(
    solver: &mut dyn Constrained<T>,
    start: At<'_, T>,
    row: usize,
    workspace: &Workspace<'_, T>,
) -> bool {
    let [q, gradient, direction, sizes] = [(); 4].map(|()| workspace.numbers(start.q.len()));
    let natural = NaturalSizes::measure(solver.structure(), start.q);
    for (j, size) in sizes.iter_mut().enumerate() {
        let kind = solver.structure().kind(j);
        *size = kind.and_then(|kind| natural.of(kind)).unwrap_or(T::one());
    }
    solver.locate(start.t, start.q);
    load_gradient(solver, row, gradient);
    for (target, (entry, size)) in direction.iter_mut().zip(gradient.iter().zip(&*sizes)) {
        *target = *entry * *size * *size;
    }
    let most = largest_change(gradient, sizes);
    let line = Line {
        row,
        start,
        sizes,
        direction,
        q,
        gradient,
    };
    let left = residual_at_extremum(line, solver, most);
    left.is_some_and(|left| left.abs() > critical::<T>() * round_off::<T>() * most)
}

/// What the row is where its gradient vanishes along itself; `most` is how much the row changes
/// at the start with the coordinate that changes it most.
fn residual_at_extremum<T: Real>(
    mut line: Line<'_, T>,
    solver: &mut dyn Constrained<T>,
    most: T,
) -> Option<T> {
    let mut places = [T::zero(), T::from_f64(LOOK) / most];
    let mut slopes = places.map(|place| line.slope(solver, place));
    for _ in 0..CORRECTIONS {
        let change = (slopes[1] - slopes[0]) / (places[1] - places[0]);
        places = [places[1], places[1] - slopes[1] / change];
        if !places[1].is_finite() {
            return None;
        }
        slopes = [slopes[1], line.slope(solver, places[1])];
        if largest_change(line.gradient, line.sizes) <= most * T::from_f64(VANISHED) {
            return Some(solver.constraints().residual[line.row]);
        }
    }
    None
}

/// By how much a row changes with the coordinate that changes it most, by its size.
fn largest_change<T: Real>(gradient: &[T], sizes: &[T]) -> T {
    let changes = gradient.iter().zip(sizes);
    changes.fold(T::zero(), |most, (entry, size)| {
        most.max(entry.abs() * *size)
    })
}

/// Takes the gradient of a row where the constraints were evaluated last.
fn load_gradient<T: Real>(solver: &dyn Constrained<T>, row: usize, gradient: &mut [T]) {
    let jacobian = solver.constraints().jacobian;
    let entries = jacobian.iter().skip(row).step_by(solver.known().r());
    for (target, entry) in gradient.iter_mut().zip(entries) {
        *target = *entry;
    }
}
