//! Events, located within steps.
//!
//! In:  the event functions along a step.
//! Out: [`Occurrence`]s in the order of time.
//!
//! Changes of sign are looked for on the step's interpolant ([`crate::crossing`]), also
//! those that come in pairs. The zero is then found by Brent's method to the round-off of
//! time, with the function evaluated on states that are back on the constraints. An event
//! whose function is zero at the start of a run, but for round-off, has not happened, so that a run
//! may go on from where an event ended another; one that reaches zero
//! has, even if it turns back, and so has one that comes to zero but for round-off, as the
//! velocity of a block that dry friction stops. It happens again once its function has been
//! clear of zero: one that only touches zero, or stays there for a while, changes its sign as
//! often as round-off lets it.
//!
//! All of that is over times and values, and compiled once for mechanisms of all sizes.

use super::SimulateError;
use super::event_functions::{Functions, ROOM, round_off, same_state};
use crate::crossing::{Left, NODES, Samples, first_crossing, moment, nodes, noise, told, zero};
use crate::linalg::{column, largest};
use crate::once::compiled_once;
use crate::pace::Pace;
use crate::{
    Direction, DynamicsError, Event, Occurrence, OtherBranch, Probe, Real, State, Step, Watched,
};

/// A function is clear of zero beyond this part of its size in a step, even if it goes back.
const CLEARLY: f64 = 1e-6;

/// At the ends of a step a function is zero within this many units of the round-off of its size.
const AT_ZERO: f64 = 32.0;

/// Watches the event functions of a mechanism.
#[derive(Clone, Debug)]
pub(crate) struct Events<T> {
    pub(super) events: &'static [Event],
    /// The signs that the functions had last; zero where they have not been clear of zero
    /// since.
    sides: [T; ROOM],
    /// How large the functions are in the step at hand and in those shortly before.
    sizes: [T; ROOM],
    /// Up to which size they are zero at the ends of the step at hand.
    zeros: [T; ROOM],
    pace: Pace<T>,
    /// What they are off by, relative to their sizes.
    noise: T,
    /// When each event happens next within the step at hand.
    pub(super) next: [Option<Next<T>>; ROOM],
    /// What round-off of the state at the start makes of the functions; zero once they were clear
    /// of zero.
    round_off: [T; ROOM],
    /// Whether the next step is the first of the run.
    begins: bool,
    /// Whether the run ends with the events that are left.
    pub(super) ends: bool,
}

/// When an event happens.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Next<T> {
    /// On the step's interpolant.
    t: T,
    /// Times between which the function changes its sign.
    bracket: (T, T),
    /// Whether it goes up.
    rising: bool,
}

/// An event that happened.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Happened<T> {
    index: usize,
    t: T,
    rising: bool,
}

/// Which states within a step functions are evaluated at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum On {
    /// Those of its interpolant.
    Interpolant,
    /// Those that are back on the constraints.
    Constraints,
}

/// Writes all event functions at a time within a step.
type Write<'a, T> = dyn FnMut(T, On, &mut [T]) -> Result<(), DynamicsError<T>> + 'a;

/// The event functions along a step.
pub(crate) struct Along<'a, T> {
    /// Where the step begins and ends.
    pub(super) ends: (T, T),
    pub(super) write: &'a mut Write<'a, T>,
}

impl<T: Real> Events<T> {
    /// None yet, in steps that follow a tolerance, if they do.
    pub(super) fn new(tolerance: Option<T>) -> Self {
        Self {
            events: &[],
            sides: [T::zero(); ROOM],
            sizes: [T::zero(); ROOM],
            zeros: [T::zero(); ROOM],
            pace: Pace::new(),
            noise: noise(tolerance),
            next: [None; ROOM],
            round_off: [T::zero(); ROOM],
            begins: false,
            ends: false,
        }
    }

