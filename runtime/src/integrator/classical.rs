//! The classical Runge–Kutta method, written out.
//!
//! In:  a [`System`], the state at the start of the step.
//! Out: the projected state at its end.
//!
//! A step of it is so short that walking through the table of a method would cost as
//! much as the accelerations of a small mechanism.
//!
//! Source: Kutta, Zeitschrift für Mathematik und Physik 46 (1901) 435–453.
//!
//! Not here: methods that estimate their error ([`super::explicit`]).

use super::control::check_bound;
use super::step::Step;
use super::step_control::{Inside, in_parts};
use super::{IntegrateError, Integrator};
use crate::linalg::add_scaled;
use crate::stack::with_room;
use crate::system::escalating;
use crate::{DynamicsError, Real, State, Switching, System};
use nalgebra::SVector;

/// Abscissae of the stages.
pub(super) const ABSCISSAE: [f64; 4] = [0.0, 0.5, 0.5, 1.0];

/// Accelerations of a step, but for that at its start.
const STAGES: u32 = 3;

/// The classical Runge–Kutta method of order 4: four accelerations a step.
///
/// Between the ends, the quintic Hermite polynomial for `q` and the cubic one
/// for `q̇`.
#[derive(Clone, Debug)]
pub struct Rk4<T, const N: usize> {
    inside: Inside,
    step: Step<T, N>,
    /// The acceleration at the step's end, where it is known.
    last: Option<SVector<T, N>>,
}

impl<T: Real, const N: usize> Rk4<T, N> {
    /// The method: each step goes to its bound at once.
    pub fn new() -> Self {
        Self {
            inside: Inside::Full,
            step: Step::new(),
            last: None,
        }
    }

    /// Forgets the acceleration at the last step's end, because the system has changed
    /// since.
    pub fn forget(&mut self) {
        self.last = None;
    }

    pub(crate) fn keep(&mut self, inside: Inside) {
        self.inside = inside;
    }

    /// Goes towards a time; whether the equations change along the way.
    #[inline(always)]
    fn go<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
        known: Option<SVector<T, N>>,
        bound: T,
    ) -> Result<bool, IntegrateError<T>> {
        let (switches, first, end) = in_parts(state.t, bound, |end| {
            escalating(system, |system| attempt(system, state, known, end))
        })?;
        (self.step.start, self.step.end) = (*state, end);
        self.step.span = T::zero();
        if switches || self.inside != Inside::Nothing {
            self.complete(system, &first)?;
        }
        Ok(switches)
    }

    /// The time up to which the step is to be made again, because the equations change within it;
    /// none where it stands.
    #[cold]
    #[inline(never)]
    fn switch<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
    ) -> Result<Option<T>, DynamicsError<T>> {
        let again = match system.switch(&mut self.step)? {
            Switching::Nowhere => return Ok(None),
            Switching::AtEnd => {
                self.forget();
                return Ok(None);
            }
            Switching::Within(t) => t,
            Switching::AtStart => self.step.end.t,
        };
        self.step.rejected += 1;
        self.step.evaluations += STAGES + 1;
        Ok(Some(again))
    }

    /// Sets the polynomials between the ends, if anyone wants them.
    fn complete<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        first: &SVector<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        // The end may lie beside a singular configuration, and want a closer look, too.
        let end = self.step.end;
        let last = escalating(system, |system| system.acceleration(&end))?;
        self.step.evaluations += 1;
        let h = self.step.set_ends(first, &last);
        self.step.interpolant.complete_hermite(h, first, &last);
        self.last = Some(last);
        Ok(())
    }
}

impl<T: Real, const N: usize> Default for Rk4<T, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real, const N: usize> Integrator<T, N> for Rk4<T, N> {
    #[inline]
    fn step<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
        bound: T,
    ) -> Result<&Step<T, N>, IntegrateError<T>> {
        with_room::<T, _, N, N>(|| self.step_towards(system, state, bound))?;
        Ok(&self.step)
    }
}

impl<T: Real, const N: usize> Rk4<T, N> {
    /// Makes one step.
    #[inline(always)]
    fn step_towards<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
        bound: T,
    ) -> Result<(), IntegrateError<T>> {
        check_bound(state.t, bound)?;
        let mut known = self.last.take().filter(|_| self.step.end == *state);
        self.step.evaluations = STAGES + u32::from(known.is_none());
        self.step.rejected = 0;
        let mut bound = bound;
        while self.go(system, state, known, bound)? {
            match self.switch(system)? {
                Some(again) => (bound, known) = (again, None),
                None => break,
            }
        }
        system.commit(&self.step)?;
        Ok(())
    }
}

/// The acceleration at the start of a step, and its end, projected and verified.
#[inline(always)]
fn attempt<T: Real, Y: System<T, N> + ?Sized, const N: usize>(
    system: &mut Y,
    state: &State<T, N>,
    known: Option<SVector<T, N>>,
    bound: T,
) -> Result<(bool, SVector<T, N>, State<T, N>), DynamicsError<T>> {
    let switches = system.begin(state);
    let first = match known {
        Some(acceleration) => acceleration,
        None => system.acceleration(state)?,
    };
    let mut end = classical(system, state, &first, bound)?;
    system.project(&mut end)?;
    system.verify(state, &end)?;
    Ok((switches, first, end))
}

/// The state at the end of a step, not yet projected.
#[inline(always)]
fn classical<T: Real, Y: System<T, N> + ?Sized, const N: usize>(
    system: &mut Y,
    start: &State<T, N>,
    first: &SVector<T, N>,
    end: T,
) -> Result<State<T, N>, DynamicsError<T>> {
    let h = end - start.t;
    let half = h * T::from_f64(ABSCISSAE[1]);
    let second = ahead(start, start.t + half, half, &start.v, first);
    let a2 = system.acceleration(&second)?;
    let third = ahead(start, start.t + half, half, &second.v, &a2);
    let a3 = system.acceleration(&third)?;
    let fourth = ahead(start, end, h, &third.v, &a3);
    let a4 = system.acceleration(&fourth)?;
    let v = mean(&start.v, &second.v, &third.v, &fourth.v);
    let a = mean(first, &a2, &a3, &a4);
    Ok(ahead(start, end, h / T::from_f64(6.0), &v, &a))
}

/// `y + h·y'` at a time.
#[inline(always)]
fn ahead<T: Real, const N: usize>(
    start: &State<T, N>,
    t: T,
    h: T,
    v: &SVector<T, N>,
    a: &SVector<T, N>,
) -> State<T, N> {
    let mut state = State { t, ..*start };
    add_scaled(&mut state.q.data.0[0], h, &v.data.0[0]);
    add_scaled(&mut state.v.data.0[0], h, &a.data.0[0]);
    state
}

/// Six times the mean derivative of the stages.
#[inline(always)]
fn mean<T: Real, const N: usize>(
    first: &SVector<T, N>,
    second: &SVector<T, N>,
    third: &SVector<T, N>,
    fourth: &SVector<T, N>,
) -> SVector<T, N> {
    let mut sum = first + fourth;
    let middle = second + third;
    add_scaled(&mut sum.data.0[0], T::from_f64(2.0), &middle.data.0[0]);
    sum
}
