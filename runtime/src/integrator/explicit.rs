//! The stages of an explicit Runge–Kutta method on `(q, q̇)`.
//!
//! In:  a [`Tableau`], a [`System`], the state at the start of the step.
//! Out: the projected state at its end, error estimates, the interpolant.
//!
//! Order of work, and why. The end of the step is projected *before* the slope
//! there is evaluated. The slope is then the right one to begin the next step
//! with (a slope at the unprojected end would not be), to estimate the error
//! with (the projection moves the end by no more than the error of the step, so
//! the estimate changes by one order of `h` less than itself), and to join the
//! interpolants of consecutive steps without a kink.
//!
//! Not here: how long a step is ([`super::methods`]).

use super::step::Step;
use super::tableau::{Tableau, Term};
use crate::{DynamicsError, Real, State, System};
use nalgebra::SVector;

/// What is kept of the inside of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Inside {
    /// Nothing: [`Step::at`] is not called.
    Nothing,
    /// The Hermite polynomials through both ends, which cost nothing.
    Hermite,
    /// The method's own interpolant, extra stages included.
    Full,
}

/// A method at work, with `S` slots for slopes.
#[derive(Clone, Debug)]
pub(crate) struct Explicit<T, const N: usize, const S: usize> {
    pub(crate) tableau: &'static Tableau,
    pub(crate) inside: Inside,
    pub(crate) step: Step<T, N>,
    /// Velocities of the stages, the slopes of `q`.
    v: [SVector<T, N>; S],
    /// Accelerations of the stages, the slopes of `q̇`.
    a: [SVector<T, N>; S],
    /// Whether the slot after the stages holds the slope at the step's end.
    end_known: bool,
}

impl<T: Real, const N: usize, const S: usize> Explicit<T, N, S> {
    pub(crate) fn new(tableau: &'static Tableau) -> Self {
        let zero = [SVector::zeros(); S];
        let step = Step::new(tableau.looks);
        Self {
            tableau,
            inside: Inside::Full,
            step,
            v: zero,
            a: zero,
            end_known: false,
        }
    }

    /// Forgets the slope at the end of the last step.
    pub(crate) fn forget(&mut self) {
        self.end_known = false;
    }

    /// Makes `state` the start of the next step and evaluates the slope there,
    /// unless the last step ended in this very state.
    pub(crate) fn begin<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        let stages = self.tableau.stages();
        self.step.rejected = 0;
        self.step.evaluations = 0;
        if self.end_known && self.step.end == *state {
            self.v[0] = self.v[stages];
            self.a[0] = self.a[stages];
        } else {
            self.evaluate(system, 0, state)?;
        }
        self.end_known = false;
        self.step.start = *state;
        Ok(())
    }

    /// The slope at the start of the step.
    pub(crate) fn first_slope(&self) -> (&SVector<T, N>, &SVector<T, N>) {
        (&self.v[0], &self.a[0])
    }

    /// Computes the slope at a state into a slot.
    pub(crate) fn evaluate<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        slot: usize,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        self.step.evaluations += 1;
        self.a[slot] = system.acceleration(state)?;
        self.v[slot] = state.v;
        Ok(())
    }

    /// The state at the fraction `node` of a step of length `h`.
    fn stage(&self, h: T, node: T, row: &[Term]) -> State<T, N> {
        let (q, v) = self.combine(row);
        let start = &self.step.start;
        State {
            t: start.t + h * node,
            q: start.q + q * h,
            v: start.v + v * h,
        }
    }

    /// A combination of the slopes of `(q, q̇)`.
    pub(crate) fn combine(&self, row: &[Term]) -> (SVector<T, N>, SVector<T, N>) {
        let (mut q, mut v) = (SVector::<T, N>::zeros(), SVector::<T, N>::zeros());
        for &(slot, high, low) in row {
            let weight = T::constant(high, low);
            q.axpy(weight, &self.v[slot], T::one());
            v.axpy(weight, &self.a[slot], T::one());
        }
        (q, v)
    }

    /// Makes a trial step to `end`: all stages, the projected state at the end,
    /// and the slope there if the error estimate wants it.
    pub(crate) fn attempt<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        end: T,
    ) -> Result<(), DynamicsError<T>> {
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

    /// Completes an accepted step: the slope at its end, and its inside.
    pub(crate) fn accept<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
    ) -> Result<(), DynamicsError<T>> {
        if self.inside == Inside::Nothing {
            return Ok(());
        }
        self.know_end(system)?;
        let stages = self.tableau.stages();
        let Step {
            start,
            end,
            interpolant,
            span,
            ..
        } = &mut self.step;
        interpolant.set_ends((&*start, &self.a[0]), (&*end, &self.a[stages]));
        let h = end.t - start.t;
        *span = h;
        if self.inside == Inside::Hermite || self.tableau.dense.is_empty() {
            interpolant.complete_hermite(h, &self.a[0], &self.a[stages]);
            return Ok(());
        }
        self.complete_dense(system, h)
    }

    /// Evaluates the slope at the end of the step unless it is known.
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
            let (q, v) = self.combine(row);
            self.step.interpolant.push(q * h, v * h);
        }
        Ok(())
    }
}