    /// Begins at the initial state.
    pub(super) fn begin<const N: usize>(
        &mut self,
        functions: Functions<'_, T, N>,
        events: &'static [Event],
        state: &State<T, N>,
    ) -> Result<(), SimulateError<T>> {
        if events.len() > ROOM {
            return Err(SimulateError::TooManyEvents {
                events: events.len(),
                room: ROOM,
            });
        }
        self.events = events;
        (self.begins, self.ends) = (true, false);
        if self.is_empty() {
            return Ok(());
        }
        let mut write = |_, _, values: &mut [T]| {
            functions(state, values);
            Ok(())
        };
        let mut along = Along {
            ends: (state.t, state.t),
            write: &mut write,
        };
        let values = along.values(events, state.t, On::Interpolant);
        let values = values.map_err(SimulateError::Observe)?;
        self.round_off = round_off(functions, state, &values, same_state(state));
        let known = values.iter().zip(&self.round_off);
        for (side, (value, round_off)) in self.sides.iter_mut().zip(known) {
            *side = match value.abs() <= *round_off {
                true => T::zero(),
                false => value.sign(),
            };
        }
        Ok(())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.events.is_empty()
    }

    /// Looks for the first occurrence of each event in a step.
    pub(super) fn look<const N: usize>(
        &mut self,
        functions: Functions<'_, T, N>,
        step: &Step<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if self.begins && !self.is_empty() {
            self.begin_step(functions, step);
        }
        let mut write = |t, _, values: &mut [T]| {
            functions(&step.at(t), values);
            Ok(())
        };
        let mut along = Along {
            ends: (step.start().t, step.end().t),
            write: &mut write,
        };
        find_first()(self, &mut along)
    }

    /// Forgets the sides of functions that are zero but for velocities that change no coordinate
    /// within the first step: what is at rest where a run begins tells no size of velocities.
    fn begin_step<const N: usize>(&mut self, functions: Functions<'_, T, N>, step: &Step<T, N>) {
        let (start, length) = (step.start(), step.end().t - step.start().t);
        // Where all coordinates are zero one unit stands for them.
        let size = match largest(start.q.as_slice()) {
            none if none == T::zero() => T::one(),
            size => size,
        };
        let unresolved = size * T::EPSILON * T::from_f64(AT_ZERO) / length;
        let mut values = [T::zero(); ROOM];
        functions(start, &mut values);
        let changes = round_off(functions, start, &values, [T::zero(), unresolved]);
        let known = self.sides.iter_mut().zip(&mut self.round_off);
        for ((side, least), (value, change)) in known.zip(values.iter().zip(changes)) {
            *least = least.max(change);
            if value.abs() <= *least {
                *side = T::zero();
            }
        }
    }

    /// The next occurrence of the step that was looked at, the earliest first.
    pub(super) fn next<const N: usize>(
        &mut self,
        functions: Functions<'_, T, N>,
        probe: &mut dyn Probe<T, N>,
        step: &Step<T, N>,
    ) -> Result<Option<Occurrence<T, N>>, DynamicsError<T>> {
        let mut write = |t, on, values: &mut [T]| {
            functions(&state_at(probe, step, t, on)?, values);
            Ok(())
        };
        let mut along = Along {
            ends: (step.start().t, step.end().t),
            write: &mut write,
        };
        let happened = take_first()(self, &mut along)?;
        let Some(Happened { index, t, rising }) = happened else {
            return Ok(None);
        };
        Ok(Some(Occurrence {
            index,
            event: &self.events[index],
            rising,
            state: state_at(probe, step, t, On::Constraints)?,
        }))
    }

