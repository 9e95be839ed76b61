//! Over what distance constraint rows turn.
//!
//! In:  the first state of a motion, the sizes of the rows.
//! Out: the radius of curvature of the constraint set where it is straightest.
//!
//! Lengths of coordinates say where a mechanism is, and how large it is only if it is near the
//! origin.

use super::Core;
use super::erased::Constrained;
use crate::equations::At;
use crate::linalg::{Workspace, norm, sign_of, solve_upper};
use crate::natural_size::LeastInertia;
use crate::once::compiled_once;
use crate::tolerance::{difference, excusable};
use crate::{Mechanism, Real, State};

/// How many displacements are tried.
const DISPLACEMENTS: usize = 4;
/// How often the distance of the displacements is made shorter. Where rows are unit vectors, those
/// that are too long tell nothing but their own length.
const PASSES: usize = 3;
/// Constraints change over at most so many radii of curvature, times the root of the number of
/// coordinates: it takes that many, each as far, to go so far.
const RADII: f64 = 50.0;

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Takes note of the distance over which constraints change, at a state at which the metric is
    /// factorised.
    #[inline(never)]
    pub(super) fn observe_curvature(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) {
        let radii = T::from_f64(RADII * (N as f64).sqrt());
        let mut range = self.coordinate_scale.unlimited;
        let mut limit = T::zero();
        for _ in 0..PASSES {
            let (mut solver, workspace, _) = self.lend(mechanism);
            let distance = difference::<T>() * range;
            limit = measuring()(&mut solver, (state.at(), distance), &workspace) * radii;
            if limit >= range {
                break;
            }
            range = limit;
        }
        self.coordinate_scale.limit(limit);
    }
}

/// The largest radius of curvature of constraint rows that turn over a distance, infinite where
/// none does.
fn radius_of_curvature<T: Real>(
    solver: &mut dyn Constrained<T>,
    (state, distance): (At<'_, T>, T),
    workspace: &Workspace<'_, T>,
) -> T {
    let (r, n) = (solver.known().r(), state.q.len());
    let turned = workspace.numbers(r);
    workspace.scope(|workspace| {
        let [moved, change] = [(); 2].map(|()| workspace.numbers(n));
        let here = workspace.numbers(n * r);
        solver.locate(state.t, state.q);
        here.copy_from_slice(solver.constraints().jacobian);
        for displacement in 0..DISPLACEMENTS {
            displace(solver, (state.q, distance), displacement, moved);
            solver.locate(state.t, moved);
            let (there, known) = (solver.constraints().jacobian, solver.known());
            for (row, turned) in turned.iter_mut().enumerate() {
                let levers = there.iter().zip(&*here).skip(row).step_by(r);
                for (change, (there, here)) in change.iter_mut().zip(levers) {
                    *change = *there - *here;
                }
                solve_upper(known.factor, change);
                *turned = turned.max(norm(change) * known.scale[row]);
            }
        }
    });
    solver.locate(state.t, state.q);
    let turns = |turned: &&T| **turned > excusable() && turned.is_finite();
    let radii = turned.iter().filter(turns).map(|turned| distance / *turned);
    radii.reduce(T::max).unwrap_or(T::from_f64(f64::INFINITY))
}

/// A position from which all coordinates are displaced that have an inertia of their own, by a
/// distance each. Others would go as far as one likes.
fn displace<T: Real>(
    solver: &dyn Constrained<T>,
    (q, distance): (&[T], T),
    displacement: usize,
    moved: &mut [T],
) {
    let (mass, structure) = (solver.constraints().mass, solver.structure());
    let least = LeastInertia::measure(structure, mass, q.len());
    let inertia = mass.iter().step_by(q.len() + 1);
    for (j, ((moved, q), inertia)) in moved.iter_mut().zip(q).zip(inertia).enumerate() {
        let step = match *inertia > least.of(structure, j) {
            true => distance / inertia.sqrt(),
            false => T::zero(),
        };
        *moved = T::from_f64(sign_of(displacement, j)).mul_add(step, *q);
    }
}

compiled_once! {
    fn measuring<T>: fn(&mut dyn Constrained<T>, (At<'_, T>, T), &Workspace<'_, T>) -> T =
        radius_of_curvature;
}
