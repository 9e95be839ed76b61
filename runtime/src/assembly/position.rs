//! Positions that satisfy the constraints.
//!
//! In:  a guess, which coordinates are held.
//! Out: the coordinates, to round-off.
//!
//! Newton's method with the step of least change, damped as Levenberg and
//! Marquardt do wherever the linear model promises more than it keeps.
//! Source: Moré, Lecture Notes in Mathematics 630 (1978) 105–116.

use super::decomposition::Decomposition;
use super::draft::{Assemble, Draft, Refusal};
use super::scales::{CONTRADICTION, Scales, disturb};
use super::vanishing_gradient::vanishing_row;
use crate::Real;
use crate::equations::Equations;
use crate::linalg::Workspace;
use crate::once::compiled_once;
use crate::tolerance::{negligible, regular};
use core::mem::swap;
use core::ops::Range;

/// Trial steps of one descent.
const MOST_TRIALS: usize = 300;
/// Constraint errors up to this many units of round-off are nothing but round-off.
const ROUND_OFF: f64 = 4.0;
/// Damping at which steps are too short to change anything.
const MOST_DAMPING: f64 = 1e14;
/// The factor by which damping rises and falls.
const DAMPING_FACTOR: f64 = 8.0;
/// The part of the promised improvement that a step must keep.
const KEPT_PROMISE: f64 = 0.1;
/// At a double root Newton's step goes half the way and leaves a quarter of the
/// error; between these bounds twice the step is tried.
const DOUBLE_ROOT: (f64, f64) = (0.1, 0.4);
/// Disturbances of the guess, in sizes of the coordinates, tried in turn where
/// the guess itself leads nowhere.
const DISTURBANCES: [f64; 5] = [0.0, 1e-3, 1e-2, 0.1, 1.0];

/// Moves the coordinates that are not held onto the constraints.
pub(super) fn assemble<T: Real>(
    equations: &mut dyn Equations<T>,
    draft: Draft<'_, T>,
    workspace: &Workspace<'_, T>,
) -> Result<(), Refusal> {
    let constraints = equations.structure().constraints;
    let measured = Scales::measure(equations, (draft.t, draft.q), None, workspace)
        .leave_out_velocities(constraints, workspace);
    let scales = measured.hold(draft.held, workspace);
    let guess = workspace.numbers(draft.q.len());
    guess.copy_from_slice(draft.q);
    let closest = workspace.numbers(guess.len());
    let mut least: Option<T> = None;
    let mut descent = Descent::new(equations, draft.t, scales, workspace);
    for disturbance in DISTURBANCES {
        let distance = |i: usize| match draft.held[i] {
            true => T::zero(),
            false => scales.sizes[i] * T::from_f64(disturbance),
        };
        disturb(guess, distance, descent.q);
        descent.run()?;
        if is_satisfied(descent.residual, &scales) {
            arrive_at(descent.q, &scales, draft.held, draft.q);
            return check_gradients(equations, (draft.t, draft.q), &measured, workspace);
        }
        if least.is_none_or(|least| descent.merit < least) {
            least = Some(descent.merit);
            closest.copy_from_slice(descent.q);
        }
    }
    equations.locate(draft.t, closest);
    let at = equations.constraints();
    for (k, target) in draft.residual.iter_mut().enumerate() {
        *target = contradiction(at.residual[k], measured.reach[k]);
    }
    measured.influential(at.jacobian, draft.residual, draft.held, draft.conflicting);
    Err(Refusal::Positions)
}

/// Takes over where a descent arrived. Quadratic convergence to zero goes on below all digits: what
/// is left of a coordinate there is zero, and squares of it would lose theirs.
fn arrive_at<T: Real>(arrived: &[T], scales: &Scales<'_, T>, held: &[bool], q: &mut [T]) {
    for (i, q) in q.iter_mut().enumerate() {
        let nothing = scales.sizes[i] * T::EPSILON * T::EPSILON;
        *q = match arrived[i] {
            left if left.abs() < nothing && !held[i] => T::zero(),
            arrived => arrived,
        };
    }
}

/// One descent of the constraint error.
struct Descent<'e, 'a, T> {
    equations: &'e mut dyn Equations<T>,
    scales: Scales<'a, T>,
    t: T,
    /// The position of the descent.
    q: &'a mut [T],
    /// The constraint errors there.
    residual: &'a mut [T],
    /// Sum of the squares of the scaled constraint errors.
    merit: T,
    damping: T,
    matrix: Decomposition<'a, T>,
    /// The errors that a step removes, the step, and where it leads.
    target: &'a mut [T],
    step: &'a mut [T],
    trial: &'a mut [T],
    twice: &'a mut [T],
}

impl<'e, 'a, T: Real> Descent<'e, 'a, T> {
    fn new(
        equations: &'e mut dyn Equations<T>,
        t: T,
        scales: Scales<'a, T>,
        workspace: &Workspace<'a, T>,
    ) -> Self {
        let (n, n_rows) = (scales.columns.len(), scales.rows.len());
        Self {
            equations,
            scales,
            t,
            q: workspace.numbers(n),
            residual: workspace.numbers(n_rows),
            merit: T::zero(),
            damping: T::zero(),
            matrix: Decomposition::new(n, n_rows, workspace),
            target: workspace.numbers(n_rows),
            step: workspace.numbers(n),
            trial: workspace.numbers(n),
            twice: workspace.numbers(n),
        }
    }

