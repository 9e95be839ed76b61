//! The stages of the implicit methods Radau IIA of orders 5 and 9 on `(q, q̇)`.
//!
//! In:  a [`System`], the state at the start of the step.
//! Out: the projected state at its end, an error estimate, the interpolant.
//!
//! The unknowns are the accelerations `a_i` of the `S` stages. With
//! `v_i = v₀ + h Σ A_ij a_j` and `q_i = q₀ + c_i h v₀ + h² Σ (A²)_ij a_j` the equations
//! `q̈(q_i, v_i) = a_i` are solved by simplified Newton iteration, whose linear
//! systems fall apart along the eigenvectors of `A` into a real one and complex ones
//! with `W(λ) = 1 − λ h ∂q̈/∂q̇ − λ² h² ∂q̈/∂q`, `N × N`.
//! The constraints are where they are for explicit methods: inside `q̈`, and in
//! the projection of the end.
//!
//! Source: Hairer & Wanner, Solving Ordinary Differential Equations II (1996),
//! section IV.8.

use super::IntegrateError;
use super::collocation::{Collocation, Digits, MOST_STAGES, cardinal};
use super::control::Tolerance;
use super::factors::{Factors, StageVectors};
use super::jacobian::acceleration_jacobian;
use super::step::Step;
use super::step_control::{Inside, Trial};
use crate::linalg::add_scaled;
use crate::{AccelerationJacobian, DynamicsError, Real, State, System};
use nalgebra::SVector;

/// Newton's iteration ends when what is left is this part of the tolerance.
const NEWTON_PART: f64 = 0.01;
/// Where the iteration no longer improves, the accelerations have no more digits
/// to give (near singular positions, for instance); the step is made all the same
/// if what is left is this part of the tolerance, or the square root of round-off
/// with fixed steps.
const TOLERABLE_PART: f64 = 0.2;
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
/// Tolerance of Newton's iteration with fixed steps, in units of round-off.
const FIXED_PACE: f64 = 1e3;

/// The method at work.
#[derive(Clone, Debug)]
pub(crate) struct Radau<T, const N: usize> {
    coefficients: Collocation<T>,
    tolerance: Tolerance<T, N>,
    /// What may be left of Newton's iteration, in units of the tolerance.
    enough: T,
    /// The same where nothing improves any more.
    tolerable: T,
    jacobian: Option<AccelerationJacobian<T, N>>,
    factors: Option<Factors<T, N>>,
    /// Acceleration at the start of the step.
    first: SVector<T, N>,
    /// Accelerations of the stages of the trial step.
    a: StageVectors<T, N>,
    /// Those of the last accepted step, and its length; zero if there is none.
    before: (StageVectors<T, N>, T),
    /// Error estimate of the trial step.
    estimate: (SVector<T, N>, SVector<T, N>),
    /// The worst rate of convergence in the last trial.
    rate: T,
}

impl<T: Real, const N: usize> Radau<T, N> {
    /// The method; `tolerance` tells Newton's iteration when to end, which at a
    /// fixed steps is near round-off.
    #[inline(never)]
    pub(super) fn new(digits: &Digits, tolerance: Option<Tolerance<T, N>>) -> Self {
        let zero = SVector::zeros();
        let (tolerance, tolerable) = match tolerance {
            Some(tolerance) => (tolerance, T::from_f64(TOLERABLE_PART)),
            None => {
                let unit = T::EPSILON * T::from_f64(FIXED_PACE);
                (Tolerance::round_off(FIXED_PACE), T::EPSILON.sqrt() / unit)
            }
        };
        Self {
            coefficients: Collocation::new(digits),
            enough: tolerance.part(NEWTON_PART),
            tolerable,
            tolerance,
            jacobian: None,
            factors: None,
            first: zero,
            a: [zero; MOST_STAGES],
            before: ([zero; MOST_STAGES], T::zero()),
            estimate: (zero, zero),
            rate: T::from_f64(UNKNOWN_RATE),
        }
    }

    /// How many stages there are.
    fn stages(&self) -> usize {
        self.coefficients.stages
    }

