//! Velocities that satisfy the constraints.
//!
//! In:  a position on the constraints, guesses, which velocities are held.
//! Out: the velocities, to round-off.
//!
//! At a regular position `A q̇ + b = 0` decides. At a singular one some
//! combinations `w` of the rows vanish, and `wᵀ p₂(q, q̇) = 0` remains: without it
//! no acceleration would satisfy the constraints. It is quadratic in `q̇`; its
//! solutions are the velocities along the branches that meet there.

use super::decomposition::Decomposition;
use super::draft::{Assemble, Draft, Refusal};
use super::scales::{CONTRADICTION, Scales, disturb};
use crate::Real;
use crate::equations::{At, Equations};
use crate::linalg::{Workspace, add_scaled, is_zero, norm};
use crate::natural_size::Kind;
use crate::once::compiled_once;
use crate::tolerance::{negligible, regular, window};
use core::cmp::Ordering::Equal;

/// Newton steps towards a branch.
const MOST_STEPS: usize = 60;
/// The rest of `p₂` that the rows can't produce counts as zero below this part of the quadratic
/// terms whose sum it is; a change of it with velocities counts above this part of the change of
/// `p₂`.
const ON_BRANCH: f64 = 1e-9;
/// Velocities along which this rest is below this part of the quadratic terms are those of a
/// branch: the rows of the position tell it, and not their round-off.
const ALONG_BRANCH: f64 = 1e-4;
/// Singular values up to this many units of round-off are nothing but round-off.
const ROUND_OFF: f64 = 64.0;
/// A direction towards a branch counts if it changes that rest by this part of
/// what the most effective one does.
const EFFECTIVE: f64 = 1e-6;

/// Moves the velocities that are not held onto the constraints.
pub(super) fn assemble<T: Real>(
    equations: &mut dyn Equations<T>,
    mut draft: Draft<'_, T>,
    workspace: &Workspace<'_, T>,
) -> Result<(), Refusal> {
    let place = (draft.t, &*draft.q);
    let measured = Scales::measure(equations, place, None, workspace);
    let guessed = speed(draft.v, &measured);
    let scales = Scales::measure(equations, place, Some(draft.held), workspace);
    equations.locate(draft.t, draft.q);
    let (n, n_rows) = (draft.q.len(), draft.residual.len());
    let mut free = Decomposition::new(n, n_rows, workspace);
    free.decompose(equations.constraints().jacobian, &scales)?;
    let mut whole = Decomposition::new(n, n_rows, workspace);
    whole.decompose(equations.constraints().jacobian, &measured)?;
    *draft.near_singular = whole.has_between(negligible(), window());
    let q = workspace.numbers(n);
    q.copy_from_slice(draft.q);
    let mut branches = Branches {
        equations,
        position: (draft.t, q),
        measured,
        scales,
        free: &mut free,
        whole: &whole,
    };
    workspace.scope(|inner| branches.follow(draft.v, inner));
    if !draft.v.iter().all(|v| v.is_finite()) {
        return Err(Refusal::NotFinite);
    }
    // The corrections have the absolute accuracy of the velocities that they begin with, which
    // may be far larger than those at the end.
    let speed = guessed.max(speed(draft.v, &measured));
    check(&mut draft, speed, branches.equations, &measured)?;
    if whole.rank(regular()) == n_rows {
        return Ok(());
    }
    let guess = workspace.numbers(n);
    guess.copy_from_slice(draft.v);
    match workspace.scope(|inner| branches.choose(draft.v, inner))? {
        true => branches.correct(draft.v, regular(), workspace),
        false => return Err(branches.refuse(draft.v, (guess, speed), workspace)?),
    }
    branches.equations.locate(draft.t, draft.q);
    check(&mut draft, speed, branches.equations, &measured)
}

/// Adds a scaled step to velocities.
fn move_by<T: Real>(v: &mut [T], step: &[T], scales: &Scales<'_, T>) {
    for (v, (step, scale)) in v.iter_mut().zip(step.iter().zip(scales.columns)) {
        *v += *step * *scale;
    }
}

/// `A q̇ + b`.
fn opening<T: Real>(equations: &dyn Equations<T>, v: &[T], opening: &mut [T]) {
    let at = equations.constraints();
    opening.copy_from_slice(at.drift);
    for (column, v) in at.jacobian.chunks_exact(opening.len()).zip(v) {
        add_scaled(opening, *v, column);
    }
}

/// The size of velocities in the kinetic metric, where a row of norm one turns a speed of
/// one into an error of one.
fn speed<T: Real>(v: &[T], measured: &Scales<'_, T>) -> T {
    let scaled = v.iter().zip(measured.columns);
    let squares = scaled.fold(T::zero(), |sum, (v, scale)| {
        let x = *v / *scale;
        sum + x * x
    });
    squares.sqrt()
}

