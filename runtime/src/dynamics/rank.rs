//! How many constraint equations are independent.
//!
//! In:  the constraint Jacobian at positions on the constraints.
//! Out: its rank at regular configurations, an independent subset of its rows; the
//!      null-space form by a rank decision alone.
//!
//! Not here: singular values ([`super::singular_values`]), and constraints whose gradient vanishes
//! wherever they hold ([`super::vanishing_gradient`]).

use super::erased::Constrained;
use super::independent::Independent;
use super::singular_values::{SingularValueDecomposition, lift};
use super::vanishing_gradient::has_one_sign;
use super::{Core, Source, Which};
use crate::equations::At;
use crate::linalg::{Workspace, add_scaled, largest_of, multiply_upper_transposed, norm, remove};
use crate::once::compiled_once;
use crate::tolerance::{difference, negligible, passes, regular, window};
use crate::{DynamicsError, Mechanism, Real, Singularity, State};
use nalgebra::SVector;

/// The singular value of a row whose gradient is lost only where a displacement begins is at least
/// this part of the displacement.
pub(crate) const RETURNING_GRADIENT: f64 = 1e-2;
/// Other rows are chosen if their squared sine is this many times that of the rows at hand.
const CLEARLY_BETTER: f64 = 4.0;
/// Newton's corrections that bring a neighbour onto the constraints. Where their gradient
/// vanishes wherever they hold, each halves the distance, and the gradient with it.
const CORRECTIONS: usize = 16;

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Learns the rank at regular configurations from a state on the constraints whose
    /// position terms are in the buffer and factorised, and chooses independent rows.
    #[inline(never)]
    pub(crate) fn learn_rank(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if self.rows.by_form {
            self.rows.view().observe_all();
            return Ok(());
        }
        let (mut solver, workspace, _) = self.lend(mechanism);
        learning()(&mut solver, state.at(), &workspace)
    }

    /// Takes other rows at an accepted state, if these are safely independent there and
    /// clearly more so than those at hand, or than those that emitted code solves with; whether it
    /// did. From then on no emitted code is asked that leaves out rows.
    #[inline(never)]
    pub(crate) fn choose_better_rows(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<bool, DynamicsError<T>> {
        if self.rows.all_independent() || !self.is_prepared() {
            return Ok(false);
        }
        mechanism.position(state, &mut self.position);
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        self.observe_sizes(mechanism);
        let mut before = self.factorise_constraints(Source::Position, Which::All);
        let leaves_out = !mechanism.structure().redundant.is_empty();
        if leaves_out && !self.session.chooses_rows {
            before = before.min(self.session.trial.lowest);
        }
        let known = self.rows.clone();
        let (mut solver, workspace, _) = self.lend(mechanism);
        choose_rows(&mut solver, &workspace);
        let after = self.factorise_constraints(Source::Position, Which::All);
        let is_better = passes(after, window()) && after > before * T::from_f64(CLEARLY_BETTER);
        match is_better {
            true => {
                self.session.sine = Some(after.sqrt());
                self.session.chooses_rows = leaves_out;
            }
            false => self.rows = known,
        }
        Ok(is_better)
    }

    /// The acceleration by the null space of the rows that are not zero to round-off: the
    /// form as it was published. Source: Phong & Hoang (2012), section 3.
    #[inline(never)]
    pub(super) fn published(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        self.prepare(mechanism, state)?;
        mechanism.terms(state, &mut self.terms);
        let bias = self.stabilised_bias(mechanism, state);
        self.factorise_metric(mechanism, Source::Terms, state.t)?;
        let right = self.scaled(&bias);
        let mut w = self.free_acceleration(&bias);
        let limit = self.rows.regular;
        self.decompose(Source::Terms, state.t, &mut |decomposition| {
            decomposition.decide(limit, negligible(), &right, &mut w);
        })?;
        Ok(self.lower(w))
    }
}

/// Learns the rank at regular configurations.
///
/// Where the state itself may be singular, its neighbours tell: along the velocity, or
/// in the directions that its constraints leave free.
pub(super) fn learn_rank<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    workspace: &Workspace<'_, T>,
) -> Result<(), DynamicsError<T>> {
    if are_independent(solver, regular(), workspace) {
        solver.learn().rows.observe_all();
        return Ok(());
    }
    let regular_at = workspace.numbers(state.q.len());
    let rank = workspace.scope(|workspace| rank_nearby(solver, state, regular_at, workspace))?;
    solver.learn().rows.observe_rank(rank);
    solver.visit(state.t, regular_at)?;
    choose_rows(solver, workspace);
    solver.visit(state.t, state.q)
}

/// Chooses an independent subset of the rows where the constraints were evaluated last.
pub(crate) fn choose_rows<T: Real>(solver: &mut dyn Constrained<T>, workspace: &Workspace<'_, T>) {
    let mut learning = solver.learn();
    if !learning.rows.all_independent() {
        learning.counters.row_choices += 1;
        let (factor, jacobian) = (learning.metric.factor, learning.at.jacobian);
        learning.rows.choose(factor, jacobian, workspace);
    }
}