    /// The states of the stages of a step of length `h`.
    #[inline(never)]
    fn states(
        &self,
        start: &State<T, N>,
        a: &StageVectors<T, N>,
        h: T,
    ) -> [State<T, N>; MOST_STAGES] {
        let Collocation {
            nodes,
            matrix,
            square,
            ..
        } = &self.coefficients;
        let mut states = [*start; MOST_STAGES];
        for (i, state) in states.iter_mut().enumerate().take(self.stages()) {
            let (mut q, mut v) = (start.v * nodes[i], SVector::<T, N>::zeros());
            for (j, a) in a.iter().enumerate().take(self.stages()) {
                add_scaled(q.as_mut_slice(), h * square[i][j], a.as_slice());
                add_scaled(v.as_mut_slice(), matrix[i][j], a.as_slice());
            }
            state.t = start.t + h * nodes[i];
            state.q += q * h;
            state.v += v * h;
        }
        states
    }

    /// Accelerations to begin the iteration with: those of the last step's
    /// stages, extrapolated.
    #[inline(never)]
    fn guess(&self, h: T) -> StageVectors<T, N> {
        let (before, length) = &self.before;
        if *length <= T::zero() {
            return [self.first; MOST_STAGES];
        }
        let nodes = &self.coefficients.nodes[..self.stages()];
        let mut guess = [SVector::<T, N>::zeros(); MOST_STAGES];
        for (guess, node) in guess.iter_mut().zip(nodes) {
            let x = T::one() + *node * h / *length;
            for (j, a) in before.iter().enumerate().take(nodes.len()) {
                add_scaled(guess.as_mut_slice(), cardinal(nodes, j, x), a.as_slice());
            }
        }
        guess
    }

    /// Makes derivatives and factors fit the step length `h`.
    #[inline(never)]
    fn prepare<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        step: &mut Step<T, N>,
        h: T,
    ) -> Result<(), IntegrateError<T>> {
        let start = step.start;
        if self.jacobian.is_none() {
            let (jacobian, evaluations) = acceleration_jacobian(system, &start, &self.first)?;
            step.evaluations += evaluations;
            self.jacobian = Some(jacobian);
            self.factors = None;
        }
        if self.factors.as_ref().is_none_or(|factors| factors.h != h) {
            let jacobian = self.jacobian.as_ref();
            self.factors =
                jacobian.and_then(|jacobian| Factors::new(jacobian, h, &self.coefficients));
        }
        match self.factors {
            Some(_) => Ok(()),
            None => Err(IntegrateError::NewtonDiverged { t: start.t, h }),
        }
    }

    /// Newton's iteration for all stages of a step of length `h`.
    #[inline(never)]
    fn solve<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        step: &mut Step<T, N>,
        h: T,
    ) -> Result<(), IntegrateError<T>> {
        self.prepare(system, step, h)?;
        let failure = IntegrateError::NewtonDiverged { t: step.start.t, h };
        // The rate of the last step until this one has shown its own.
        let expected = self
            .rate
            .max(T::from_f64(BEST_RATE))
            .min(T::from_f64(UNKNOWN_RATE));
        self.rate = T::zero();
        let mut a = self.guess(h);
        let mut before: Option<T> = None;
        for _ in 0..MOST_ITERATIONS {
            let size = self.iterate(system, step, h, &mut a)?;
            let rate = before.map_or(expected, |before| size / before);
            if before.is_some() {
                self.rate = self.rate.max(rate);
            }
            let hopeless = rate >= T::from_f64(WORST_RATE);
            if !size.is_finite() || hopeless && size > self.tolerable {
                return Err(failure);
            }
            if hopeless || size * rate <= self.enough * (T::one() - rate) {
                self.a = a;
                return Ok(());
            }
            before = Some(size);
        }
        Err(failure)
    }

    /// One iteration; the size of the change in units of the tolerance.
    #[inline(never)]
    fn iterate<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        step: &mut Step<T, N>,
        h: T,
        a: &mut StageVectors<T, N>,
    ) -> Result<T, IntegrateError<T>> {
        let stages = self.stages();
        let start = step.start;
        let before = self.states(&start, a, h);
        let mut rest = *a;
        for (rest, state) in rest.iter_mut().zip(&before[..stages]) {
            step.evaluations += 1;
            *rest = system.acceleration(state)? - *rest;
        }
        let failure = IntegrateError::NewtonDiverged { t: start.t, h };
        let factors = self.factors.as_ref().ok_or(failure)?;
        let change = factors.solve(&rest, &self.coefficients);
        for (a, change) in a.iter_mut().zip(&change[..stages]) {
            *a += change;
        }
        let after = self.states(&start, a, h);
        let mut sum = T::zero();
        for (after, before) in after.iter().zip(&before[..stages]) {
            let (dq, dv) = (after.q - before.q, after.v - before.v);
            let size = self.tolerance.norm((&dq, &dv), &start, after);
            sum += size * size;
        }
        Ok((sum / T::from_f64(stages as f64)).sqrt())
    }

    /// The size of the estimate in units of a tolerance.
    fn size(&self, step: &Step<T, N>, tolerance: &Tolerance<T, N>) -> T {
        let (q, v) = &self.estimate;
        tolerance.norm((q, v), &step.start, &step.end)
    }

    /// The error estimate of a step (IV.8.19), with the derivatives at the start, or
    /// near it for a second look (IV.8.20): the derivatives are compared with those that
    /// the stages lead back to.
    #[inline(never)]
    fn estimate(
        &self,
        states: &[State<T, N>],
        h: T,
        (v, a): (&SVector<T, N>, &SVector<T, N>),
    ) -> (SVector<T, N>, SVector<T, N>) {
        let (Some(factors), Some(jacobian)) = (&self.factors, &self.jacobian) else {
            return (SVector::zeros(), SVector::zeros());
        };
        let factor = self.coefficients.real.value * h;
        let (mut dq, mut dv) = (v * factor, a * factor);
        for (i, state) in states.iter().enumerate() {
            let weight = self.coefficients.start[i] * factor;
            dq -= state.v * weight;
            dv -= self.a[i] * weight;
        }
        // Filtered, so that it stays small where stiff parts have died out.
        let right = dv + jacobian.q * dq * factor;
        let dv = SVector::from(factors.real.solve(&right.data.0[0]));
        (dq + dv * factor, dv)
    }
}

