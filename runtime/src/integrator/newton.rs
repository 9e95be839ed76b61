//! Newton's iteration for the stages of the implicit methods.
//!
//! In:  a [`Flow`], the state at the start of the step.
//! Out: accelerations of the stages, the end of the step before its projection, an error
//!      estimate.
//!
//! Everything is over slices, and compiled once for mechanisms of all sizes. Vectors of
//! several stages are one after the other.
//!
//! Source: Hairer & Wanner, Solving Ordinary Differential Equations II (1996),
//! section IV.8.

use super::IntegrateError;
use super::collocation::{Collocation, MOST_STAGES, by_stage, cardinal, weigh};
use super::control::Scale;
use super::factors::Factors;
use super::jacobian::{Flow, differentiate};
use crate::Real;
use crate::equations::At;
use crate::linalg::{Workspace, add_scaled, scaled};
use crate::once::compiled_once;

/// Vectors of all coordinates that an attempt at a step takes room for.
pub(super) const VECTORS: usize = 6 * MOST_STAGES + 5;

/// Iterations after which a step is given up.
const MOST_ITERATIONS: usize = 10;
/// Derivatives with which Newton's iteration converges faster than this are kept
/// for the next step.
const GOOD_RATE: f64 = 0.02;
/// The rates of convergence that are believed before they were seen.
const BEST_RATE: f64 = 1e-3;
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
    /// The same where nothing improves any more.
    pub(super) tolerable: T,
    /// Whether there are derivatives.
    differentiated: bool,
    /// The step length that there are factors for; zero if there are none.
    factored: T,
    /// The length of the last accepted step; zero if there is none.
    before: T,
    /// The worst rate of convergence in the last trial.
    rate: T,
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
    /// Those of the last accepted step.
    pub(super) before: &'a [T],
    /// The end of the trial step.
    pub(super) end: (&'a mut [T], &'a mut [T]),
    /// Its error estimate.
    pub(super) estimate: (&'a mut [T], &'a mut [T]),
}

/// Coordinates and velocities of the stages.
struct Stages<'a, T> {
    q: &'a mut [T],
    v: &'a mut [T],
}

/// What an iteration needs room for.
struct Room<'a, T> {
    before: Stages<'a, T>,
    after: Stages<'a, T>,
    rest: &'a mut [T],
    change: &'a mut [T],
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
        }
    }

    /// Forgets the last step.
    pub(super) fn forget(&mut self) {
        self.differentiated = false;
        self.before = T::zero();
    }

    /// Takes note of an accepted step.
    pub(super) fn accept(&mut self, h: T) {
        self.before = h;
        self.differentiated &= self.rate <= T::from_f64(GOOD_RATE);
    }
}

impl<T: Real> Collocation<T> {
    /// Writes the states of the stages of a step of length `h` with these accelerations.
    pub(super) fn set_states(&self, start: At<'_, T>, a: &[T], h: T, (q, v): (&mut [T], &mut [T])) {
        let n = start.q.len();
        let (start_q, start_v) = (&start.q[..n], &start.v[..n]);
        let a = by_stage(a, n);
        for i in 0..self.stages {
            let (node, row) = (self.nodes[i], &self.matrix[i]);
            let square = scaled(h, &self.square[i]);
            let (q, v) = (&mut q[i * n..][..n], &mut v[i * n..][..n]);
            for k in 0..n {
                let moved = weigh(&square, &a, k, node * start_v[k]);
                q[k] = h.mul_add(moved, start_q[k]);
                v[k] = h.mul_add(weigh(row, &a, k, T::zero()), start_v[k]);
            }
        }
    }
}

impl<'a, T: Real> Stages<'a, T> {
    fn new(size: usize, workspace: &Workspace<'a, T>) -> Self {
        Self {
            q: workspace.numbers(size),
            v: workspace.numbers(size),
        }
    }

    fn set(&mut self, coefficients: &Collocation<T>, start: At<'_, T>, a: &[T], h: T) {
        coefficients.set_states(start, a, h, (self.q, self.v));
    }
}

