//! Forces that jump or kink: each step is made with the conditions held.
//!
//! In:  attempts at steps, made with the conditions that held at their start.
//! Out: where the first of them changes; the conditions from there on.
//!
//! A condition hangs on the side of zero of a switching function. Held on its side, the
//! forces are smooth over the step and beyond, so that the step's own interpolant tells
//! when the function passes zero, and the step can be made again to end there. Where the
//! motion is pushed back to zero from both sides, as by dry friction that holds, it slides
//! along ([`super::sliding`]).
//!
//! Source: Park & Barton, ACM Transactions on Modeling and Computer Simulation 6 (1996)
//! 137–165 (discontinuity locking).

use super::Core;
use super::conditions::Aim;
use crate::crossing::{Left, NODES, Samples, first_crossing, nodes, zero};
use crate::{DynamicsError, Mechanism, Real, Sides, State, Step, Switch, Switching, Watched};
use nalgebra::SVector;

/// Attempts to end a step where one function passes zero, after the first.
const REFINEMENTS: u32 = 3;
/// Switching functions that are sampled at once: the room for more has to be cleared.
const AT_ONCE: usize = 8;
/// Times closer than this multiple of the round-off of time are one.
const SAME_TIME: f64 = 8.0;
/// Functions of states within a step are off by this part of its accepted error.
const NOISE: f64 = 0.01;
/// The same in units of round-off, at least and with fixed steps.
const NOISE_OF_FIXED: f64 = 4096.0;
/// Conditions that change again after this part of an attempt at a step get nowhere.
const HARDLY_LATER: f64 = 1e-6;
/// Changes in a row that get nowhere, besides some for each condition there is.
const MOST_TURNS: usize = 100;
/// Changes within the length of one attempt: what rests where it is pushed from both sides
/// trembles by as much as noise lets it, and a run would never end.
const MOST_AT_ONCE: usize = 10_000;

