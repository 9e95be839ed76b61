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
use super::collocation::{Digits, MOST_PAIRS, MOST_STAGES, collocation};
use super::control::Tolerance;
use super::factors::FactorRoom;
use super::jacobian::Flow;
use super::newton::{Course, Newton, VECTORS, attempting};
use super::rule::setting_states;
use super::step::Step;
use super::step_control::{Inside, Trial};
use crate::equations::{At, sized};
use crate::linalg::Workspace;
use crate::{DynamicsError, Real, State, System};
use nalgebra::{Complex, SVector};

/// Newton's iteration ends when what is left is this part of the tolerance.
const NEWTON_PART: f64 = 0.01;
/// Where the iteration no longer improves, the accelerations have no more digits
/// to give (near singular positions, for instance); the step is made all the same
/// if what is left is this part of the tolerance, or the square root of round-off
/// with fixed steps.
const TOLERABLE_PART: f64 = 0.2;
/// Tolerance of Newton's iteration with fixed steps, in units of round-off.
const FIXED_PACE: f64 = 1e3;

/// A vector for each stage, with room for those of the largest method.
type StageVectors<T, const N: usize> = [[T; N]; MOST_STAGES];

/// The method at work.
#[derive(Clone, Debug)]
pub(crate) struct Radau<T, const N: usize> {
    course: Course<T>,
    tolerance: Tolerance<T, N>,
    /// `∂q̈/∂q` and `∂q̈/∂q̇`, as columns.
    derivatives: [[[T; N]; N]; 2],
    factors: FactorRoom<T, N>,
    /// Acceleration at the start of the step.
    first: SVector<T, N>,
    /// Accelerations of the stages of the trial step.
    a: StageVectors<T, N>,
    /// Accelerations of the stages of the last accepted step.
    before: StageVectors<T, N>,
    /// Error estimate of the trial step.
    estimate: (SVector<T, N>, SVector<T, N>),
}

/// A system, and how many accelerations were computed.
struct Counted<'a, Y: ?Sized, const N: usize> {
    system: &'a mut Y,
    evaluations: &'a mut u32,
}

impl<T: Real, Y: System<T, N> + ?Sized, const N: usize> Flow<T> for Counted<'_, Y, N> {
    fn accelerate(&mut self, at: At<'_, T>, out: &mut [T]) -> Result<(), DynamicsError<T>> {
        *self.evaluations += 1;
        let acceleration = self.system.acceleration(&sized(at))?;
        out.copy_from_slice(acceleration.as_slice());
        Ok(())
    }

    fn derivatives(&mut self, at: At<'_, T>, by_q: &mut [T], by_v: &mut [T]) -> bool {
        let Some(jacobian) = self.system.acceleration_jacobian(&sized(at)) else {
            return false;
        };
        by_q.copy_from_slice(jacobian.q.as_slice());
        by_v.copy_from_slice(jacobian.v.as_slice());
        true
    }

    fn extents(&self, extents: &mut [T]) {
        extents.copy_from_slice(self.system.extents().as_slice());
    }
}

impl<T: Real, const N: usize> Radau<T, N> {
    /// The method; `tolerance` tells Newton's iteration when to end, which with
    /// fixed steps is near round-off.
    #[inline(never)]
    pub(super) fn new(digits: &Digits, tolerance: Option<Tolerance<T, N>>) -> Self {
        let (tolerance, tolerable) = match tolerance {
            Some(tolerance) => (tolerance, T::from_f64(TOLERABLE_PART)),
            None => {
                let unit = T::EPSILON * T::from_f64(FIXED_PACE);
                (Tolerance::round_off(FIXED_PACE), T::EPSILON.sqrt() / unit)
            }
        };
        let coefficients = collocation()(digits);
        Self {
            course: Course::new(coefficients, tolerance.part(NEWTON_PART), tolerable),
            tolerance,
            derivatives: [[[T::zero(); N]; N]; 2],
            factors: FactorRoom::new(),
            first: SVector::zeros(),
            a: [[T::zero(); N]; MOST_STAGES],
            before: [[T::zero(); N]; MOST_STAGES],
            estimate: (SVector::zeros(), SVector::zeros()),
        }
    }

    /// Makes a trial step to the time `end`, without the projection there.
    #[inline(never)]
    fn advance(
        &mut self,
        flow: &mut dyn Flow<T>,
        start: &State<T, N>,
        (end, again): (T, bool),
    ) -> Result<State<T, N>, IntegrateError<T>> {
        let mut last = State { t: end, ..*start };
        let [by_q, by_v] = &mut self.derivatives;
        let mut across = [[Complex::new(T::zero(), T::zero()); N]; 2 * MOST_PAIRS];
        let mut newton = Newton {
            course: &mut self.course,
            scale: self.tolerance.scale(),
            derivatives: (by_q.as_flattened_mut(), by_v.as_flattened_mut()),
            factors: self.factors.factors(across.as_flattened_mut()),
            first: self.first.as_slice(),
            a: self.a.as_flattened_mut(),
            before: self.before.as_flattened(),
            end: (last.q.as_mut_slice(), last.v.as_mut_slice()),
            estimate: (
                self.estimate.0.as_mut_slice(),
                self.estimate.1.as_mut_slice(),
            ),
        };
        let mut vectors = [[T::zero(); N]; VECTORS];
        let workspace = Workspace::new(vectors.as_flattened_mut(), &mut [], &mut []);
        attempting()(&mut newton, flow, start.at(), (end, again), &workspace)?;
        Ok(last)
    }

    /// Keeps the polynomials through the stages of a step.
    #[inline(never)]
    fn keep_inside(&self, step: &mut Step<T, N>) {
        let coefficients = &self.course.coefficients;
        let mut q = [[T::zero(); N]; MOST_STAGES];
        let mut v = q;
        let (q, v) = (q.as_flattened_mut(), v.as_flattened_mut());
        let (start, a) = (step.start.at(), self.a.as_flattened());
        setting_states()(coefficients, start, a, step.length(), (q, v));
        step.set_stages(&coefficients.nodes[..coefficients.stages - 1], (q, v));
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
            self.course.forget();
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
        let mut flow = Counted {
            system,
            evaluations: &mut step.evaluations,
        };
        let again = step.rejected > 0;
        step.end = self.advance(&mut flow, &step.start, (end, again))?;
        let mut last = step.end;
        system.project(&mut last)?;
        step.end = last;
        Ok(())
    }

    fn error(&self, step: &Step<T, N>, tolerance: &Tolerance<T, N>) -> T {
        let (q, v) = &self.estimate;
        tolerance.norm((q, v), &step.start, &step.end)
    }

    fn accept(
        &mut self,
        _: &mut Y,
        step: &mut Step<T, N>,
        inside: Inside,
    ) -> Result<(), DynamicsError<T>> {
        if inside != Inside::Nothing {
            self.keep_inside(step);
        }
        self.before = self.a;
        self.course.accept(step.length());
        Ok(())
    }
}
