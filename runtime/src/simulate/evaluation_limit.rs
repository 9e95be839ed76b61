//! A mechanism whose equations are evaluated a limited number of times.
//!
//! In:  a mechanism, how many evaluations are granted.
//! Out: the same mechanism, and how often it was asked.
//!
//! Evaluations beyond the limit are spoilt: every entry that isn't zero becomes NaN, which
//! ends every iteration within a step.

use crate::assembly::StartFault;
use crate::zeroed::spoil;
use crate::{
    Acceleration, Condition, Correction, Energy, Linearised, Mechanism, Pivots, Position, Real,
    Start, State, Structure, Switches, Terms,
};
use core::cell::Cell;
use nalgebra::SVector;

/// Counts the evaluations of a mechanism's equations and spoils those beyond a limit.
pub(super) struct LimitedEvaluations<'a, M: ?Sized> {
    mechanism: &'a M,
    most: u32,
    asked: Cell<u32>,
}

impl<'a, M: ?Sized> LimitedEvaluations<'a, M> {
    /// None asked for yet.
    pub(super) fn new(mechanism: &'a M, most: u32) -> Self {
        Self {
            mechanism,
            most,
            asked: Cell::new(0),
        }
    }

    /// How many evaluations were asked for, those that were refused included.
    pub(super) fn asked(&self) -> u32 {
        self.asked.get()
    }

    /// Whether some were refused.
    pub(super) fn is_exceeded(&self) -> bool {
        self.asked.get() > self.most
    }

    /// Takes note of an evaluation; whether it is one too many.
    #[inline]
    fn count(&self) -> bool {
        self.asked.set(self.asked.get().saturating_add(1));
        self.is_exceeded()
    }
}

/// Spoils what was divided by.
#[cold]
fn spoil_pivots<T: Real, const N: usize, const R: usize>(pivots: &mut Pivots<T, N, R>) {
    spoil(&mut pivots.mass_pivots);
    spoil(&mut pivots.row_pivots);
}

impl<M, T: Real, const N: usize, const R: usize> Mechanism<T, N, R> for LimitedEvaluations<'_, M>
where
    M: Mechanism<T, N, R> + ?Sized,
{
    fn structure(&self) -> &'static Structure {
        self.mechanism.structure()
    }

    fn terms(&self, state: &State<T, N>, out: &mut Terms<T, N, R>) {
        self.mechanism.terms(state, out);
        if self.count() {
            out.spoil();
        }
    }

    fn acceleration(&self, state: &State<T, N>, out: &mut Acceleration<T, N, R>) -> bool {
        let provided = self.mechanism.acceleration(state, out);
        if self.count() {
            spoil(&mut out.acceleration);
            spoil_pivots(&mut out.pivots);
        }
        provided
    }

    fn position(&self, state: &State<T, N>, out: &mut Position<T, N, R>) {
        self.mechanism.position(state, out);
        if self.count() {
            out.spoil();
        }
    }

    fn correction(&self, state: &State<T, N>, out: &mut Correction<T, N, R>) -> bool {
        let provided = self.mechanism.correction(state, out);
        if self.count() {
            spoil(&mut out.residual);
            spoil_pivots(&mut out.pivots);
        }
        provided
    }

    fn begin(&self, start: &mut Start<T, N>, t: T) -> Result<(), StartFault<T, N>> {
        self.mechanism.begin(start, t)
    }

    fn switches(
        &self,
        state: &State<T, N>,
        acceleration: &SVector<T, N>,
        out: &mut Switches<'_, T>,
    ) -> &'static [Condition] {
        let conditions = self.mechanism.switches(state, acceleration, out);
        // No room asks for the conditions alone.
        if !out.values.is_empty() && self.count() {
            spoil(out.values.iter_mut().map(|switch| &mut switch.value));
        }
        conditions
    }

    fn energy(&self, state: &State<T, N>) -> Energy<T> {
        self.mechanism.energy(state)
    }

    fn linearised(
        &self,
        state: &State<T, N>,
        acceleration: &SVector<T, N>,
        multiplier: &SVector<T, R>,
        out: &mut Linearised<T, N, R>,
    ) -> bool {
        let mechanism = self.mechanism;
        let provided = mechanism.linearised(state, acceleration, multiplier, out);
        if self.count() {
            out.spoil();
        }
        provided
    }
}