/// Refuses velocities that contradict the constraints. The speed is the largest of those that they
/// were found from.
fn check<T: Real>(
    draft: &mut Draft<'_, T>,
    speed: T,
    equations: &dyn Equations<T>,
    measured: &Scales<'_, T>,
) -> Result<(), Refusal> {
    opening(equations, draft.v, draft.residual);
    // Rows that count as dependent may be off by as much as they are independent.
    let slack = T::EPSILON * T::from_f64(CONTRADICTION) + regular();
    let at = equations.constraints();
    for (k, error) in draft.residual.iter_mut().enumerate() {
        let most = slack * (speed / measured.rows[k] + at.drift[k].abs());
        if error.abs() <= most {
            *error = T::zero();
        }
    }
    if is_zero(draft.residual) {
        return Ok(());
    }
    measured.influential(at.jacobian, draft.residual, draft.held, draft.conflicting);
    Err(Refusal::Velocities)
}

/// The branches that meet at a singular position.
struct Branches<'b, 'a, T> {
    equations: &'b mut dyn Equations<T>,
    position: (T, &'b [T]),
    measured: Scales<'a, T>,
    /// The scales `measured` with what is held taken out of the unknowns.
    scales: Scales<'a, T>,
    /// The decomposition of the rows for the velocities that aren't held.
    free: &'b mut Decomposition<'a, T>,
    /// The decomposition of the rows for all velocities.
    whole: &'b Decomposition<'a, T>,
}

impl<T: Real> Branches<'_, '_, T> {
    /// Moves the free velocities to `A q̇ + b = 0`. Beside a singular configuration, small singular
    /// values tell on which branch the position is, as long as they have some digits, or if they
    /// lead along a branch.
    fn follow(&mut self, v: &mut [T], workspace: &Workspace<'_, T>) {
        let told = T::EPSILON.sqrt();
        let round_off = T::EPSILON * T::from_f64(ROUND_OFF);
        if self.free.has_between(round_off, told) {
            let along = workspace.numbers(v.len());
            along.copy_from_slice(v);
            self.correct(along, round_off, workspace);
            if self.is_along_branch(along, workspace) {
                return v.copy_from_slice(along);
            }
        }
        self.correct(v, told, workspace);
    }

    /// Whether velocities are those of a branch, but for the round-off of the position, which may
    /// have moved rows off a singular configuration.
    fn is_along_branch(&mut self, v: &[T], workspace: &Workspace<'_, T>) -> bool {
        let (n, n_rows) = (v.len(), self.scales.rows.len());
        let slopes = workspace.numbers(n_rows * n);
        let (rest, room) = (workspace.numbers(n_rows), workspace.numbers(n_rows));
        let size = self.slopes(v, slopes, (room, workspace.numbers(n)));
        self.bias(v, rest);
        let size = size + norm(rest);
        self.whole.leave_unreachable(rest, regular());
        norm(rest) <= size * T::from_f64(ALONG_BRANCH)
    }

    /// Moves the free velocities to `A q̇ + b = 0`, as little as they can, by the singular values
    /// above a bound. Twice: the second correction removes the round-off of the first.
    fn correct(&mut self, v: &mut [T], least: T, workspace: &Workspace<'_, T>) {
        workspace.scope(|workspace| {
            let error = workspace.numbers(self.scales.rows.len());
            let step = workspace.numbers(v.len());
            for _ in 0..2 {
                opening(self.equations, v, error);
                for (error, scale) in error.iter_mut().zip(self.scales.rows) {
                    *error = -(*error * *scale);
                }
                self.free.solve(error, least, step);
                move_by(v, step, &self.scales);
            }
        });
    }

    /// Newton's method towards the nearest branch, along the directions that
    /// the constraints leave free; whether one was reached.
    fn choose(&mut self, v: &mut [T], workspace: &Workspace<'_, T>) -> Result<bool, Refusal> {
        let (n, n_rows) = (v.len(), self.scales.rows.len());
        let mut towards = Decomposition::new(n, n_rows, workspace);
        let slopes = workspace.numbers(n_rows * n);
        let (bias, rest) = (workspace.numbers(n_rows), workspace.numbers(n_rows));
        let (moved, step) = (workspace.numbers(n), workspace.numbers(n));
        for _ in 0..MOST_STEPS {
            self.bias(v, bias);
            rest.copy_from_slice(bias);
            self.whole.leave_unreachable(rest, regular());
            let size = norm(bias) + self.usual_bias(v) + self.slopes(v, slopes, (bias, moved));
            let reached = norm(rest) <= size * T::from_f64(ON_BRANCH);
            // Where rows are the same, the rest is round-off, and so are its changes.
            if norm(rest) > size * T::EPSILON * T::from_f64(CONTRADICTION) {
                // A last step where the branch is reached, too, squares the error.
                let noise = norm(slopes) * T::from_f64(ON_BRANCH);
                self.make_effective(slopes, moved);
                towards.decompose_scaled(&|k, j| slopes[j * n_rows + k])?;
                let cut = noise.max(towards.largest() * T::from_f64(EFFECTIVE));
                rest.iter_mut().for_each(|rest| *rest = -*rest);
                towards.solve(rest, cut, step);
                self.keep_free(step);
                move_by(v, step, &self.scales);
            }
            let finite = v.iter().all(|v| v.is_finite());
            if reached || !finite {
                return Ok(reached && finite);
            }
        }
        Ok(false)
    }

