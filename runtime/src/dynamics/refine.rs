//! Starts beside singular configurations, to all digits.
//!
//! In:  a state on the constraints to round-off, which of its values are held.
//! Out: the state on its sheet that has these values.
//!
//! Where the weakest row is independent of the others by a sine `s`, a position on the
//! constraints to round-off `ε` may be off its sheet by `ε/s`, and velocities that satisfy the
//! constraints there by `ε/s²`. The sheet itself is known to all digits, between regular
//! states on both sides.

use super::{Core, Solver};
use crate::singular::{Point, solving_along};
use crate::tolerance::{regular, round_off};
use crate::{Mechanism, Real, Settings, State};
use nalgebra::SVector;

/// Corrections that bring held values about, each to many more digits than the one before.
const ROUNDS: usize = 4;
/// What a value that is free weighs beside one that is held.
const FREE: f64 = 1e-6;
/// What held values may be missed by, in units of round-off.
const MISSED: f64 = 64.0;

/// Which coordinates and velocities are held.
#[derive(Clone, Copy)]
pub(crate) struct Held<const N: usize> {
    pub(crate) q: [bool; N],
    pub(crate) v: [bool; N],
}

/// Puts a state beside a singular configuration onto its sheet, if it is near one and the
/// sheet has the values that are held; else it stays what it is. Returns whether it was put
/// there. The sheet is told by the position, and by the velocity if that is on one.
#[inline(never)]
pub(crate) fn refine_start<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    state: &mut State<T, N>,
    held: &Held<N>,
    velocity_tells: bool,
) -> bool {
    let mut solver = Solver::<T, N, R>::new(Settings::default());
    solver.bind(mechanism.structure());
    solver.expect_error(Some(T::EPSILON));
    let mut told = *state;
    if !velocity_tells {
        told.v = SVector::zeros();
    }
    let refined = solver.core().refined(mechanism, (&told, state), held);
    refined.inspect(|refined| *state = *refined).is_some()
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// The state of the sheet that one state tells, with the values of another that are held;
    /// `None` where no sheets cross nearby, or it has none.
    fn refined(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        (told, state): (&State<T, N>, &State<T, N>),
        held: &Held<N>,
    ) -> Option<State<T, N>> {
        self.session.begin(told);
        self.session.chart = Some(self.start_at(mechanism, told).ok()??);
        let mut point = Point::zeros();
        let mut guess = *state;
        for _ in 0..ROUNDS {
            let placement = self.place(mechanism, &guess, &mut point).ok()?;
            if !placement.is_crossing() {
                return None;
            }
            mechanism.terms(&point.state, &mut self.terms);
            let missed = chosen(&held.q, &(state.q - point.state.q));
            let change = self.change_along(&point, &held.q, &missed, None)?;
            guess.q = point.state.q + change;
        }
        // The last change is so small that it needs no sheet but its tangent space.
        let mut refined = State::new(state.t, guess.q, point.drift);
        let mut free = Some(state.v - point.drift);
        for _ in 0..ROUNDS {
            let missed = chosen(&held.v, &(state.v - refined.v));
            refined.v += self.change_along(&point, &held.v, &missed, free.take())?;
        }
        self.settled(state, refined, held)
    }

    /// A change along the sheet that makes held values change so, and the others as little as
    /// they can, or like a given change.
    fn change_along(
        &mut self,
        point: &Point<T, N>,
        held: &[bool; N],
        missed: &SVector<T, N>,
        free: Option<SVector<T, N>>,
    ) -> Option<SVector<T, N>> {
        let mut weights = self.terms.mass * T::from_f64(FREE);
        let mut change = free.map_or(SVector::zeros(), |free| weights * free);
        for j in (0..N).filter(|j| held[*j]) {
            let inertia = self.terms.mass[(j, j)];
            weights[(j, j)] += inertia;
            change[j] += inertia * missed[j];
        }
        let chart = self.session.chart.as_ref()?.view();
        let solved = solving_along()(
            &chart,
            weights.as_slice(),
            point.tangent.as_slice(),
            change.as_mut_slice(),
            &self.memory.workspace(),
        );
        solved.then_some(change)
    }

    /// A refined state with what is held to the last bit, if it was reached and is the state
    /// that was refined.
    fn settled(
        &self,
        state: &State<T, N>,
        refined: State<T, N>,
        held: &Held<N>,
    ) -> Option<State<T, N>> {
        let length = |x: &SVector<T, N>| self.metric.factor.length(&x.data.0[0]);
        let most = T::from_f64(MISSED) * round_off();
        let [q, v] = [state.q - refined.q, state.v - refined.v];
        // Comparisons with NaN are false, so that a state that is NaN counts as not reached.
        let reached = length(&chosen(&held.q, &q)) <= most * self.coordinate_scale.size
            && length(&chosen(&held.v, &v)) <= most * length(&state.v)
            && length(&q) <= regular::<T>() * self.coordinate_scale.size;
        let mut settled = refined;
        for j in 0..N {
            if held.q[j] {
                settled.q[j] = state.q[j];
            }
            if held.v[j] {
                settled.v[j] = state.v[j];
            }
        }
        reached.then_some(settled)
    }
}

/// A vector where it is held, zero elsewhere.
fn chosen<T: Real, const N: usize>(held: &[bool; N], x: &SVector<T, N>) -> SVector<T, N> {
    SVector::from_fn(|j, _| if held[j] { x[j] } else { T::zero() })
}