/// The rank at a state, or next to it if it is higher there; writes the position that has it.
fn rank_nearby<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    regular_at: &mut [T],
    workspace: &Workspace<'_, T>,
) -> Result<usize, DynamicsError<T>> {
    solver.visit(state.t, state.q)?;
    let decomposition = SingularValueDecomposition::here(solver, state.t, workspace)?;
    let rank_here = decomposition.above(regular());
    regular_at.copy_from_slice(state.q);
    if rank_here == solver.known().r() {
        return Ok(rank_here);
    }
    let vanishing = vanishing_row(solver, workspace);
    let mut lost = None;
    let least = difference::<T>() * T::from_f64(RETURNING_GRADIENT);
    for q in neighbours(solver, state, &decomposition, workspace) {
        solver.visit(state.t, q)?;
        let rank = rank_above(solver, state.t, least, workspace)?;
        if rank <= rank_here {
            continue;
        }
        let there = (state.t, &*q);
        if vanishing.is_none() || stays(solver, there, (rank, least), workspace)? {
            regular_at.copy_from_slice(q);
            return Ok(rank);
        }
        if let (None, Some(row)) = (lost, vanishing) {
            lost = Some((row, rank));
            regular_at.copy_from_slice(q);
        }
    }
    solver.visit(state.t, state.q)?;
    let Some((row, rank)) = lost else {
        return match decomposition.above(negligible()) > rank_here {
            true => Err(DynamicsError::SingularConfiguration {
                t: state.t,
                kind: Singularity::Unresolved,
                row: largest_of(decomposition.left(rank_here)).0,
                structure: solver.structure(),
            }),
            false => Ok(rank_here),
        };
    };
    // Whether a row is like a square shows only where it does not depend on time.
    let stands_still = solver.structure().is_scleronomic_at(row);
    if stands_still && has_one_sign(solver, state, &decomposition, rank_here, workspace) {
        return Err(DynamicsError::SingularConfiguration {
            t: state.t,
            kind: Singularity::Vanishing,
            row,
            structure: solver.structure(),
        });
    }
    Ok(rank)
}

/// Whether it is sure that the singular values of all rows are above a bound where the
/// constraints were evaluated last.
fn are_independent<T: Real>(
    solver: &dyn Constrained<T>,
    least: T,
    workspace: &Workspace<'_, T>,
) -> bool {
    let (r, jacobian) = (solver.known().r(), solver.constraints().jacobian);
    if r > jacobian.len() / r {
        return false;
    }
    workspace.scope(|workspace| {
        let rows = workspace.indices(r);
        for (k, row) in rows.iter_mut().enumerate() {
            *row = k;
        }
        Independent::here(solver, rows, least, workspace).is_some()
    })
}

/// How many singular values are above a bound where the constraints were evaluated last.
fn rank_above<T: Real>(
    solver: &mut dyn Constrained<T>,
    t: T,
    least: T,
    workspace: &Workspace<'_, T>,
) -> Result<usize, DynamicsError<T>> {
    if are_independent(solver, least, workspace) {
        return Ok(solver.known().r());
    }
    workspace
        .scope(|workspace| Ok(SingularValueDecomposition::here(solver, t, workspace)?.above(least)))
}

/// Whether a rank next to a state is still there where the constraints hold.
fn stays<T: Real>(
    solver: &mut dyn Constrained<T>,
    (t, q): (T, &[T]),
    (wanted, least): (usize, T),
    workspace: &Workspace<'_, T>,
) -> Result<bool, DynamicsError<T>> {
    workspace.scope(|workspace| {
        let (moved, w) = (workspace.numbers(q.len()), workspace.numbers(q.len()));
        let right = workspace.numbers(solver.known().r());
        moved.copy_from_slice(q);
        for _ in 0..CORRECTIONS {
            solver.visit(t, moved)?;
            w.fill(T::zero());
            let stays = workspace.scope(|workspace| {
                let decomposition = SingularValueDecomposition::here(solver, t, workspace)?;
                let rank = decomposition.above(least);
                solver.known().scaled(solver.constraints().residual, right);
                decomposition.decide(rank, least, right, w);
                Ok(rank >= wanted)
            })?;
            if !stays {
                return Ok(false);
            }
            solver.known().lower(w);
            add_scaled(moved, -T::one(), w);
        }
        Ok(true)
    })
}

/// A row whose gradient vanishes where the constraints were evaluated last, if there is one.
fn vanishing_row<T: Real>(
    solver: &dyn Constrained<T>,
    workspace: &Workspace<'_, T>,
) -> Option<usize> {
    let (known, jacobian) = (solver.known(), solver.constraints().jacobian);
    workspace.scope(|workspace| {
        let lifted = workspace.numbers(jacobian.len() / known.r());
        (0..known.r()).find(|&row| {
            lift(jacobian, known, row, lifted);
            known.scale[row] * norm(lifted) <= regular()
        })
    })
}

/// Positions next to a state: along its velocity, if it moves, and wherever the constraints
/// let it go. Off the constraints redundant rows would look independent.
fn neighbours<'a, T: Real>(
    solver: &dyn Constrained<T>,
    state: At<'_, T>,
    decomposition: &SingularValueDecomposition<'_, T>,
    workspace: &Workspace<'a, T>,
) -> core::slice::ChunksExactMut<'a, T> {
    let (n, known) = (state.q.len(), solver.known());
    let distance = difference::<T>() * known.coordinate_scale.range;
    let positions = workspace.numbers((n + 1) * n);
    let mut count = 0;
    let mut add = |axis: &mut [T], least: T| {
        remove(axis, decomposition.decided(decomposition.above(regular())));
        let size = norm(axis);
        if size > least {
            known.lower(axis);
            let position = &mut positions[count * n..][..n];
            position.copy_from_slice(state.q);
            add_scaled(position, distance / size, axis);
            count += 1;
        }
    };
    let axis = workspace.numbers(n);
    multiply_upper_transposed(known.factor, state.v, axis);
    add(axis, T::zero());
    for j in 0..n {
        axis.fill(T::zero());
        axis[j] = T::one();
        add(axis, regular());
    }
    positions[..count * n].chunks_exact_mut(n)
}

compiled_once! {
    fn learning<T>:
        fn(&mut dyn Constrained<T>, At<'_, T>, &Workspace<'_, T>) -> Result<(), DynamicsError<T>> =
        learn_rank;
}