impl<T: Real> Newton<'_, T> {
    /// Makes a trial step to the time `end`; `again` after others from the same start.
    pub(crate) fn attempt(
        &mut self,
        flow: &mut dyn Flow<T>,
        start: At<'_, T>,
        (end, again): (T, bool),
        workspace: &Workspace<'_, T>,
    ) -> Result<(), IntegrateError<T>> {
        let h = end - start.t;
        let (n, size) = (start.q.len(), self.a.len());
        let mut room = Room {
            before: Stages::new(size, workspace),
            after: Stages::new(size, workspace),
            rest: workspace.numbers(size),
            change: workspace.numbers(size),
            pair: (workspace.numbers(n), workspace.numbers(n)),
        };
        let fresh = !self.course.differentiated;
        let mut result = self.solve(flow, start, h, &mut room, workspace);
        if result.is_err() && !fresh {
            self.course.differentiated = false;
            result = self.solve(flow, start, h, &mut room, workspace);
        }
        result?;
        let Room {
            before: states,
            change: a,
            pair: (right, solved),
            ..
        } = room;
        let coefficients = &self.course.coefficients;
        coefficients.set_states(start, self.a, h, (states.q, states.v));
        let last = (coefficients.stages - 1) * n;
        self.end.0.copy_from_slice(&states.q[last..][..n]);
        self.end.1.copy_from_slice(&states.v[last..][..n]);
        self.look_back(states.v, h, (start.v, self.first), (right, solved));
        let first = self.course.before <= T::zero();
        if (first || again) && self.size(start) >= T::one() {
            // Stiff parts that are not in balance yet look like errors.
            let (q, v) = (workspace.numbers(n), workspace.numbers(n));
            q.copy_from_slice(start.q);
            v.copy_from_slice(start.v);
            add_scaled(q, T::one(), self.estimate.0);
            add_scaled(v, T::one(), self.estimate.1);
            let (t, a) = (start.t, &mut a[..n]);
            flow.accelerate(At { t, q, v }, a)?;
            self.look_back(states.v, h, (v, a), (right, solved));
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

    /// Newton's iteration for all stages of a step of length `h`.
    fn solve(
        &mut self,
        flow: &mut dyn Flow<T>,
        start: At<'_, T>,
        h: T,
        room: &mut Room<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<(), IntegrateError<T>> {
        self.prepare(flow, start, h, workspace)?;
        let failure = IntegrateError::NewtonDiverged { t: start.t, h };
        // The rate of the last step until this one has shown its own.
        let expected = self
            .course
            .rate
            .max(T::from_f64(BEST_RATE))
            .min(T::from_f64(UNKNOWN_RATE));
        self.course.rate = T::zero();
        self.guess(h);
        let mut before: Option<T> = None;
        for _ in 0..MOST_ITERATIONS {
            let size = self.iterate(flow, start, h, room)?;
            let rate = before.map_or(expected, |before| size / before);
            if before.is_some() {
                self.course.rate = self.course.rate.max(rate);
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
    fn guess(&mut self, h: T) {
        let n = self.first.len();
        let Course {
            coefficients,
            before: length,
            ..
        } = &*self.course;
        let nodes = &coefficients.nodes[..coefficients.stages];
        let before = by_stage(self.before, n);
        for (i, node) in nodes.iter().enumerate() {
            let guess = &mut self.a[i * n..][..n];
            if *length <= T::zero() {
                guess.copy_from_slice(self.first);
                continue;
            }
            let x = T::one() + *node * h / *length;
            let mut weights = [T::zero(); MOST_STAGES];
            for (j, weight) in weights.iter_mut().enumerate().take(nodes.len()) {
                *weight = cardinal(nodes, j, x);
            }
            for (k, guess) in guess.iter_mut().enumerate() {
                *guess = weigh(&weights, &before, k, T::zero());
            }
        }
    }

    /// One iteration; the size of the change in units of the tolerance.
    fn iterate(
        &mut self,
        flow: &mut dyn Flow<T>,
        start: At<'_, T>,
        h: T,
        room: &mut Room<'_, T>,
    ) -> Result<T, IntegrateError<T>> {
        let n = start.q.len();
        let coefficients = &self.course.coefficients;
        let Room {
            before,
            after,
            rest,
            change,
            pair,
        } = room;
        before.set(coefficients, start, self.a, h);
        for (i, node) in coefficients.nodes[..coefficients.stages].iter().enumerate() {
            let stage = i * n..(i + 1) * n;
            let at = At {
                t: start.t + h * *node,
                q: &before.q[stage.clone()],
                v: &before.v[stage.clone()],
            };
            let rest = &mut rest[stage.clone()];
            flow.accelerate(at, rest)?;
            add_scaled(rest, -T::one(), &self.a[stage]);
        }
        let pair = (&mut *pair.0, &mut *pair.1);
        self.factors.solve((rest, change), pair, coefficients);
        let used = ..coefficients.stages * n;
        add_scaled(&mut self.a[used], T::one(), change);
        after.set(coefficients, start, self.a, h);
        // The changes, in place of the states before.
        add_scaled(&mut before.q[used], -T::one(), after.q);
        add_scaled(&mut before.v[used], -T::one(), after.v);
        let mut sum = T::zero();
        for i in 0..coefficients.stages {
            let stage = i * n..(i + 1) * n;
            let error = (&before.q[stage.clone()], &before.v[stage.clone()]);
            let end = (&after.q[stage.clone()], &after.v[stage]);
            let size = self.scale.norm(error, (start.q, start.v), end);
            sum += size * size;
        }
        Ok((sum / T::from_f64(coefficients.stages as f64)).sqrt())
    }

    /// The error estimate of a step (IV.8.19), with the derivatives at the start, or
    /// near it for a second look (IV.8.20): the derivatives are compared with those that
    /// the stages lead back to.
    fn look_back(
        &mut self,
        velocities: &[T],
        h: T,
        (v, a): (&[T], &[T]),
        (right, solved): (&mut [T], &mut [T]),
    ) {
        let n = v.len();
        let coefficients = &self.course.coefficients;
        let factor = coefficients.real.value * h;
        let (dq, dv) = (&mut *self.estimate.0, &mut *self.estimate.1);
        let shares = scaled(-factor, &coefficients.start);
        let (velocities, others) = (by_stage(velocities, n), by_stage(self.a, n));
        for k in 0..n {
            dq[k] = weigh(&shares, &velocities, k, factor * v[k]);
            dv[k] = weigh(&shares, &others, k, factor * a[k]);
        }
        // Filtered, so that it stays small where stiff parts have died out.
        right.fill(T::zero());
        for (column, dq) in self.derivatives.0.chunks_exact(n.max(1)).zip(&*dq) {
            add_scaled(right, *dq, column);
        }
        for (right, dv) in right.iter_mut().zip(&*dv) {
            *right = factor.mul_add(*right, *dv);
        }
        self.factors.solve_real(right, solved);
        dv.copy_from_slice(solved);
        add_scaled(dq, factor, dv);
    }
}

compiled_once! {
    /// [`Newton::attempt`].
    pub(super) fn attempting<T>: fn(
        &mut Newton<'_, T>,
        &mut dyn Flow<T>,
        At<'_, T>,
        (T, bool),
        &Workspace<'_, T>,
    ) -> Result<(), IntegrateError<T>> =
        |newton, flow, start, end, workspace| newton.attempt(flow, start, end, workspace);
}
