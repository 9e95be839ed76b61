//! Newton's iteration for the stages of the implicit methods.
//!
//! In:  a [`Flow`], the state at the start of the step.
//! Out: accelerations of the stages, the end of the step before its projection, an error
//!      estimate.
//!
//! Everything is over slices, and compiled once for mechanisms of all sizes, for three stages
//! and for five. Vectors of several stages are one after the other.
//!
//! Source: Hairer & Wanner, Solving Ordinary Differential Equations II (1996),
//! section IV.8.

use super::IntegrateError;
use super::collocation::{Collocation, MOST_STAGES, by_stage, product, weigh};
use super::control::Scale;
use super::factors::{Changes, Factors};
use super::jacobian::{Flow, differentiate};
use super::rule::{Rule, by_stage_mut};
use crate::Real;
use crate::equations::At;
use crate::linalg::{Workspace, add_scaled, column, scaled};
use crate::once::compiled_once;

/// Vectors of all coordinates that an attempt at a step takes room for.
pub(super) const VECTORS: usize = 3 * MOST_STAGES + 6;

/// Iterations after which a step is given up.
const MOST_ITERATIONS: usize = 10;
/// Derivatives with which Newton's iteration converges faster than this are kept
/// for the next step.
const GOOD_RATE: f64 = 0.02;
/// The best rate of convergence that is expected before one was seen.
const BEST_RATE: f64 = 1e-3;
/// The factor by which the rate is expected to be worse after a step that did not show it.
const OLDER: f64 = 1.25;
/// The rate that is assumed where nothing better is known.
const UNKNOWN_RATE: f64 = 0.5;
/// Rate of convergence at which a step is given up.
const WORST_RATE: f64 = 0.9;

/// What an iteration knows from one step to the next, whatever the sizes are.
#[derive(Clone, Debug)]
pub(super) struct Course<T> {
    pub(super) coefficients: Collocation<T>,
    /// What may be left of Newton's iteration, in units of the tolerance.
    pub(super) enough: T,
    /// What may be left of Newton's iteration where it no longer improves, in units of the
    /// tolerance.
    pub(super) tolerable: T,
    /// Whether there are derivatives.
    differentiated: bool,
    /// The step length that there are factors for; zero if there are none.
    factored: T,
    /// The length of the last accepted step; zero if there is none.
    before: T,
    /// The worst rate of convergence in the last trial that showed one, raised for each trial
    /// since.
    rate: T,
    /// Whether the last trial showed its rate: one iteration shows none.
    shown: bool,
}

/// The iteration at work.
pub(crate) struct Newton<'a, T> {
    pub(super) course: &'a mut Course<T>,
    pub(super) scale: Scale<'a, T>,
    /// `∂q̈/∂q` and `∂q̈/∂q̇`.
    pub(super) derivatives: (&'a mut [T], &'a mut [T]),
    pub(super) factors: Factors<'a, T>,
    /// Acceleration at the start of the step.
    pub(super) first: &'a [T],
    /// Accelerations of the stages of the trial step.
    pub(super) a: &'a mut [T],
    /// Accelerations of the stages of the last accepted step.
    pub(super) before: &'a [T],
    /// The end of the trial step.
    pub(super) end: (&'a mut [T], &'a mut [T]),
    /// The error estimate of the trial step.
    pub(super) estimate: (&'a mut [T], &'a mut [T]),
}

/// What an iteration needs room for.
struct Room<'a, T> {
    /// Coordinates of the stages.
    q: &'a mut [T],
    /// Velocities of the stages.
    v: &'a mut [T],
    /// The accelerations that follow from them.
    found: &'a mut [T],
    pair: (&'a mut [T], &'a mut [T]),
}

impl<T: Real> Course<T> {
    pub(super) fn new(coefficients: Collocation<T>, enough: T, tolerable: T) -> Self {
        Self {
            coefficients,
            enough,
            tolerable,
            differentiated: false,
            factored: T::zero(),
            before: T::zero(),
            rate: T::from_f64(UNKNOWN_RATE),
            shown: false,
        }
    }

    /// Forgets the last step.
    pub(super) fn forget(&mut self) {
        self.differentiated = false;
        self.before = T::zero();
    }

    /// Takes note of the rate between two iterations of a trial.
    fn observe(&mut self, rate: T) {
        self.rate = match self.shown {
            true => self.rate.max(rate),
            false => rate,
        };
        self.shown = true;
    }

    /// Takes note of an accepted step.
    pub(super) fn accept(&mut self, h: T) {
        self.before = h;
        self.differentiated &= !self.shown || self.rate <= T::from_f64(GOOD_RATE);
    }
}

impl<'a, T: Real> Room<'a, T> {
    /// Room for so many stages of `n` coordinates.
    fn new(stages: usize, n: usize, workspace: &Workspace<'a, T>) -> Self {
        // All in one piece, since each piece has a price.
        let all = workspace.any((3 * stages + 2) * n);
        let (q, all) = all.split_at_mut(stages * n);
        let (v, all) = all.split_at_mut(stages * n);
        let (found, pair) = all.split_at_mut(stages * n);
        let pair = pair.split_at_mut(n);
        Self { q, v, found, pair }
    }
}