    /// The first occurrence of each event, over times and values.
    pub(crate) fn find_first(&mut self, along: &mut Along<'_, T>) -> Result<(), DynamicsError<T>> {
        let times = nodes(along.ends);
        let mut sampled = [[T::zero(); ROOM]; NODES];
        for (values, t) in sampled.iter_mut().zip(times) {
            *values = along.values(self.events, t, On::Interpolant)?;
        }
        let values_of = |index: usize| column(|node| sampled[node][index]);
        let left = self.pace.observe(along.ends.1 - along.ends.0);
        for index in 0..self.events.len() {
            let values: [T; NODES] = values_of(index);
            let samples = Samples { times, values };
            self.observe_size(index, left, samples.size());
            // A step that ends at an event ends there but for the round-off of time.
            let zero = self.sizes[index] * T::EPSILON * T::from_f64(AT_ZERO);
            self.zeros[index] = zero.max(samples.round_off_of_time());
            let values = column(|node| self.at_end(along.ends, index, times[node], values[node]));
            if self.is_held(index, &values) {
                self.next[index] = None;
                continue;
            }
            let samples = Samples { times, values };
            let side = &mut self.sides[index];
            if self.begins && samples.begins_at_zero() {
                *side = T::zero();
            }
            let clear = self.round_off[index].max(T::from_f64(CLEARLY) * self.sizes[index]);
            if values[0].abs() > clear && *side == T::zero() {
                *side = values[0].sign();
            }
            let samples = match *side == T::zero() {
                true => self.rest(along, index, along.ends.0)?,
                false => Some(samples),
            };
            self.next[index] = match samples {
                Some(samples) => self.search(along, index, samples)?,
                None => None,
            };
            if self.sides[index] != T::zero() {
                self.round_off[index] = T::zero();
            }
        }
        self.begins = false;
        Ok(())
    }

    /// Takes note of how large a function is in a step that leaves this part of what was known.
    fn observe_size(&mut self, index: usize, left: T, size: T) {
        let known = self.sizes[index];
        // What is held at zero is as large as it was before.
        if size > known * told(self.noise) {
            self.sizes[index] = size.max(known * left);
        }
    }

    /// Whether a function that was zero is held there throughout a step, as the velocity of what
    /// dry friction holds: what it does between the ends is the error of the step.
    fn is_held(&self, index: usize, values: &[T; NODES]) -> bool {
        let least = self.sizes[index] * told(self.noise);
        self.sides[index] == T::zero()
            && values[0] == T::zero()
            && values[NODES - 1] == T::zero()
            && values.iter().all(|value| value.abs() <= least)
    }

    /// A value of a function within a step, or zero at one of its ends where it is zero but for
    /// round-off: what switches there may hold it.
    fn at_end(&self, (start, end): (T, T), index: usize, t: T, value: T) -> T {
        match (t == start || t == end) && value.abs() <= self.zeros[index] {
            true => T::zero(),
            false => value,
        }
    }

    /// The earliest of the next occurrences, after which that event is looked for again.
    pub(crate) fn take_first(
        &mut self,
        along: &mut Along<'_, T>,
    ) -> Result<Option<Happened<T>>, DynamicsError<T>> {
        let mut first: Option<(usize, Next<T>)> = None;
        for (index, next) in self.next.iter().enumerate() {
            if let Some(next) = *next
                && first.is_none_or(|(_, earlier)| next.t < earlier.t)
            {
                first = Some((index, next));
            }
        }
        let Some((index, next)) = first else {
            return Ok(None);
        };
        let t = self.polished(along, (index, next))?;
        self.next[index] = None;
        if !self.ends
            && let Some(samples) = self.rest(along, index, next.t.max(t))?
        {
            self.next[index] = self.search(along, index, samples)?;
        }
        let rising = next.rising;
        Ok(Some(Happened { index, t, rising }))
    }

    /// Where an event happens first within what was sampled of a step.
    fn search(
        &mut self,
        along: &mut Along<'_, T>,
        index: usize,
        mut samples: Samples<T>,
    ) -> Result<Option<Next<T>>, DynamicsError<T>> {
        let (events, ends) = (self.events, along.ends);
        loop {
            let mut value = |t| along.value(events, t, On::Interpolant, index);
            let mut side = self.sides[index];
            let mut judged = |t| Ok(self.at_end(ends, index, t, value(t)?));
            let found = first_crossing(&mut judged, &samples, &mut side, Left::AtZero)?;
            self.sides[index] = side;
            let Some((from, to)) = found else {
                return Ok(None);
            };
            let rising = side < T::zero();
            let (before, after) = (value(from)?, value(to)?);
            let t = match (before.sign() == side, after.sign() == side) {
                (true, false) => zero(&mut value, (from, before), (to, after))?,
                // It is zero there but for round-off.
                (true, true) => to,
                (false, _) => from,
            };
            let counts = match events[index].direction {
                Direction::Rising => rising,
                Direction::Falling => !rising,
                Direction::Crossing => true,
            };
            if counts {
                let bracket = (from, to);
                return Ok(Some(Next { t, bracket, rising }));
            }
            match self.rest(along, index, t)? {
                Some(left) => samples = left,
                None => return Ok(None),
            }
        }
    }

