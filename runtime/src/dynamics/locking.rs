//! Each step is made with the conditions of the forces held.
//!
//! In:  states, attempts at steps.
//! Out: accelerations with the conditions held, also where the motion slides along some.
//!
//! A mechanism without conditions asks for nothing of this.
//!
//! Not here: where conditions change ([`super::switching`]).

use super::Core;
use super::conditions::Decided;
use super::sliding::{ROOM, weighing};
use super::switching::{Motion, settling, switching};
use crate::crossing::noise;
use crate::{DynamicsError, Mechanism, Real, Sides, State, Step, Switch, Switches, Switching};
use nalgebra::SVector;

/// An attempt at a step, with who made it.
struct Attempt<'a, T, const N: usize, const R: usize> {
    core: &'a mut Core<T, N, R>,
    mechanism: &'a dyn Mechanism<T, N, R>,
    /// None for a motion that has not begun yet.
    step: Option<&'a Step<T, N>>,
    end: &'a State<T, N>,
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Hands the sides to everything that evaluates forces.
    pub(super) fn decide(&mut self, sides: Sides) {
        self.terms.sides = sides;
        self.acceleration.sides = sides;
    }

    /// Lets the state decide the conditions.
    pub(super) fn release(&mut self) {
        if !self.conditions.decided.list.is_empty() {
            self.decide(Sides::FREE);
        }
    }

    /// Holds the conditions as they are at the start of a step; whether there are any.
    #[inline(never)]
    pub(super) fn hold(&mut self, mechanism: &dyn Mechanism<T, N, R>, state: &State<T, N>) -> bool {
        if self.conditions.decided.list.is_empty() {
            return false;
        }
        if self.conditions.at.as_ref() != Some(state) {
            let mut values = [Switch::default(); Sides::ROOM];
            let count = self.conditions.decided.list.len().min(Sides::ROOM);
            let values = &mut values[..count];
            let mut out = Switches::of(Sides::FREE, values);
            mechanism.switches(state, &SVector::zeros(), &mut out);
            self.conditions.decided.begin(state.t, values);
            self.conditions.at = Some(*state);
        }
        self.decide(self.conditions.decided.sides);
        true
    }

    /// Holds the conditions as a motion does that begins at a state.
    #[inline(never)]
    pub(super) fn settle(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if !self.hold(mechanism, state) {
            return Ok(());
        }
        let core = &mut *self;
        settling()(&mut Attempt {
            core,
            mechanism,
            step: None,
            end: state,
        })?;
        self.decide(self.conditions.decided.sides);
        Ok(())
    }

    /// Where the first condition changes within a step that was made with those at its
    /// start.
    #[inline(never)]
    pub(super) fn switch(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        step: &mut Step<T, N>,
    ) -> Result<Switching<T>, DynamicsError<T>> {
        if self.conditions.decided.list.is_empty() {
            return Ok(Switching::Nowhere);
        }
        let core = &mut *self;
        let found = switching()(&mut Attempt {
            core,
            mechanism,
            step: Some(step),
            end: step.end(),
        })?;
        self.decide(self.conditions.decided.sides);
        if found == Switching::AtEnd {
            self.project_sliding(mechanism, &mut step.end)?;
        }
        if matches!(found, Switching::Nowhere | Switching::AtEnd) {
            self.conditions.at = Some(*step.end());
        }
        Ok(found)
    }

    /// The acceleration with the conditions held, also where the motion slides along some.
    #[inline(always)]
    pub(super) fn held_acceleration<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        match self.conditions.decided.sliding {
            0 => self.acceleration(mechanism, state),
            _ => self.sliding_acceleration(&mechanism, state),
        }
    }

    /// The acceleration of a motion that slides.
    #[inline(never)]
    pub(super) fn sliding_acceleration(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let slid = self.conditions.decided.slid(state.t)?;
        let mut vectors = [[T::zero(); N]; ROOM + 1];
        let room = vectors.as_flattened_mut();
        let mut accelerate = |sides, rates: &mut [_], out: &mut [_]| {
            self.acceleration_on(sides, mechanism, state, rates, out)
        };
        let weights = weighing()(&slid, N, room, &mut accelerate, |function| function.rate)?;
        let (acceleration, changes) = room.split_at_mut(N);
        slid.add(&weights, changes, acceleration);
        for (&index, weight) in slid.list().iter().zip(weights) {
            self.conditions.decided.weights[index] = weight;
        }
        self.decide(self.conditions.decided.sides);
        Ok(SVector::from(vectors[0]))
    }

    /// The acceleration with the conditions held on some sides, and the switching functions.
    fn acceleration_on(
        &mut self,
        sides: Sides,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        rates: &mut [Switch<T>],
        out: &mut [T],
    ) -> Result<(), DynamicsError<T>> {
        self.decide(sides);
        let acceleration = self.acceleration(mechanism, state)?;
        mechanism.switches(state, &acceleration, &mut Switches::of(sides, rates));
        out.copy_from_slice(acceleration.as_slice());
        Ok(())
    }

    /// Gives the end of a step that slides along conditions the velocity for which their functions
    /// are zero: else a body that friction holds would creep by the errors of each step.
    #[inline]
    pub(super) fn project_sliding(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &mut State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        match self.conditions.decided.sliding {
            0 => Ok(()),
            _ => self.strike(mechanism, state),
        }
    }

    #[inline(never)]
    fn strike(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &mut State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        let slid = self.conditions.decided.slid(state.t)?;
        let mut vectors = [[T::zero(); N]; ROOM + 1];
        let (mut v, room) = (state.v, vectors.as_flattened_mut());
        let mut accelerate = |sides, rates: &mut [_], out: &mut [_]| {
            self.acceleration_on(sides, mechanism, state, rates, out)
        };
        let weights = weighing()(&slid, N, room, &mut accelerate, |function| function.value)?;
        slid.add(&weights, &room[N..], v.as_mut_slice());
        self.decide(self.conditions.decided.sides);
        let off = |v: SVector<T, N>| {
            let mut values = [Switch::default(); Sides::ROOM];
            let mut out = Switches::of(self.conditions.decided.sides, &mut values);
            mechanism.switches(&State { v, ..*state }, &SVector::zeros(), &mut out);
            let sum = |sum: T, &index: &usize| sum + values[index].value.abs();
            slid.list().iter().fold(T::zero(), sum)
        };
        // Forces that hardly hold anything tell no direction.
        if off(v) < off(state.v) {
            state.v = v;
        }
        Ok(())
    }
}

