//! How constraints share a reaction where some of them depend on the others.
//!
//! In:  a generalized reaction force, directions along the sheet.
//! Out: the multipliers `λ` that `Aᵀλ` is the reaction with, and for which rows none is told.
//!
//! In a singular configuration a combination `wᵀA` of rows vanishes, and its multiplier grows
//! beyond all bounds on the way there: their product, a force along the normal of the sheet,
//! stays. `Aᵀλ` of the other rows is the reaction less that force. The normal is the limit of
//! `wᵀA` at length one, hence its derivative along the sheet.

use super::erased::Constrained;
use super::{Core, SingularValueDecomposition, Source};
use crate::equations::At;
use crate::linalg::{Workspace, add_scaled, column, dot, lift_row, norm, pair, remove, scale};
use crate::once::compiled_once;
use crate::singular::Point;
use crate::tolerance::{difference, regular, resolvable};
use crate::{DynamicsError, Mechanism, Real, State};
use core::mem::swap;
use nalgebra::{SMatrix, SVector};

/// Directions along a sheet, and how time passes in a unit of each.
struct Along<T, const N: usize> {
    directions: SMatrix<T, N, N>,
    times: [T; N],
    count: usize,
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// The `λ` of `Aᵀλ = r` at a state whose terms are in the buffer.
    #[inline(never)]
    pub(super) fn shares_of(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        reaction: &SVector<T, N>,
    ) -> Result<[Option<T>; R], DynamicsError<T>> {
        self.factorise_metric(mechanism, Source::Terms, state.t)?;
        let mut lifted = reaction.data.0[0];
        self.metric.factor.forward(&mut lifted);
        let (mut multipliers, mut unknown) = ([T::zero(); R], [false; R]);
        let mut rank = 0;
        self.decompose(Source::Terms, state.t, &mut |decomposition| {
            rank = decomposition.above(least_told());
            let told = (regular(), regular());
            decomposition.share(&lifted, told, &mut multipliers, &mut unknown);
        })?;
        if rank < self.rows.regular {
            let (at, along) = self.along_sheet(mechanism, state);
            (multipliers, unknown) = ([T::zero(); R], [false; R]);
            let (mut solver, workspace, _) = self.lend(mechanism);
            let times = &along.times[..along.count];
            sharing()(
                &mut solver,
                (at.at(), reaction.as_slice()),
                (&along.directions.as_slice()[..N * along.count], times),
                (&mut multipliers, &mut unknown),
                &workspace,
            )?;
        }
        Ok(column(|row| {
            (!unknown[row]).then_some(multipliers[row] * self.rows.scale[row])
        }))
    }

    /// The state on the sheet that a state stands for, and directions along the sheet there: none
    /// at rest in a singular configuration, where nothing tells which sheet is meant.
    fn along_sheet(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> (State<T, N>, Along<T, N>) {
        let mut along = Along {
            directions: SMatrix::zeros(),
            times: [T::zero(); N],
            count: 0,
        };
        let mut point = Point::zeros();
        let placed = self.place_here(mechanism, state, &mut point);
        let (Some(Ok(_)), Some(chart)) = (placed, self.session.chart.as_ref()) else {
            return (*state, along);
        };
        let chart = chart.view();
        let all = along.directions.as_mut_slice();
        chart.spread(point.tangent.as_slice(), all);
        along.count = N - chart.rank();
        let next = &mut all[N * along.count..][..N];
        match chart.moving(point.drift.as_slice()) {
            Some(speed) => {
                next.copy_from_slice(point.drift.as_slice());
                scale(next, T::one() / speed);
                along.times[along.count] = T::one() / speed;
            }
            // Where the law of time stops, the sheet leads on as it did before.
            None => chart.put_heading(next),
        }
        along.count += 1;
        (point.state, along)
    }
}

/// Singular value below which the multipliers are those of the sheet: a combination of rows is
/// known to as many digits there as its share in the other rows is small.
fn least_told<T: Real>() -> T {
    resolvable::<T>().sqrt()
}

/// The normals of a sheet that combinations of rows without a gradient have, and what is left of
/// these normals beside the other rows.
struct Normals<'a, T> {
    whole: &'a mut [T],
    /// Of length one, orthogonal to one another and to the other rows.
    across: &'a mut [T],
    count: usize,
    /// The least of the lengths before.
    clearest: T,
}

impl<'a, T: Real> Normals<'a, T> {
    fn new(size: usize, workspace: &Workspace<'a, T>) -> Self {
        Self {
            whole: workspace.numbers(size),
            across: workspace.numbers(size),
            count: 0,
            clearest: T::zero(),
        }
    }