impl<T: Real, const N: usize, Y: System<T, N> + ?Sized> Trial<T, N, Y> for Radau<T, N> {
    fn begin(
        &mut self,
        system: &mut Y,
        step: &mut Step<T, N>,
        goes_on: bool,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        if !goes_on {
            self.jacobian = None;
            self.before.1 = T::zero();
        }
        step.evaluations += 1;
        self.first = system.acceleration(&step.start)?;
        Ok(self.first)
    }

    fn attempt(
        &mut self,
        system: &mut Y,
        step: &mut Step<T, N>,
        end: T,
    ) -> Result<(), IntegrateError<T>> {
        let start = step.start;
        let h = end - start.t;
        let fresh = self.jacobian.is_none();
        let mut result = self.solve(system, step, h);
        if result.is_err() && !fresh {
            self.jacobian = None;
            result = self.solve(system, step, h);
        }
        result?;
        let states = self.states(&start, &self.a, h);
        let states = &states[..self.stages()];
        let mut last = State {
            t: end,
            ..states[self.stages() - 1]
        };
        step.end = last;
        self.estimate = self.estimate(states, h, (&start.v, &self.first));
        let first = self.before.1 <= T::zero();
        if (first || step.rejected > 0) && self.size(step, &self.tolerance) >= T::one() {
            // Stiff parts that are not in balance yet look like errors.
            let (q, v) = self.estimate;
            let near = State {
                t: start.t,
                q: start.q + q,
                v: start.v + v,
            };
            step.evaluations += 1;
            let a = system.acceleration(&near)?;
            self.estimate = self.estimate(states, h, (&near.v, &a));
        }
        system.project(&mut last)?;
        step.end = last;
        Ok(())
    }

    fn error(&self, step: &Step<T, N>, tolerance: &Tolerance<T, N>) -> T {
        self.size(step, tolerance)
    }

    fn accept(
        &mut self,
        _: &mut Y,
        step: &mut Step<T, N>,
        inside: Inside,
    ) -> Result<(), DynamicsError<T>> {
        let h = step.length();
        if inside != Inside::Nothing {
            let states = self.states(&step.start, &self.a, h);
            let inner = self.stages() - 1;
            step.set_stages(&self.coefficients.nodes[..inner], &states[..inner]);
        }
        self.before = (self.a, h);
        if self.rate > T::from_f64(GOOD_RATE) {
            self.jacobian = None;
        }
        Ok(())
    }
}