    /// Why no branch was reached from a guess of this speed: there is none, or the guess lies in
    /// the middle between several. Then the velocities are those of one of them.
    fn refuse(
        &mut self,
        v: &mut [T],
        (guess, speed): (&[T], T),
        workspace: &Workspace<'_, T>,
    ) -> Result<Refusal, Refusal> {
        let columns = self.scales.columns;
        for aside in [speed, -speed] {
            // Held velocities have a scale of zero and stay.
            disturb(guess, |j| aside * columns[j], v);
            self.correct(v, regular(), workspace);
            if workspace.scope(|workspace| self.choose(v, workspace))? {
                let change = |j: &usize| ((v[*j] - guess[*j]) / columns[*j]).abs();
                let free = (0..v.len()).filter(|j| columns[*j] > T::zero());
                let most = free.max_by(|a, b| change(a).partial_cmp(&change(b)).unwrap_or(Equal));
                return Ok(most.map_or(Refusal::NoBranch, Refusal::ManyBranches));
            }
        }
        Ok(Refusal::NoBranch)
    }

    /// `p₂` at a velocity, scaled.
    fn bias(&mut self, v: &[T], bias: &mut [T]) {
        let (t, q) = self.position;
        self.equations.evaluate(At { t, q, v });
        let terms = self.equations.constraints().bias;
        for (k, target) in bias.iter_mut().enumerate() {
            *target = terms[k] * self.measured.rows[k];
        }
    }

    /// How large `p₂` is where rows turn as angles do: a `p₂` that is far less is round-off of rows
    /// that do not turn at all.
    fn usual_bias(&self, v: &[T]) -> T {
        let structure = self.equations.structure();
        let angles = v.iter().zip(self.measured.columns).enumerate();
        let angles = angles.filter(|(j, _)| structure.kind(*j) == Some(Kind::Angle));
        angles.fold(T::zero(), |sum, (_, (v, scale))| sum + *v * *v / *scale)
    }

    /// How `p₂` changes with each scaled velocity, held or not; returns the sum of the sizes of its
    /// terms, estimated from these changes. `p₂` is quadratic in the velocities, so that central
    /// differences are exact. Needs room for a bias and a velocity.
    fn slopes(&mut self, v: &[T], slopes: &mut [T], (bias, moved): (&mut [T], &mut [T])) -> T {
        let two = T::from_f64(2.0);
        let mut size = T::zero();
        moved.copy_from_slice(v);
        for (j, slope) in slopes.chunks_exact_mut(bias.len()).enumerate() {
            let scale = self.measured.columns[j];
            moved[j] = v[j] + scale;
            self.bias(moved, slope);
            moved[j] = v[j] - scale;
            self.bias(moved, bias);
            moved[j] = v[j];
            for (slope, less) in slope.iter_mut().zip(&*bias) {
                *slope = (*slope - *less) / two;
            }
            size += norm(slope) * (v[j] / scale).abs();
        }
        size
    }

    /// Reduces the slopes to those of the free velocities, and these to the part that no
    /// combination of rows can produce. Needs room for a row.
    fn make_effective(&mut self, slopes: &mut [T], row: &mut [T]) {
        let n_rows = self.scales.rows.len();
        for k in 0..n_rows {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = slopes[j * n_rows + k];
            }
            self.keep_free(row);
            for (j, entry) in row.iter().enumerate() {
                slopes[j * n_rows + k] = *entry;
            }
        }
        for column in slopes.chunks_exact_mut(n_rows) {
            self.whole.leave_unreachable(column, regular());
        }
    }

    /// Removes from a scaled velocity what the constraints don't leave free, and what is held.
    fn keep_free(&mut self, velocity: &mut [T]) {
        self.free.leave_ineffective(velocity, regular());
        for (entry, scale) in velocity.iter_mut().zip(self.scales.columns) {
            if *scale == T::zero() {
                // A held velocity: constraints leave it free, its value does not.
                *entry = T::zero();
            }
        }
    }
}

compiled_once! {
    /// [`assemble`].
    pub(super) fn velocities<T>: Assemble<T> = assemble;
}
