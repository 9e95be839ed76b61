//! The stages of an explicit Runge–Kutta method on `(q, q̇)`.
//!
//! In:  a [`Tableau`], a [`System`], the state at the start of the step.
//! Out: the projected state at its end, error estimates, the interpolant.
//!
//! Order of work, and why. The end of the step is projected *before* the derivative
//! there is evaluated. The derivative is then the right one to begin the next step
//! with (the derivative at the unprojected end would not be), to estimate the error
//! with (the projection moves the end by no more than the error of the step, so
//! the estimate changes by one order of `h` less than itself), and to join the
//! interpolants of consecutive steps without a kink.
//!
//! Not here: how long a step is ([`super::methods`]).

use super::IntegrateError;
use super::control::Tolerance;
use super::stages::Stages;
use super::step::Step;
use super::step_control::{Inside, Trial};
use super::tableau::{Tableau, Term};
use crate::{DynamicsError, Real, State, System};
use nalgebra::SVector;

/// Weight of the third-order estimate in the error of DOP853, which damps the
/// fifth-order one where that is accidentally small.
const THIRD_ORDER_WEIGHT: f64 = 0.01;

/// A method at work, with `S` slots for derivatives.
#[derive(Clone, Debug)]
pub(super) struct Explicit<T, const N: usize, const S: usize> {
    tableau: &'static Tableau,
    inside: Inside,
    step: Step<T, N>,
    stages: Stages<T, N, S>,
    /// Whether the slot after the stages holds the derivative at the step's end.
    end_known: bool,
}

impl<T: Real, const N: usize, const S: usize> Explicit<T, N, S> {
    pub(super) fn new(tableau: &'static Tableau) -> Self {
        Self {
            tableau,
            inside: Inside::Full,
            step: Step::new(),
            stages: Stages::new(),
            end_known: false,
        }
    }

    /// Computes the derivative at a state into a slot.
    #[inline]
    fn evaluate<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        slot: usize,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        self.step.evaluations += 1;
        let acceleration = system.acceleration(state)?;
        self.stages.set(slot, &state.v, &acceleration);
        Ok(())
    }

    /// The state at the fraction `node` of a step of length `h`.
    #[inline(always)]
    fn stage(&self, h: T, node: T, row: &[Term]) -> State<T, N> {
        let (q, v) = self.stages.combine(row);
        let start = &self.step.start;
        State {
            t: start.t + h * node,
            q: start.q + q * h,
            v: start.v + v * h,
        }
    }

    /// Evaluates the derivative at the end of the step unless it is known.
    fn know_end<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
    ) -> Result<(), DynamicsError<T>> {
        if !self.end_known {
            let end = self.step.end;
            self.evaluate(system, self.tableau.stages(), &end)?;
            self.end_known = true;
        }
        Ok(())
    }

    /// The extra stages of the method's interpolant, and its coefficients.
    fn complete_dense<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        h: T,
    ) -> Result<(), DynamicsError<T>> {
        let tableau = self.tableau;
        let rows = tableau.extra_nodes.iter().zip(tableau.extra_rows);
        for (slot, (&node, row)) in (tableau.stages() + 1..).zip(rows) {
            let state = self.stage(h, Tableau::node(node), row);
            self.evaluate(system, slot, &state)?;
        }
        for row in tableau.dense {
            let (q, v) = self.stages.combine(row);
            self.step.interpolant.push(q * h, v * h);
        }
        Ok(())
    }
}

impl<T: Real, const N: usize, const S: usize> Trial<T, N> for Explicit<T, N, S> {
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
        self.end_known = false;
    }

    fn begin<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        self.step.rejected = 0;
        self.step.evaluations = 0;
        if self.end_known && self.step.end == *state {
            self.stages.copy(self.tableau.stages(), 0);
        } else {
            self.evaluate(system, 0, state)?;
        }
        self.end_known = false;
        self.step.start = *state;
        Ok(self.stages.acceleration(0))
    }

    fn attempt<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        end: T,
    ) -> Result<(), IntegrateError<T>> {
        let tableau = self.tableau;
        let stages = tableau.stages();
        let h = end - self.step.start.t;
        self.end_known = false;
        for i in 1..stages {
            let state = self.stage(h, Tableau::node(tableau.nodes[i]), tableau.rows[i]);
            self.evaluate(system, i, &state)?;
        }
        let mut last = self.stage(h, T::one(), tableau.weights);
        last.t = end;
        system.project(&mut last)?;
        self.step.end = last;
        let wanted = |row: &&[Term]| row.iter().any(|term| term.0 == stages);
        if tableau.errors.iter().any(wanted) {
            self.know_end(system)?;
        }
        Ok(())
    }

    fn error(&self, tolerance: &Tolerance<T, N>) -> T {
        let Step { start, end, .. } = &self.step;
        let h = (end.t - start.t).abs();
        let norm = |row: &[Term]| {
            let (q, v) = self.stages.combine(row);
            tolerance.norm((&q, &v), start, end)
        };
        match self.tableau.errors {
            [fine, coarse] => {
                let (fine, coarse) = (norm(fine), norm(coarse));
                let square = fine * fine + T::from_f64(THIRD_ORDER_WEIGHT) * coarse * coarse;
                if square == T::zero() {
                    square
                } else {
                    h * fine * fine / square.sqrt()
                }
            }
            rows => rows
                .iter()
                .fold(T::zero(), |most, row| most.max(h * norm(row))),
        }
    }

    fn kept(&self) -> Inside {
        self.inside
    }

    fn accept<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        inside: Inside,
    ) -> Result<(), DynamicsError<T>> {
        if inside == Inside::Nothing {
            self.step.span = T::zero();
            return Ok(());
        }
        self.know_end(system)?;
        let last = self.tableau.stages();
        let (first, last) = [0, last].map(|slot| self.stages.acceleration(slot)).into();
        let h = self.step.set_ends(&first, &last);
        if inside == Inside::Hermite || self.tableau.dense.is_empty() {
            self.step.interpolant.complete_hermite(h, &first, &last);
            return Ok(());
        }
        self.complete_dense(system, h)
    }
}