/// The values of all switching functions at a state.
pub(super) type Values<T> = [Switch<T>; Sides::ROOM];

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Hands the sides to everything that evaluates forces.
    pub(super) fn decide(&mut self, sides: Sides) {
        self.terms.sides = sides;
        self.regular.sides = sides;
    }

    /// Lets the state decide the conditions.
    pub(super) fn release(&mut self) {
        if !self.conditions.list.is_empty() {
            self.decide(Sides::FREE);
        }
    }

    /// Holds the conditions as they are at the start of a step; whether there are any.
    pub(super) fn hold(&mut self, mechanism: &dyn Mechanism<T, N, R>, state: &State<T, N>) -> bool {
        let count = self.conditions.list.len();
        if count == 0 {
            return false;
        }
        if self.conditions.at.as_ref() != Some(state) {
            let values = values(mechanism, state, &SVector::zeros());
            let conditions = &mut self.conditions;
            for (index, switch) in (0..).zip(&values[..count]) {
                // On the wrong side of zero for zero: the first step will show it.
                conditions.sides.hold(index, switch.value >= T::zero());
            }
            (conditions.sliding, conditions.turns) = (0, 0);
            (conditions.turned, conditions.attempt) = (state.t, T::zero());
            conditions.burst = (state.t, 0);
            conditions.aim = None;
            conditions.at = Some(*state);
        }
        self.decide(self.conditions.sides);
        true
    }

    /// Where the first condition changes within a step that was made with those at its
    /// start.
    pub(super) fn switch(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        step: &Step<T, N>,
    ) -> Result<Switching<T>, DynamicsError<T>> {
        if self.conditions.list.is_empty() {
            return Ok(Switching::Nowhere);
        }
        self.conditions.made = Some((self.conditions.sides, self.conditions.sliding));
        let (start, end) = (step.start().t, step.end().t);
        let same = T::EPSILON * T::from_f64(SAME_TIME) * start.abs().max(end.abs());
        self.conditions.attempt = self.conditions.attempt.max(end - start);
        // An attempt that was too long for its tolerance ends earlier than it should.
        let aim = self.conditions.aim.take();
        let aim = aim.filter(|aim| end >= aim.t - same);
        let index = match self.first_change(mechanism, step)? {
            Some((index, t)) if t <= start + same => {
                self.turn(mechanism, index, step.start())?;
                return Ok(Switching::AtStart);
            }
            Some((index, t)) => {
                // What passes zero long before is another zero of the same function.
                let near = t - start > (end - start) * T::from_f64(0.5);
                let tries = aim
                    .filter(|aim| aim.index == index && near)
                    .map_or(0, |aim| aim.tries + 1);
                if t < end - same && tries <= REFINEMENTS {
                    self.conditions.aim = Some(Aim { index, t, tries });
                    return Ok(Switching::Within(t));
                }
                index
            }
            None => match aim {
                None => {
                    self.settle(step.end());
                    return Ok(Switching::Nowhere);
                }
                Some(aim) => {
                    if let Some(t) = self.refined(mechanism, step, aim, same)? {
                        self.conditions.aim = Some(Aim {
                            t,
                            tries: aim.tries + 1,
                            ..aim
                        });
                        return Ok(Switching::Within(t));
                    }
                    aim.index
                }
            },
        };
        self.turn(mechanism, index, step.end())?;
        self.settle(step.end());
        Ok(Switching::AtEnd)
    }

    /// What a function is off by within a step, relative to its size there.
    pub(super) fn noise(&self) -> T {
        let tolerance = self.session.tolerance.unwrap_or(T::zero());
        (tolerance * T::from_f64(NOISE)).max(T::EPSILON * T::from_f64(NOISE_OF_FIXED))
    }

    /// Time has gone on to a state.
    fn settle(&mut self, state: &State<T, N>) {
        self.conditions.at = Some(*state);
        self.conditions.attempt = T::zero();
    }

    /// A better time for a function to pass zero, by Newton's method from the end of an
    /// attempt; none if that was good enough.
    #[inline(never)]
    fn refined(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        step: &Step<T, N>,
        aim: Aim<T>,
        same: T,
    ) -> Result<Option<T>, DynamicsError<T>> {
        if aim.tries >= REFINEMENTS || self.conditions.slides(aim.index) {
            return Ok(None);
        }
        let acceleration = self.held_acceleration(mechanism, step.end())?;
        let Switch { value, rate } = one(mechanism, step.end(), &acceleration, aim.index);
        let change = -(value / rate);
        // False for NaN, too: a function that only just reaches zero.
        let worth = change.abs() > same && change.abs() < step.length() * T::from_f64(0.1);
        Ok(worth.then(|| step.end().t + change))
    }

    /// Changes a condition at a state: to its other side, or to sliding if the motion is
    /// pushed back from there; off that again where one side no longer pushes.
    #[inline(never)]
    fn turn(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        index: usize,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        self.count_turn(index, state.t)?;
        let place = index as u32;
        if self.conditions.slides(index) {
            let above = self.conditions.shares[index] > T::from_f64(0.5);
            self.conditions.sliding &= !(1 << index);
            self.conditions.sides.hold(place, above);
            self.decide(self.conditions.sides);
            return Ok(());
        }
        let side = self.conditions.side(index);
        let mut pushes = [T::zero(); 2];
        for (push, above) in pushes.iter_mut().zip([side > T::zero(), side < T::zero()]) {
            self.conditions.sides.hold(place, above);
            self.decide(self.conditions.sides);
            let acceleration = self.held_acceleration(mechanism, state)?;
            *push = one(mechanism, state, &acceleration, index).rate * side;
        }
        let [leaves, returns] = [pushes[0] < T::zero(), pushes[1] > T::zero()];
        if leaves && returns && !self.conditions.list[index].kinks {
            self.conditions.sliding |= 1 << index;
        }
        Ok(())
    }

    /// Refuses conditions that change again and again while time hardly goes on.
    fn count_turn(&mut self, index: usize, t: T) -> Result<(), DynamicsError<T>> {
        let conditions = &mut self.conditions;
        let later = t - conditions.turned > conditions.attempt * T::from_f64(HARDLY_LATER);
        conditions.turned = t;
        conditions.turns = if later { 0 } else { conditions.turns + 1 };
        let (since, count) = conditions.burst;
        conditions.burst = match t - since > conditions.attempt {
            true => (t, 0),
            false => (since, count + 1),
        };
        let most = MOST_TURNS + 2 * conditions.list.len();
        if conditions.turns > most || conditions.burst.1 > MOST_AT_ONCE {
            let condition = &conditions.list[index];
            return Err(DynamicsError::Sticks { t, condition });
        }
        Ok(())
    }

    /// The first condition that changes within a step, and when.
    #[inline(never)]
    fn first_change(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        step: &Step<T, N>,
    ) -> Result<Option<(usize, T)>, DynamicsError<T>> {
        let list = self.conditions.list;
        let still = SVector::zeros();
        let times = nodes((step.start().t, step.end().t));
        let mut sampled = [[T::zero(); NODES]; AT_ONCE];
        let mut first: Option<(usize, T)> = None;
        for index in 0..list.len() {
            if index % AT_ONCE == 0 {
                sample(mechanism, step, (&times, index), &mut sampled);
            }
            let found = if self.conditions.slides(index) {
                self.end_of_sliding(mechanism, step, index)?
            } else {
                let side = self.conditions.side(index);
                let defined = |t, value: T| {
                    let undefined = DynamicsError::WatchedNotFinite {
                        t,
                        quantity: Watched::Condition(list[index].text),
                    };
                    value
                        .partial_cmp(&T::zero())
                        .map(|_| value)
                        .ok_or(undefined)
                };
                let mut value = |t| defined(t, one(mechanism, &step.at(t), &still, index).value);
                let samples = sampled[index % AT_ONCE];
                defined(step.end().t, samples[NODES - 1])?;
                earliest(&mut value, (times, samples), side, self.noise())?
            };
            if let Some(t) = found {
                first = match first {
                    Some((_, earlier)) if earlier <= t => first,
                    _ => Some((index, t)),
                };
            }
        }
        Ok(first)
    }
}

