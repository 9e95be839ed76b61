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
use super::collocation::{Collocation, cardinal};
use super::control::Tolerance;
use super::factors::{Factors, StageVectors};
use super::jacobian::acceleration_jacobian;
use super::step::Step;
use super::step_control::{Inside, Trial};
use super::tableau::Tableau;
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
pub(super) struct Radau<T, const N: usize, const S: usize> {
    tableau: &'static Tableau,
    coefficients: Collocation<T, S>,
    inside: Inside,
    step: Step<T, N>,
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
    a: StageVectors<T, N, S>,
    /// Those of the last accepted step, and its length; zero if there is none.
    before: (StageVectors<T, N, S>, T),
    /// Error estimate of the trial step.
    estimate: (SVector<T, N>, SVector<T, N>),
    /// The worst rate of convergence in the last trial.
    rate: T,
}

impl<T: Real, const N: usize, const S: usize> Radau<T, N, S> {
    /// The method; `tolerance` tells Newton's iteration when to end, which at a
    /// fixed steps is near round-off.
    pub(super) fn new(tableau: &'static Tableau, tolerance: Option<Tolerance<T, N>>) -> Self {
        let zero = SVector::zeros();
        let (tolerance, tolerable) = match tolerance {
            Some(tolerance) => (tolerance, T::from_f64(TOLERABLE_PART)),
            None => {
                let unit = T::EPSILON * T::from_f64(FIXED_PACE);
                (Tolerance::round_off(FIXED_PACE), T::EPSILON.sqrt() / unit)
            }
        };
        Self {
            tableau,
            coefficients: Collocation::new(),
            inside: Inside::Full,
            step: Step::new(),
            enough: tolerance.part(NEWTON_PART),
            tolerable,
            tolerance,
            jacobian: None,
            factors: None,
            first: zero,
            a: [zero; S],
            before: ([zero; S], T::zero()),
            estimate: (zero, zero),
            rate: T::from_f64(UNKNOWN_RATE),
        }
    }