impl<T: Real, const N: usize, const R: usize> Attempt<'_, T, N, R> {
    /// The state at a time; at the ends those that the attempt began and ended with.
    fn at(&self, t: T) -> State<T, N> {
        match self.step {
            Some(step) if t < self.end.t => step.at(t),
            _ => *self.end,
        }
    }
}

impl<T: Real, const N: usize, const R: usize> Motion<T> for Attempt<'_, T, N, R> {
    fn decided(&mut self) -> &mut Decided<T> {
        &mut self.core.conditions.decided
    }

    fn ends(&self) -> (T, T) {
        let start = self.step.map_or(self.end, Step::start);
        (start.t, self.end.t)
    }

    fn noise(&self) -> T {
        noise(self.core.session.tolerance)
    }

    fn values(&self, t: T, out: &mut Switches<'_, T>) {
        let (state, still) = (self.at(t), SVector::zeros());
        self.mechanism.switches(&state, &still, out);
    }

    fn rates(&mut self, t: T, values: &mut [Switch<T>]) -> Result<(), DynamicsError<T>> {
        let state = self.at(t);
        self.core.decide(self.core.conditions.decided.sides);
        let acceleration = self.core.held_acceleration(self.mechanism, &state)?;
        if !values.is_empty() {
            let sides = self.core.conditions.decided.sides;
            let mut out = Switches::of(sides, values);
            self.mechanism.switches(&state, &acceleration, &mut out);
        }
        Ok(())
    }
}