impl<T: Real> Newton<'_, T> {
    /// Makes a trial step to the time `end` with a method of `S` stages; `again` after others
    /// from the same start.
    fn attempt<const S: usize>(
        &mut self,
        flow: &mut dyn Flow<T>,
        start: At<'_, T>,
        (end, again): (T, bool),
        workspace: &Workspace<'_, T>,
    ) -> Result<(), IntegrateError<T>> {
        let n = start.q.len();
        let rule = Rule::<T, S>::new(&self.course.coefficients, end - start.t);
        let mut room = Room::new(S, n, workspace);
        let fresh = !self.course.differentiated;
        let mut result = self.solve(flow, start, &rule, &mut room, workspace);
        if result.is_err() && !fresh {
            self.course.differentiated = false;
            result = self.solve(flow, start, &rule, &mut room, workspace);
        }
        result?;
        let last = (S - 1) * n;
        self.end.0.copy_from_slice(&room.q[last..][..n]);
        self.end.1.copy_from_slice(&room.v[last..][..n]);
        self.look_back(&rule, (start.v, self.first), &mut room);
        let first = self.course.before <= T::zero();
        if (first || again) && self.size(start) >= T::one() {
            // Stiff parts that are not in balance yet look like errors.
            let (q, v) = (workspace.any(n), workspace.any(n));
            q.copy_from_slice(start.q);
            v.copy_from_slice(start.v);
            add_scaled(q, T::one(), self.estimate.0);
            add_scaled(v, T::one(), self.estimate.1);
            let (t, a) = (start.t, workspace.numbers(n));
            flow.accelerate(At { t, q, v }, a)?;
            self.look_back(&rule, (v, a), &mut room);
        }
        Ok(())
    }

    /// The size of the estimate in units of the tolerance.
    fn size(&self, start: At<'_, T>) -> T {
        let error = (&*self.estimate.0, &*self.estimate.1);
        let end = (&*self.end.0, &*self.end.1);
        self.scale.norm(error, (start.q, start.v), end)
    }

    /// Makes derivatives and factors fit the step length `h`.
    fn prepare(
        &mut self,
        flow: &mut dyn Flow<T>,
        start: At<'_, T>,
        h: T,
        workspace: &Workspace<'_, T>,
    ) -> Result<(), IntegrateError<T>> {
        let (by_q, by_v) = (&mut *self.derivatives.0, &mut *self.derivatives.1);
        if !self.course.differentiated {
            self.course.factored = T::zero();
            workspace.scope(|room| differentiate(flow, start, self.first, (by_q, by_v), room))?;
            self.course.differentiated = true;
        }
        if self.course.factored != h {
            self.course.factored = T::zero();
            let coefficients = &self.course.coefficients;
            let (factors, derivatives) = (&mut self.factors, (&*by_q, &*by_v));
            if !workspace.scope(|room| factors.factorise(derivatives, h, coefficients, room)) {
                return Err(IntegrateError::NewtonDiverged { t: start.t, h });
            }
            self.course.factored = h;
        }
        Ok(())
    }

    /// Newton's iteration for all stages of a step; the room has their states afterwards.
    fn solve<const S: usize>(
        &mut self,
        flow: &mut dyn Flow<T>,
        start: At<'_, T>,
        rule: &Rule<T, S>,
        room: &mut Room<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<(), IntegrateError<T>> {
        let h = rule.h;
        self.prepare(flow, start, h, workspace)?;
        let failure = IntegrateError::NewtonDiverged { t: start.t, h };
        // The rate of the last steps is used until this one has shown its own. Steps of one
        // iteration show none, while the derivatives grow older.
        let unknown = T::from_f64(UNKNOWN_RATE);
        let expected = self.course.rate.max(T::from_f64(BEST_RATE)).min(unknown);
        self.course.rate = (expected * T::from_f64(OLDER)).min(unknown);
        self.course.shown = false;
        self.guess(rule);
        rule.set_states(start, self.a, (room.q, room.v));
        let mut before: Option<T> = None;
        for _ in 0..MOST_ITERATIONS {
            let size = self.iterate(flow, start, rule, room)?;
            let rate = before.map_or(expected, |before| size / before);
            if before.is_some() {
                self.course.observe(rate);
            }
            let hopeless = rate >= T::from_f64(WORST_RATE);
            if !size.is_finite() || hopeless && size > self.course.tolerable {
                return Err(failure);
            }
            if hopeless || size * rate <= self.course.enough * (T::one() - rate) {
                return Ok(());
            }
            before = Some(size);
        }
        Err(failure)
    }

    /// Accelerations to begin the iteration with: those of the last step's
    /// stages, extrapolated.
    fn guess<const S: usize>(&mut self, rule: &Rule<T, S>) {
        let n = self.first.len();
        let length = self.course.before;
        let nodes = &rule.nodes;
        let before = by_stage::<T, S>(self.before, n);
        for (i, node) in nodes.iter().enumerate() {
            let guess = &mut self.a[i * n..][..n];
            if length <= T::zero() {
                guess.copy_from_slice(self.first);
                continue;
            }
            let x = T::one() + *node * rule.h / length;
            let mut weights = [T::zero(); MOST_STAGES];
            for (j, weight) in weights.iter_mut().enumerate().take(S) {
                *weight = product(nodes, j, x);
            }
            for (k, guess) in guess.iter_mut().enumerate() {
                *guess = weigh::<T, S>(&weights, &column(|j| before[j][k]), T::zero());
            }
        }
    }

    /// One iteration; the size of the change in units of the tolerance.
    #[inline(always)]
    fn iterate<const S: usize>(
        &mut self,
        flow: &mut dyn Flow<T>,
        start: At<'_, T>,
        rule: &Rule<T, S>,
        room: &mut Room<'_, T>,
    ) -> Result<T, IntegrateError<T>> {
        let n = start.q.len();
        for (i, node) in rule.nodes.iter().enumerate() {
            let stage = i * n..(i + 1) * n;
            let at = At {
                t: start.t + rule.h * *node,
                q: &room.q[stage.clone()],
                v: &room.v[stage.clone()],
            };
            flow.accelerate(at, &mut room.found[stage])?;
        }
        let pair = (&mut *room.pair.0, &mut *room.pair.1);
        let (a, coefficients) = (&mut *self.a, &self.course.coefficients);
        let changes = self.factors.solve::<S>((a, room.found), pair, coefficients);
        Ok(correct(
            (a, room.q, room.v),
            &changes,
            (start, rule),
            &self.scale,
        ))
    }

    /// The error estimate of a step (IV.8.19), with the derivatives at the start, or
    /// near it for a second look (IV.8.20): the derivatives are compared with those that
    /// the stages lead back to.
    fn look_back<const S: usize>(
        &mut self,
        rule: &Rule<T, S>,
        (v, a): (&[T], &[T]),
        room: &mut Room<'_, T>,
    ) {
        let n = v.len();
        let coefficients = &self.course.coefficients;
        let right = &mut *room.pair.0;
        let factor = coefficients.real.value * rule.h;
        let (dq, dv) = (&mut *self.estimate.0, &mut *self.estimate.1);
        let shares = scaled(-factor, &coefficients.start);
        let velocities = by_stage::<T, S>(room.v, n);
        let others = by_stage::<T, S>(self.a, n);
        let (dq, dv, a, right) = (&mut dq[..n], &mut dv[..n], &a[..n], &mut right[..n]);
        for k in 0..n {
            dq[k] = weigh::<T, S>(&shares, &column(|j| velocities[j][k]), factor * v[k]);
            dv[k] = weigh::<T, S>(&shares, &column(|j| others[j][k]), factor * a[k]);
        }
        // Filtered, so that it stays small where stiff parts have died out.
        let by_q = &self.derivatives.0[..n * n];
        for k in 0..n {
            let mut sum = T::zero();
            for (j, dq) in dq.iter().enumerate() {
                sum = dq.mul_add(by_q[j * n + k], sum);
            }
            right[k] = factor.mul_add(sum, dv[k]);
        }
        self.factors.solve_real(right, dv);
        add_scaled(dq, factor, dv);
    }
}