    /// Descends from where it is until nothing improves.
    fn run(&mut self) -> Result<(), Refusal> {
        self.merit = merit(self.equations, (self.t, self.q), &self.scales);
        if !self.merit.is_finite() {
            return Err(Refusal::NotFinite);
        }
        self.arrive();
        self.damping = T::zero();
        let mut trials = 0..MOST_TRIALS;
        while self.merit > T::zero() && self.advances(&mut trials)? {}
        Ok(())
    }

    /// Takes note of the constraint errors where they were evaluated last.
    fn arrive(&mut self) {
        let residual = self.equations.constraints().residual;
        self.residual.copy_from_slice(residual);
    }

    /// Tries steps of rising damping and takes the first that reduces the merit; whether there was
    /// one.
    fn advances(&mut self, trials: &mut Range<usize>) -> Result<bool, Refusal> {
        let jacobian = self.equations.constraints().jacobian;
        self.matrix.decompose(jacobian, &self.scales)?;
        for (k, target) in self.target.iter_mut().enumerate() {
            *target = -(self.residual[k] * self.scales.rows[k]);
        }
        // Divided by a small singular value, round-off becomes a long step. Without such steps a
        // guess that is right to round-off beside a singular configuration stays on its sheet.
        let least = match is_within(ROUND_OFF, self.residual, &self.scales) {
            true => regular(),
            false => negligible(),
        };
        while self.damping <= T::from_f64(MOST_DAMPING) && trials.next().is_some() {
            self.matrix.damp(self.damping);
            let fall = self.matrix.solve(self.target, least, self.step);
            for (step, scale) in self.step.iter_mut().zip(self.scales.columns) {
                *step *= *scale;
            }
            if self.improves(fall) {
                return Ok(true);
            }
            if self.damping == T::zero() && is_satisfied(self.residual, &self.scales) {
                return Ok(false);
            }
            self.damping = (self.damping * T::from_f64(DAMPING_FACTOR)).max(least_damping());
        }
        Ok(false)
    }

    /// Tries the step, which promises to reduce the merit by `fall`, and goes there if the
    /// promise is kept.
    fn improves(&mut self, fall: T) -> bool {
        let from = self.merit;
        add(self.q, self.step, self.trial);
        let mut to = merit(self.equations, (self.t, self.trial), &self.scales);
        if !(to < from && from - to >= fall * T::from_f64(KEPT_PROMISE)) {
            return false;
        }
        let left = (to / from).sqrt().to_f64();
        if left > DOUBLE_ROOT.0 && left < DOUBLE_ROOT.1 {
            add(self.trial, self.step, self.twice);
            let beyond = merit(self.equations, (self.t, self.twice), &self.scales);
            if beyond < to {
                swap(&mut self.trial, &mut self.twice);
                to = beyond;
            } else {
                self.equations.locate(self.t, self.trial);
            }
        }
        swap(&mut self.q, &mut self.trial);
        self.merit = to;
        self.arrive();
        self.damping /= T::from_f64(DAMPING_FACTOR);
        if self.damping < least_damping() {
            self.damping = T::zero();
        }
        true
    }
}

/// `sum := a + b`.
fn add<T: Real>(a: &[T], b: &[T], sum: &mut [T]) {
    for (sum, (a, b)) in sum.iter_mut().zip(a.iter().zip(b)) {
        *sum = *a + *b;
    }
}

/// Refuses a constraint that lost its gradient on the way and can't be crossed here.
fn check_gradients<T: Real>(
    equations: &mut dyn Equations<T>,
    (t, q): (T, &[T]),
    measured: &Scales<'_, T>,
    workspace: &Workspace<'_, T>,
) -> Result<(), Refusal> {
    let round_off = T::EPSILON * T::from_f64(CONTRADICTION);
    equations.locate(t, q);
    match vanishing_row(equations, (t, q), measured, round_off, workspace) {
        Some(row) => Err(Refusal::Vanishing(row)),
        None => Ok(()),
    }
}

/// Whether every constraint error is down to round-off.
fn is_satisfied<T: Real>(residual: &[T], scales: &Scales<'_, T>) -> bool {
    is_within(CONTRADICTION, residual, scales)
}

/// Whether every constraint error is at most this multiple of round-off.
fn is_within<T: Real>(multiple: f64, residual: &[T], scales: &Scales<'_, T>) -> bool {
    let most = T::EPSILON * T::from_f64(multiple);
    let mut errors = residual.iter().zip(scales.reach);
    errors.all(|(error, reach)| error.abs() <= most * *reach)
}

/// A constraint error that is more than round-off; else zero.
fn contradiction<T: Real>(error: T, reach: T) -> T {
    let round_off = T::EPSILON * T::from_f64(CONTRADICTION);
    if error.abs() <= round_off * reach {
        T::zero()
    } else {
        error
    }
}

/// Smallest damping that is worth having, relative to the largest singular value
/// squared: the square of the smallest singular value that counts. Between two roots close to each
/// other, more damping would make steps too short ever to reach one.
fn least_damping<T: Real>() -> T {
    negligible::<T>() * negligible()
}

/// Sum of the squares of the scaled constraint errors at a position, where the constraints
/// are evaluated.
fn merit<T: Real>(
    equations: &mut dyn Equations<T>,
    (t, q): (T, &[T]),
    scales: &Scales<'_, T>,
) -> T {
    equations.locate(t, q);
    let errors = equations.constraints().residual.iter().zip(scales.rows);
    errors.fold(T::zero(), |sum, (error, scale)| {
        let scaled = *error * *scale;
        sum + scaled * scaled
    })
}

compiled_once! {
    /// [`assemble`].
    pub(super) fn positions<T>: Assemble<T> = assemble;
}
