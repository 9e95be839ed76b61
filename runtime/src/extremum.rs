//! Constraints that are near an extremum, which they do not take where they hold.
//!
//! In:  a position, a row whose gradient is much smaller there than elsewhere.
//! Out: whether the row is only small, and no branches meet where it vanishes.
//!
//! The gradient of `|p − s|² = L²` is far smaller at a distance `L` than at the distance of
//! `p` and `s` from the origin. It vanishes at `p = s`, and there the constraint does not
//! hold. Where branches cross, the constraint rises along some directions and falls along
//! others.
//!
//! Source: Saad, Iterative Methods for Sparse Linear Systems (2003), section 6.8 (conjugate
//! residuals).

use crate::Real;
use crate::equations::Equations;
use crate::linalg::{Workspace, add_scaled, dot, largest, sign_of};
use crate::natural_size::NaturalSizes;
use crate::tolerance::{critical, round_off};

/// Rows that are smaller, by this factor, than elsewhere nearly vanish.
pub(crate) const VANISHING: f64 = 1e-3;
/// Iterations that lead to the extremum: as many as the second derivatives have different
/// eigenvalues.
const ITERATIONS: usize = 8;
/// How far second derivatives look, in sizes of the coordinates.
const LOOK: f64 = 1e-3;
/// A gradient that is smaller by this factor vanishes.
const VANISHED: f64 = 1e-3;
/// Directions along which the constraint is to curve to one side, besides the coordinates.
const DIRECTIONS: usize = 4;
/// A curvature of this part of the largest is round-off.
const STRAIGHT: f64 = 1e-6;

/// A row around a position, in coordinates relative to their sizes.
struct Around<'a, T> {
    equations: &'a mut dyn Equations<T>,
    row: usize,
    place: (T, &'a [T]),
    /// The sizes of the coordinates.
    sizes: &'a [T],
    /// The gradient at the position.
    here: &'a [T],
    /// Room for another position.
    moved: &'a mut [T],
}

/// Whether the gradient of a row vanishes nearby, at a position that clearly violates the
/// constraint and where it is extremal.
pub(crate) fn is_near_extremum<T: Real>(
    equations: &mut dyn Equations<T>,
    (t, q): (T, &[T]),
    row: usize,
    workspace: &Workspace<'_, T>,
) -> bool {
    let [sizes, here, moved, change] = [(); 4].map(|()| workspace.numbers(q.len()));
    NaturalSizes::write_all(equations.structure(), q, sizes);
    equations.locate(t, q);
    load_gradient(equations, row, sizes, here);
    let mut around = Around {
        equations,
        row,
        place: (t, q),
        sizes,
        here,
        moved,
    };
    let most = largest(around.here);
    if !around.curves_to_one_side(workspace) || !around.solve(change, workspace) {
        return false;
    }
    around.go(T::one(), change);
    let there = workspace.numbers(change.len());
    load_gradient(around.equations, row, sizes, there);
    let vanishes = largest(there) <= most * T::from_f64(VANISHED);
    let left = around.equations.constraints().residual[row].abs();
    vanishes && left > critical::<T>() * round_off::<T>() * most
}

impl<T: Real> Around<'_, T> {
    /// Evaluates the constraints a distance along a direction.
    fn go(&mut self, distance: T, direction: &[T]) {
        let (t, q) = self.place;
        let steps = direction.iter().zip(self.sizes);
        for (moved, (q, (step, size))) in self.moved.iter_mut().zip(q.iter().zip(steps)) {
            *moved = *q + distance * *step * *size;
        }
        self.equations.locate(t, self.moved);
    }

    /// The second derivatives of the row times a direction, by a difference.
    fn curvature(&mut self, direction: &[T], curvature: &mut [T]) {
        let distance = T::from_f64(LOOK) / largest(direction);
        self.go(distance, direction);
        load_gradient(self.equations, self.row, self.sizes, curvature);
        for (target, here) in curvature.iter_mut().zip(self.here) {
            *target = (*target - *here) / distance;
        }
    }

    /// Whether the row curves to one side along all directions that are tried.
    fn curves_to_one_side(&mut self, workspace: &Workspace<'_, T>) -> bool {
        workspace.scope(|workspace| {
            let [direction, curvature] = [(); 2].map(|()| workspace.numbers(self.here.len()));
            let (mut least, mut most) = (T::zero(), T::zero());
            // Along each coordinate alone, and along all of them with several signs.
            let n = direction.len();
            for number in 0..n + DIRECTIONS {
                for (j, entry) in direction.iter_mut().enumerate() {
                    *entry = match number.checked_sub(n) {
                        Some(pattern) => T::from_f64(sign_of(pattern, j)),
                        None if j == number => T::one(),
                        None => T::zero(),
                    };
                }
                self.curvature(direction, curvature);
                let along = dot(direction, curvature);
                (least, most) = (least.min(along), most.max(along));
            }
            let other = most.min(-least);
            other <= most.max(-least) * T::from_f64(STRAIGHT)
        })
    }

    /// The change of the position to where the gradient vanishes, if second derivatives tell it,
    /// by conjugate residuals; whether there is one.
    fn solve(&mut self, change: &mut [T], workspace: &Workspace<'_, T>) -> bool {
        workspace.scope(|workspace| {
            let n = change.len();
            let [rest, step] = [(); 2].map(|()| workspace.numbers(n));
            let [of_rest, of_step] = [(); 2].map(|()| workspace.numbers(n));
            add_scaled(rest, -T::one(), self.here);
            let enough = largest(rest) * T::from_f64(VANISHED * VANISHED);
            self.curvature(rest, of_rest);
            let mut along = dot(rest, of_rest);
            step.copy_from_slice(rest);
            of_step.copy_from_slice(of_rest);
            for _ in 0..ITERATIONS {
                let share = along / dot(of_step, of_step);
                // A comparison with NaN is false, so that a share that is NaN is none.
                let is_finite = share.abs() < T::from_f64(f64::INFINITY);
                if !is_finite {
                    return false;
                }
                add_scaled(change, share, step);
                add_scaled(rest, -share, of_step);
                if largest(rest) <= enough {
                    break;
                }
                self.curvature(rest, of_rest);
                let before = along;
                along = dot(rest, of_rest);
                if along * before < T::zero() {
                    return false;
                }
                for (old, new) in [(&mut *step, &*rest), (&mut *of_step, &*of_rest)] {
                    for (old, new) in old.iter_mut().zip(new) {
                        *old = *new + along / before * *old;
                    }
                }
            }
            true
        })
    }
}

/// Takes the gradient of a row where the constraints were evaluated last, by coordinates relative
/// to their sizes.
fn load_gradient<T: Real>(
    equations: &dyn Equations<T>,
    row: usize,
    sizes: &[T],
    gradient: &mut [T],
) {
    let at = equations.constraints();
    let entries = at.jacobian.iter().skip(row).step_by(at.residual.len());
    for (target, (entry, size)) in gradient.iter_mut().zip(entries.zip(sizes)) {
        *target = *entry * *size;
    }
}