/// Adds changes to the accelerations of all stages, and writes the states that follow; the
/// size of the change of the states in units of the tolerance.
#[inline(always)]
fn correct<T: Real, const S: usize>(
    (a, q, v): (&mut [T], &mut [T], &mut [T]),
    changes: &Changes<'_, T>,
    (start, rule): (At<'_, T>, &Rule<T, S>),
    scale: &Scale<'_, T>,
) -> T {
    let n = start.q.len();
    let (start_q, start_v, scale) = (&start.q[..n], &start.v[..n], scale.first(n));
    let mut a = by_stage_mut::<T, S>(a, n);
    let (q, v) = (by_stage_mut::<T, S>(q, n), by_stage_mut::<T, S>(v, n));
    let mut sums = [T::zero(); S];
    for k in 0..n {
        let start = (start_q[k], start_v[k]);
        let mut next = changes.at::<S>(k);
        for (next, a) in next.iter_mut().zip(&mut a) {
            *next += a[k];
            a[k] = *next;
        }
        for i in 0..S {
            let end = rule.state(i, start, &next);
            let change = (q[i][k] - end.0, v[i][k] - end.1);
            sums[i] += scale.square(k, change, start, end);
            (q[i][k], v[i][k]) = end;
        }
    }
    let sum = sums.iter().fold(T::zero(), |sum, squares| {
        let size = scale.mean(*squares);
        sum + size * size
    });
    (sum / T::from_f64(S as f64)).sqrt()
}

compiled_once! {
    /// [`Newton::attempt`] with the number of stages that there are.
    pub(super) fn attempting<T>: fn(
        &mut Newton<'_, T>,
        &mut dyn Flow<T>,
        At<'_, T>,
        (T, bool),
        &Workspace<'_, T>,
    ) -> Result<(), IntegrateError<T>> =
        |newton, flow, start, end, workspace| match newton.course.coefficients.stages {
            3 => newton.attempt::<3>(flow, start, end, workspace),
            _ => newton.attempt::<5>(flow, start, end, workspace),
        };
}