    /// Computes the acceleration at a state.
    fn evaluate<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        self.step.evaluations += 1;
        system.acceleration(state)
    }

    /// The state of a stage of a step of length `h`.
    fn stage(&self, a: &StageVectors<T, N, S>, h: T, i: usize) -> State<T, N> {
        let Collocation {
            nodes,
            matrix,
            square,
            ..
        } = &self.coefficients;
        let start = &self.step.start;
        let (mut q, mut v) = (start.v * nodes[i], SVector::<T, N>::zeros());
        for (j, a) in a.iter().enumerate() {
            q.axpy(h * square[i][j], a, T::one());
            v.axpy(matrix[i][j], a, T::one());
        }
        State {
            t: start.t + h * nodes[i],
            q: start.q + q * h,
            v: start.v + v * h,
        }
    }

    /// Accelerations to begin the iteration with: those of the last step's
    /// stages, extrapolated.
    fn guess(&self, h: T) -> StageVectors<T, N, S> {
        let (before, length) = &self.before;
        if *length <= T::zero() {
            return [self.first; S];
        }
        let nodes = &self.coefficients.nodes;
        core::array::from_fn(|i| {
            let x = T::one() + nodes[i] * h / *length;
            let mut guess = SVector::<T, N>::zeros();
            for (j, a) in before.iter().enumerate() {
                guess.axpy(cardinal(nodes, j, x), a, T::one());
            }
            guess
        })
    }

    /// Makes derivatives and factors fit the step length `h`.
    fn prepare<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        h: T,
    ) -> Result<(), IntegrateError<T>> {
        let start = self.step.start;
        if self.jacobian.is_none() {
            let (jacobian, evaluations) = acceleration_jacobian(system, &start, &self.first)?;
            self.step.evaluations += evaluations;
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
    fn solve<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        h: T,
    ) -> Result<(), IntegrateError<T>> {
        self.prepare(system, h)?;
        let failure = IntegrateError::NewtonDiverged {
            t: self.step.start.t,
            h,
        };
        // The rate of the last step until this one has shown its own.
        let expected = self
            .rate
            .max(T::from_f64(BEST_RATE))
            .min(T::from_f64(UNKNOWN_RATE));
        self.rate = T::zero();
        let mut a = self.guess(h);
        let mut before: Option<T> = None;
        for _ in 0..MOST_ITERATIONS {
            let size = self.iterate(system, h, &mut a)?;
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
    fn iterate<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        h: T,
        a: &mut StageVectors<T, N, S>,
    ) -> Result<T, IntegrateError<T>> {
        let mut rest = *a;
        for (i, rest) in rest.iter_mut().enumerate() {
            let state = self.stage(a, h, i);
            *rest = self.evaluate(system, &state)? - *rest;
        }
        let start = self.step.start;
        let failure = IntegrateError::NewtonDiverged { t: start.t, h };
        let factors = self.factors.as_ref().ok_or(failure)?;
        let change = factors.solve(&rest, &self.coefficients);
        let before: [_; S] = core::array::from_fn(|i| self.stage(a, h, i));
        for (a, change) in a.iter_mut().zip(&change) {
            *a += change;
        }
        let mut sum = T::zero();
        for (i, before) in before.iter().enumerate() {
            let after = self.stage(a, h, i);
            let (dq, dv) = (after.q - before.q, after.v - before.v);
            let size = self.tolerance.norm((&dq, &dv), &start, &after);
            sum += size * size;
        }
        Ok((sum / T::from_f64(S as f64)).sqrt())
    }

    /// The error estimate of a step (IV.8.19), with the derivatives at the start, or
    /// near it for a second look (IV.8.20): the derivatives are compared with those that
    /// the stages lead back to.
    fn estimate(
        &self,
        h: T,
        (v, a): (&SVector<T, N>, &SVector<T, N>),
    ) -> (SVector<T, N>, SVector<T, N>) {
        let (Some(factors), Some(jacobian)) = (&self.factors, &self.jacobian) else {
            return (SVector::zeros(), SVector::zeros());
        };
        let factor = self.coefficients.real.value * h;
        let (mut dq, mut dv) = (v * factor, a * factor);
        for (i, weight) in self.coefficients.start.iter().enumerate() {
            let weight = *weight * factor;
            dq -= self.stage(&self.a, h, i).v * weight;
            dv -= self.a[i] * weight;
        }
        // Filtered, so that it stays small where stiff parts have died out.
        let right = dv + jacobian.q * dq * factor;
        let dv = SVector::from(factors.real.solve(&right.data.0[0]));
        (dq + dv * factor, dv)
    }
}

impl<T: Real, const N: usize, const S: usize> Trial<T, N> for Radau<T, N, S> {
    fn tableau(&self) -> &'static Tableau {
        self.tableau
    }

    fn step(&mut self) -> &mut Step<T, N> {
        &mut self.step
    }

    fn keep(&mut self, inside: Inside) {
        self.inside = inside;
    }

    fn forget(&mut self) {
        self.jacobian = None;
        self.before.1 = T::zero();
    }

    fn begin<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        self.step.rejected = 0;
        self.step.evaluations = 0;
        if self.step.end != *state {
            self.forget();
        }
        self.step.start = *state;
        self.first = self.evaluate(system, state)?;
        Ok(self.first)
    }

    fn attempt<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        end: T,
    ) -> Result<(), IntegrateError<T>> {
        let start = self.step.start;
        let h = end - start.t;
        let fresh = self.jacobian.is_none();
        let mut result = self.solve(system, h);
        if result.is_err() && !fresh {
            self.jacobian = None;
            result = self.solve(system, h);
        }
        result?;
        let mut last = self.stage(&self.a, h, S - 1);
        last.t = end;
        self.step.end = last;
        self.estimate = self.estimate(h, (&start.v, &self.first));
        let first = self.before.1 <= T::zero();
        if (first || self.step.rejected > 0) && self.error(&self.tolerance) >= T::one() {
            // Stiff parts that are not in balance yet look like errors.
            let (q, v) = self.estimate;
            let near = State {
                t: start.t,
                q: start.q + q,
                v: start.v + v,
            };
            let a = self.evaluate(system, &near)?;
            self.estimate = self.estimate(h, (&near.v, &a));
        }
        system.project(&mut last)?;
        self.step.end = last;
        Ok(())
    }

    fn error(&self, tolerance: &Tolerance<T, N>) -> T {
        let (q, v) = &self.estimate;
        tolerance.norm((q, v), &self.step.start, &self.step.end)
    }

    fn kept(&self) -> Inside {
        self.inside
    }

    fn accept<Y: System<T, N> + ?Sized>(
        &mut self,
        _: &mut Y,
        inside: Inside,
    ) -> Result<(), DynamicsError<T>> {
        let h = self.step.length();
        if inside != Inside::Nothing {
            let states: [_; S] = core::array::from_fn(|i| self.stage(&self.a, h, i));
            let inner = S - 1;
            self.step
                .set_stages(&self.coefficients.nodes[..inner], &states[..inner]);
        }
        self.before = (self.a, h);
        if self.rate > T::from_f64(GOOD_RATE) {
            self.jacobian = None;
        }
        Ok(())
    }
}