/// When a sampled function leaves a side for the other one, if it does by more than noise.
pub(super) fn earliest<T: Real>(
    function: &mut dyn FnMut(T) -> Result<T, DynamicsError<T>>,
    (times, mut values): ([T; NODES], [T; NODES]),
    side: T,
    noise: T,
) -> Result<Option<T>, DynamicsError<T>> {
    let size = values
        .iter()
        .fold(T::zero(), |most: T, x| most.max(x.abs()));
    let margin = noise * size * side;
    for value in &mut values {
        *value += margin;
    }
    let samples = Samples { times, values };
    let mut beyond = |t| Ok(function(t)? + margin);
    let found = first_crossing(&mut beyond, &samples, &mut side.clone(), Left::BeyondZero)?;
    let Some((from, to)) = found else {
        return Ok(None);
    };
    let (before, after) = (function(from)?, function(to)?);
    if before.sign() != side {
        return Ok(Some(from));
    }
    let t = zero(function, (from, before), (to, after))?;
    Ok(Some(t))
}

/// Samples some switching functions of a step, from one on.
#[inline(never)]
fn sample<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    step: &Step<T, N>,
    (times, first): (&[T; NODES], usize),
    sampled: &mut [[T; NODES]; AT_ONCE],
) {
    let mut values = [Switch::default(); Sides::ROOM];
    let values = &mut values[..(first + AT_ONCE).min(Sides::ROOM)];
    for (k, t) in times.iter().enumerate() {
        mechanism.switches(&step.at(*t), &SVector::zeros(), values);
        for (samples, switch) in sampled.iter_mut().zip(&values[first..]) {
            samples[k] = switch.value;
        }
    }
}

/// The value of one switching function at a state.
fn one<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    state: &State<T, N>,
    acceleration: &SVector<T, N>,
    index: usize,
) -> Switch<T> {
    let mut values = [Switch::default(); Sides::ROOM];
    mechanism.switches(state, acceleration, &mut values[..=index]);
    values[index]
}

/// The values of all switching functions at a state.
pub(super) fn values<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    state: &State<T, N>,
    acceleration: &SVector<T, N>,
) -> Values<T> {
    let mut values = [Switch::default(); Sides::ROOM];
    mechanism.switches(state, acceleration, &mut values);
    values
}
