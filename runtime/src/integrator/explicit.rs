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
/// Error of the third-order result of DOP853, relative to the state, above which a step is too long
/// for its estimates to tell the error of the method.
const TELLING: f64 = 0.02;

/// Slots for derivatives: twelve stages of DOP853, the derivative at the end, three extra
/// stages.
const SLOTS: usize = 16;

/// A method at work.
#[derive(Clone, Debug)]
pub(crate) struct Explicit<T, const N: usize> {
    tableau: &'static Tableau,
    stages: Stages<T, N, SLOTS>,
    /// Whether the slot after the stages holds the derivative at the step's end.
    end_known: bool,
}

impl<T: Real, const N: usize> Explicit<T, N> {
    pub(super) fn new(tableau: &'static Tableau) -> Self {
        Self {
            tableau,
            stages: Stages::new(),
            end_known: false,
        }
    }

    /// Computes the derivative at a state of a step into a slot.
    #[inline]
    fn evaluate<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        step: &mut Step<T, N>,
        slot: usize,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        step.evaluations += 1;
        let acceleration = system.acceleration(state)?;
        self.stages.set(slot, &state.v, &acceleration);
        Ok(())
    }

    /// The state at the fraction `node` of a step of length `h`.
    #[inline(always)]
    fn stage(&self, start: &State<T, N>, h: T, node: T, row: &[Term]) -> State<T, N> {
        let (q, v) = self.stages.combine(row);
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
        step: &mut Step<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if !self.end_known {
            let end = step.end;
            self.evaluate(system, step, self.tableau.stages(), &end)?;
            self.end_known = true;
        }
        Ok(())
    }

    /// The extra stages of the method's interpolant, and its coefficients.
    #[inline(never)]
    fn complete_dense<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        step: &mut Step<T, N>,
        h: T,
    ) -> Result<(), DynamicsError<T>> {
        let tableau = self.tableau;
        let rows = tableau.extra_nodes.iter().zip(tableau.extra_rows);
        for (slot, (&node, row)) in (tableau.stages() + 1..).zip(rows) {
            let state = self.stage(&step.start, h, Tableau::node(node), row);
            self.evaluate(system, step, slot, &state)?;
        }
        for row in tableau.dense {
            let (q, v) = self.stages.combine(row);
            step.interpolant.push(q * h, v * h);
        }
        Ok(())
    }
}

impl<T: Real, const N: usize, Y: System<T, N> + ?Sized> Trial<T, N, Y> for Explicit<T, N> {
    fn begin(
        &mut self,
        system: &mut Y,
        step: &mut Step<T, N>,
        goes_on: bool,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        if self.end_known && goes_on {
            self.stages.copy(self.tableau.stages(), 0);
        } else {
            let start = step.start;
            self.evaluate(system, step, 0, &start)?;
        }
        self.end_known = false;
        Ok(self.stages.acceleration(0))
    }

    fn attempt(
        &mut self,
        system: &mut Y,
        step: &mut Step<T, N>,
        end: T,
    ) -> Result<(), IntegrateError<T>> {
        let tableau = self.tableau;
        let stages = tableau.stages();
        let h = end - step.start.t;
        self.end_known = false;
        for i in 1..stages {
            let node = Tableau::node(tableau.nodes[i]);
            let state = self.stage(&step.start, h, node, tableau.rows[i]);
            step.evaluations += 1;
            let acceleration = system.acceleration(&state)?;
            self.stages.set(i, &state.v, &acceleration);
        }
        let mut last = self.stage(&step.start, h, T::one(), tableau.weights);
        last.t = end;
        system.project(&mut last)?;
        step.end = last;
        let wanted = |row: &&[Term]| row.iter().any(|term| term.0 == stages);
        if tableau.errors.iter().any(wanted) {
            self.know_end(system, step)?;
        }
        Ok(())
    }

    fn error(&self, step: &Step<T, N>, tolerance: &Tolerance<T, N>) -> T {
        let Step { start, end, .. } = step;
        let h = (end.t - start.t).abs();
        let norm = |row: &[Term]| {
            let (q, v) = self.stages.combine(row);
            tolerance.norm((&q, &v), start, end)
        };
        match self.tableau.errors {
            [fine, coarse] => eighth_order(h * norm(fine), h * norm(coarse), tolerance.relative()),
            rows => rows
                .iter()
                .fold(T::zero(), |most, row| most.max(h * norm(row))),
        }
    }

    fn accept(
        &mut self,
        system: &mut Y,
        step: &mut Step<T, N>,
        inside: Inside,
    ) -> Result<(), DynamicsError<T>> {
        if inside == Inside::Nothing {
            step.span = T::zero();
            return Ok(());
        }
        self.know_end(system, step)?;
        let first = self.stages.acceleration(0);
        let last = self.stages.acceleration(self.tableau.stages());
        let h = step.set_ends(&first, &last);
        if inside == Inside::Hermite || self.tableau.dense.is_empty() {
            step.interpolant.complete_hermite(h, &first, &last);
            return Ok(());
        }
        self.complete_dense(system, step, h)
    }
}

/// The error of the method of order 8 from its estimates of orders 5 and 3, in units of the
/// tolerance.
///
/// The error is extrapolated: it is as much smaller than the fifth-order estimate as that is
/// smaller than the third-order one, which holds while each is a small correction of the one
/// before. On longer steps the fifth-order estimate may pass zero by chance while the error is
/// large: such steps are judged by the third-order estimate, whose square grows with the step as
/// the error does.
fn eighth_order<T: Real>(fine: T, coarse: T, tolerance: T) -> T {
    let square = fine * fine + T::from_f64(THIRD_ORDER_WEIGHT) * coarse * coarse;
    if square == T::zero() {
        return square;
    }
    let error = fine * fine / square.sqrt();
    let beyond = coarse * tolerance / T::from_f64(TELLING);
    match beyond > T::one() {
        true => error.max(beyond * beyond),
        false => error,
    }
}