    /// Makes what is left of the normals beside the other rows orthonormal, the largest first, and
    /// forgets the normals of combinations that vanish everywhere.
    fn orthonormalise(&mut self, n: usize, least: T) {
        self.count = 0;
        self.clearest = T::zero();
        let all = self.across.len() / n;
        for k in 0..all {
            let length = |j: &usize| norm(&self.across[j * n..][..n]);
            let longest = (k..all).fold(k, |a, b| if length(&b) > length(&a) { b } else { a });
            let size = length(&longest);
            // A comparison with NaN is false, and no normal is found.
            let enough = size > least;
            if !enough {
                return;
            }
            (self.count, self.clearest) = (k + 1, size);
            for vectors in [&mut *self.across, &mut *self.whole] {
                if longest != k {
                    let [own, other] = pair(vectors, n, k, longest);
                    own.swap_with_slice(other);
                }
                scale(&mut vectors[k * n..][..n], T::one() / size);
            }
            for j in k + 1..all {
                let share = dot(&self.across[j * n..][..n], &self.across[k * n..][..n]);
                for vectors in [&mut *self.across, &mut *self.whole] {
                    let [own, other] = pair(vectors, n, j, k);
                    add_scaled(own, -share, other);
                }
            }
        }
    }
}

/// Finds the multipliers of a reaction on a sheet, in the scale of the rows, and takes note of
/// those for which nothing is told: all, if the other rows and the normals that are found don't
/// add up to the reaction.
fn share_on_sheet<T: Real>(
    solver: &mut dyn Constrained<T>,
    (state, reaction): (At<'_, T>, &[T]),
    along: (&[T], &[T]),
    (multipliers, unknown): (&mut [T], &mut [bool]),
    workspace: &Workspace<'_, T>,
) -> Result<(), DynamicsError<T>> {
    let n = state.q.len();
    solver.visit(state.t, state.q)?;
    let decomposition = SingularValueDecomposition::here(solver, state.t, workspace)?;
    let strong = decomposition.above(least_told());
    let size = n * (multipliers.len() - strong);
    let mut best = Normals::new(size, workspace);
    let mut tried = Normals::new(size, workspace);
    let mixed = workspace.numbers(n);
    let mut mixed_time = T::zero();
    for (direction, time) in along.0.chunks_exact(n).zip(along.1) {
        add_scaled(mixed, T::one(), direction);
        mixed_time += *time;
    }
    // Where several loops become singular at once, one of them may rest along each direction.
    let directions = along.0.chunks_exact(n).zip(along.1);
    for (direction, time) in directions.chain([(&*mixed, &mixed_time)]) {
        differentiate(
            solver,
            state,
            (direction, *time),
            (&decomposition, strong),
            tried.whole,
            workspace,
        );
        tried.across.copy_from_slice(tried.whole);
        for vector in tried.across.chunks_exact_mut(n) {
            remove(vector, decomposition.decided(strong));
        }
        let range = solver.known().coordinate_scale.range;
        tried.orthonormalise(n, difference::<T>() / range);
        if (tried.count, tried.clearest) > (best.count, best.clearest) {
            swap(&mut best, &mut tried);
        }
    }
    solver.visit(state.t, state.q)?;
    let lifted = workspace.numbers(n);
    lift_row(solver.known().factor, reaction, (0, 1), lifted);
    let all = norm(lifted);
    for k in 0..best.count {
        let force = dot(&best.across[k * n..][..n], lifted);
        add_scaled(lifted, -force, &best.whole[k * n..][..n]);
    }
    decomposition.share(lifted, (least_told(), difference()), multipliers, unknown);
    remove(lifted, decomposition.decided(strong));
    // A comparison with NaN is false, and nothing is told.
    let told = norm(lifted) <= all * difference();
    if !told {
        unknown.fill(true);
    }
    Ok(())
}

/// The derivatives, along a direction, of the combinations of rows that a decomposition finds
/// weaker than those that are told, in the metric.
fn differentiate<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    (direction, time): (&[T], T),
    (decomposition, strong): (&SingularValueDecomposition<'_, T>, usize),
    derivatives: &mut [T],
    workspace: &Workspace<'_, T>,
) {
    let n = state.q.len();
    let distance = difference::<T>() * solver.known().coordinate_scale.range;
    workspace.scope(|workspace| {
        let [moved, gradient, lifted] = [(); 3].map(|()| workspace.numbers(n));
        derivatives.fill(T::zero());
        for far in [distance, -distance] {
            moved.copy_from_slice(state.q);
            add_scaled(moved, far, direction);
            solver.locate(state.t + far * time, moved);
            let (jacobian, known) = (solver.constraints().jacobian, solver.known());
            for (k, derivative) in derivatives.chunks_exact_mut(n).enumerate() {
                let combination = decomposition.left(strong + k);
                for (entry, levers) in gradient.iter_mut().zip(jacobian.chunks_exact(known.r())) {
                    let parts = levers.iter().zip(combination.iter().zip(known.scale));
                    *entry = parts.fold(T::zero(), |sum, (lever, (part, scale))| {
                        sum + *lever * *part * *scale
                    });
                }
                lift_row(known.factor, gradient, (0, 1), lifted);
                add_scaled(derivative, T::one() / (far + far), lifted);
            }
        }
    });
}

compiled_once! {
    /// [`share_on_sheet`].
    fn sharing<T>: fn(
        &mut dyn Constrained<T>,
        (At<'_, T>, &[T]),
        (&[T], &[T]),
        (&mut [T], &mut [bool]),
        &Workspace<'_, T>,
    ) -> Result<(), DynamicsError<T>> = share_on_sheet;
}
