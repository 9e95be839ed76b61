//! Constraints that lose their gradient where they hold, and can't be crossed there.
//!
//! In:  an assembled position, the scales of the guess that led to it.
//! Out: such a constraint, if there is one.
//!
//! A sum of squares that is zero is of this kind. It holds at a point, or on a set of fewer
//! dimensions than one equation leaves, and that set is found only up to the root of
//! round-off: a run would go on in steps as small as that.

use super::scales::Scales;
use crate::Real;
use crate::equations::Equations;
use crate::linalg::{Workspace, add_scaled, dot, independent_columns, norm};
use crate::tolerance::regular;

/// How far around a position the sign of a constraint is looked at, in sizes of the
/// coordinates.
const AROUND: f64 = 1e-2;
/// An error below this part of the largest one around a position is of higher order.
const HIGHER_ORDER: f64 = 1e-2;

/// A constraint equation whose gradient is as good as none at the position where the
/// constraints were evaluated last, compared with what it was around the guess, and whose
/// error has one sign wherever it is looked at around that position, unless it follows from the
/// others; `round_off` is that of an error, relative to [`Scales::reach`].
pub(super) fn vanishing_row<T: Real>(
    equations: &mut dyn Equations<T>,
    (t, q): (T, &[T]),
    scales: &Scales<'_, T>,
    round_off: T,
    workspace: &Workspace<'_, T>,
) -> Option<usize> {
    let n_rows = scales.rows.len();
    (0..n_rows).find(|row| {
        let entries = equations.constraints().jacobian.iter();
        let lengths = entries.skip(*row).step_by(n_rows).zip(scales.columns);
        let square = lengths.fold(T::zero(), |sum, (a, c)| sum + *a * *a * *c * *c);
        let size = square.sqrt() * scales.rows[*row];
        if !(scales.rows[*row] > T::zero() && size <= regular()) {
            return false;
        }
        workspace.scope(|workspace| {
            let free = Free::at(equations.constraints().jacobian, scales, workspace);
            let mut around = Around {
                equations: &mut *equations,
                at: (t, q),
                row: *row,
                moved: workspace.numbers(q.len()),
            };
            let (least, largest) = around.extremes(scales);
            let noise = round_off * scales.reach[*row];
            let has_one_sign = (largest > noise) != (least < -noise);
            let most = largest.max(-least);
            let direction = workspace.numbers(q.len());
            let found = has_one_sign && !around.stays_zero(&free, scales, most, direction);
            equations.locate(t, q);
            found
        })
    })
}

/// What all constraints leave free, to first order.
struct Free<'a, T> {
    /// The constraint rows, of which those that were chosen are orthogonal.
    rows: &'a [T],
    chosen: &'a [usize],
}

impl<'a, T: Real> Free<'a, T> {
    fn at(jacobian: &[T], scales: &Scales<'_, T>, workspace: &Workspace<'a, T>) -> Self {
        let (n, n_rows) = (scales.columns.len(), scales.rows.len());
        let rows = workspace.any(n * n_rows);
        for (k, row) in rows.chunks_exact_mut(n).enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = jacobian[j * n_rows + k] * scales.rows[k] * scales.columns[j];
            }
        }
        let chosen = workspace.indices(n.min(n_rows));
        let count = independent_columns(rows, n, &|_| false, regular(), chosen);
        Self {
            rows,
            chosen: &chosen[..count],
        }
    }

    /// The displacement that lets a coordinate go, and others with it, so far that the largest
    /// change is the size of its coordinate; zero if the constraints hold it.
    fn along(&self, coordinate: usize, scales: &Scales<'_, T>, direction: &mut [T]) {
        let n = direction.len();
        direction.fill(T::zero());
        direction[coordinate] = T::one();
        for place in self.chosen {
            let row = &self.rows[place * n..][..n];
            let share = dot(row, direction) / dot(row, row);
            add_scaled(direction, -share, row);
        }
        let is_free = norm(direction) > regular();
        let mut largest = T::zero();
        for (j, entry) in direction.iter_mut().enumerate() {
            *entry *= scales.columns[j];
            largest = largest.max(entry.abs() / scales.sizes[j]);
        }
        for entry in direction {
            *entry = match is_free {
                true => *entry / largest,
                false => T::zero(),
            };
        }
    }
}

/// A constraint around a position.
struct Around<'a, T> {
    equations: &'a mut dyn Equations<T>,
    at: (T, &'a [T]),
    row: usize,
    /// Room for another position.
    moved: &'a mut [T],
}

impl<T: Real> Around<'_, T> {
    /// The error of the constraint where some coordinates are moved.
    fn error(&mut self, change: &dyn Fn(&mut [T])) -> T {
        self.moved.copy_from_slice(self.at.1);
        change(self.moved);
        self.equations.locate(self.at.0, self.moved);
        self.equations.constraints().residual[self.row]
    }

    /// The least and the largest error along each coordinate and between each two.
    fn extremes(&mut self, scales: &Scales<'_, T>) -> (T, T) {
        let (mut least, mut largest) = (T::zero(), T::zero());
        let distance = |i: usize, sign: f64| scales.sizes[i] * T::from_f64(AROUND * sign);
        for i in 0..self.at.1.len() {
            for sign in [1.0, -1.0] {
                let mut look = |j: usize, other: f64| {
                    let error = self.error(&|moved| {
                        moved[i] += distance(i, sign);
                        moved[j] += distance(j, other);
                    });
                    (least, largest) = (least.min(error), largest.max(error));
                };
                look(i, 0.0);
                for j in 0..i {
                    look(j, 1.0);
                    look(j, -1.0);
                }
            }
        }
        (least, largest)
    }

    /// Whether the constraint remains zero, but for errors of higher order than the largest around,
    /// along directions in which the others let the position go: then it follows from them. Needs
    /// room for such a direction.
    fn stays_zero(
        &mut self,
        free: &Free<'_, T>,
        scales: &Scales<'_, T>,
        most: T,
        direction: &mut [T],
    ) -> bool {
        (0..direction.len()).all(|coordinate| {
            free.along(coordinate, scales, direction);
            let half = T::from_f64(0.5);
            let mean = [1.0, -1.0].into_iter().fold(T::zero(), |sum, sign| {
                let distance = T::from_f64(AROUND * sign);
                sum + half * self.error(&|moved| add_scaled(moved, distance, direction))
            });
            mean.abs() <= most * T::from_f64(HIGHER_ORDER)
        })
    }
}