    /// The time of an occurrence on states that are back on the constraints, if the
    /// function changes its sign there, too.
    pub(super) fn polished(
        &self,
        along: &mut Along<'_, T>,
        (index, next): (usize, Next<T>),
    ) -> Result<T, DynamicsError<T>> {
        let mut value = |t| along.value(self.events, t, On::Constraints, index);
        let (from, to) = next.bracket;
        let (before, after) = (value(from)?, value(to)?);
        if from < to && before != T::zero() && before.sign() != after.sign() {
            zero(&mut value, (from, before), (to, after))
        } else {
            Ok(next.t)
        }
    }

    /// Samples of a function in what is left of a step after it was zero: from where it has
    /// clearly left zero, to whichever side. Before that noise may change its sign very many
    /// times.
    fn rest(
        &mut self,
        along: &mut Along<'_, T>,
        index: usize,
        from: T,
    ) -> Result<Option<Samples<T>>, DynamicsError<T>> {
        self.sides[index] = T::zero();
        let noise = self.round_off[index].max(self.noise * self.sizes[index]);
        let to = along.ends.1;
        let mut value = |t| along.value(self.events, t, On::Interpolant, index);
        let same_time = moment(from.abs().max(to.abs()));
        let mut pause = same_time.max(told(self.noise) * self.pace.longest());
        while from + pause + pause < to {
            let (begin, end) = (from + pause, from + pause + pause);
            if let Some(side) = Samples::of(&mut value, (begin, end))?.leaves_zero(noise) {
                self.sides[index] = side;
                return Samples::of(&mut value, (begin, to)).map(Some);
            }
            pause += pause;
        }
        Ok(None)
    }
}

impl<T: Real> Along<'_, T> {
    /// The event functions at a time, where all have a value. One that is infinite has a
    /// sign, one that is not a number would never change it.
    fn values(&mut self, events: &[Event], t: T, on: On) -> Result<[T; ROOM], DynamicsError<T>> {
        let mut values = [T::zero(); ROOM];
        (self.write)(t, on, &mut values)?;
        for (event, value) in events.iter().zip(&values) {
            if value.partial_cmp(&T::zero()).is_none() {
                let quantity = Watched::Event(event.name);
                return Err(DynamicsError::WatchedNotFinite { t, quantity });
            }
        }
        Ok(values)
    }

    /// One of them.
    pub(super) fn value(
        &mut self,
        events: &[Event],
        t: T,
        on: On,
        index: usize,
    ) -> Result<T, DynamicsError<T>> {
        Ok(self.values(events, t, on)?[index])
    }
}

/// The state at a time within a step; the ends are on the constraints already.
#[inline(never)]
pub(super) fn state_at<T: Real, const N: usize>(
    probe: &mut dyn Probe<T, N>,
    step: &Step<T, N>,
    t: T,
    on: On,
) -> Result<State<T, N>, DynamicsError<T>> {
    let mut state = step.at(t);
    if on == On::Constraints && t > step.start().t && t < step.end().t {
        probe.project(&mut state, OtherBranch::Crossed)?;
    }
    Ok(state)
}

compiled_once! {
    fn find_first<T>: fn(&mut Events<T>, &mut Along<'_, T>) -> Result<(), DynamicsError<T>> =
        Events::find_first;

    fn take_first<T>:
        fn(&mut Events<T>, &mut Along<'_, T>) -> Result<Option<Happened<T>>, DynamicsError<T>> =
        Events::take_first;
}
