//! Events, located within steps.
//!
//! In:  the event functions along a step.
//! Out: [`Occurrence`]s in the order of time.
//!
//! Changes of sign are looked for on the step's interpolant ([`crate::crossing`]), also
//! those that come in pairs. The zero is then found by Brent's method to the round-off of
//! time, with the function evaluated on states that are back on the constraints. An event
//! whose function is zero at the start of a run has not happened; one that reaches zero
//! has, even if it turns back.

use super::SimulateError;
use crate::crossing::{Left, NODES, Samples, first_crossing, nodes, zero};
use crate::linalg::column;
use crate::{
    Direction, DynamicsError, Event, Interface, Occurrence, Probe, Real, State, Step, Watched,
};

/// Events a mechanism may have.
pub(super) const ROOM: usize = 64;
/// Times closer than this multiple of the round-off of time are one.
const SAME_TIME: f64 = 8.0;

/// Watches the event functions of a mechanism.
#[derive(Clone, Debug)]
pub(super) struct Events<T> {
    events: &'static [Event],
    /// The signs that the functions had last; zero where they were zero.
    sides: [T; ROOM],
    /// When each event happens next within the step at hand.
    next: [Option<Next<T>>; ROOM],
}

/// When an event happens.
#[derive(Clone, Copy, Debug)]
struct Next<T> {
    /// On the step's interpolant.
    t: T,
    /// Times between which the function changes its sign.
    bracket: (T, T),
    /// Whether it goes up.
    rising: bool,
}

impl<T: Real> Default for Events<T> {
    fn default() -> Self {
        Self {
            events: &[],
            sides: [T::zero(); ROOM],
            next: [None; ROOM],
        }
    }
}

impl<T: Real> Events<T> {
    /// Begins at the initial state.
    pub(super) fn new<I, const N: usize>(
        mechanism: &I,
        events: &'static [Event],
        state: &State<T, N>,
    ) -> Result<Self, SimulateError<T>>
    where
        I: Interface<T, N> + ?Sized,
    {
        if events.len() > ROOM {
            return Err(SimulateError::TooManyEvents {
                events: events.len(),
                room: ROOM,
            });
        }
        let values = evaluate(mechanism, events, state).map_err(SimulateError::Observe)?;
        Ok(Self {
            events,
            sides: column(|index| values[index].sign()),
            next: [None; ROOM],
        })
    }

    pub(super) fn is_empty(&self) -> bool {
        self.events.is_empty()
    }

    /// Looks for the first occurrence of each event in a step.
    #[inline(never)]
    pub(super) fn look<I, const N: usize>(
        &mut self,
        mechanism: &I,
        step: &Step<T, N>,
    ) -> Result<(), DynamicsError<T>>
    where
        I: Interface<T, N> + ?Sized,
    {
        let times = nodes((step.start().t, step.end().t));
        let mut sampled = [[T::zero(); ROOM]; NODES];
        for (values, t) in sampled.iter_mut().zip(times) {
            *values = evaluate(mechanism, self.events, &step.at(t))?;
        }
        let values_of = |index: usize| column(|node| sampled[node][index]);
        for index in 0..self.events.len() {
            let values = values_of(index);
            let samples = Samples { times, values };
            self.next[index] = self.search(mechanism, step, index, samples)?;
        }
        Ok(())
    }

    /// The next occurrence of the step that was looked at, the earliest first.
    #[inline(never)]
    pub(super) fn next<I, const N: usize>(
        &mut self,
        mechanism: &I,
        probe: &mut dyn Probe<T, N>,
        step: &Step<T, N>,
    ) -> Result<Option<Occurrence<T, N>>, DynamicsError<T>>
    where
        I: Interface<T, N> + ?Sized,
    {
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
        let t = self.polished(mechanism, probe, step, (index, next))?;
        let occurrence = Occurrence {
            index,
            event: &self.events[index],
            rising: next.rising,
            state: on_constraints(probe, step, t)?,
        };
        let events = self.events;
        let mut value = |t| Ok(evaluate(mechanism, events, &step.at(t))?[index]);
        let left = rest(&mut value, (next.t.max(t), step.end().t))?;
        self.next[index] = match left {
            Some(samples) => self.search(mechanism, step, index, samples)?,
            None => None,
        };
        Ok(Some(occurrence))
    }

    /// Where an event happens first within what was sampled of a step.
    #[inline(never)]
    fn search<I, const N: usize>(
        &mut self,
        mechanism: &I,
        step: &Step<T, N>,
        index: usize,
        mut samples: Samples<T>,
    ) -> Result<Option<Next<T>>, DynamicsError<T>>
    where
        I: Interface<T, N> + ?Sized,
    {
        let (events, end) = (self.events, step.end().t);
        let mut value = |t| Ok(evaluate(mechanism, events, &step.at(t))?[index]);
        loop {
            let side = &mut self.sides[index];
            let found = first_crossing(&mut value, &samples, side, Left::AtZero)?;
            let Some((from, to)) = found else {
                return Ok(None);
            };
            let rising = *side < T::zero();
            let (before, after) = (value(from)?, value(to)?);
            let t = match before.sign() == *side {
                true => zero(&mut value, (from, before), (to, after))?,
                false => from,
            };
            *side = match value(t)? == T::zero() {
                true => T::zero(),
                false => -*side,
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
            match rest(&mut value, (t, end))? {
                Some(left) => samples = left,
                None => return Ok(None),
            }
        }
    }

    /// The time of an occurrence on states that are back on the constraints, if the
    /// function changes its sign there, too.
    #[inline(never)]
    fn polished<I, const N: usize>(
        &self,
        mechanism: &I,
        probe: &mut dyn Probe<T, N>,
        step: &Step<T, N>,
        (index, next): (usize, Next<T>),
    ) -> Result<T, DynamicsError<T>>
    where
        I: Interface<T, N> + ?Sized,
    {
        let mut value = |t| {
            let state = on_constraints(probe, step, t)?;
            Ok(evaluate(mechanism, self.events, &state)?[index])
        };
        let (from, to) = next.bracket;
        let (before, after) = (value(from)?, value(to)?);
        if from < to && before != T::zero() && before.sign() != after.sign() {
            zero(&mut value, (from, before), (to, after))
        } else {
            Ok(next.t)
        }
    }
}

/// Samples of what is left of a step, if anything is.
fn rest<T: Real>(
    value: &mut dyn FnMut(T) -> Result<T, DynamicsError<T>>,
    (from, to): (T, T),
) -> Result<Option<Samples<T>>, DynamicsError<T>> {
    let shortest = T::EPSILON * T::from_f64(SAME_TIME) * from.abs().max(to.abs());
    if to - from <= shortest {
        return Ok(None);
    }
    Samples::of(value, (from, to)).map(Some)
}

/// The event functions at a state, where all have a value. One that is infinite has a sign,
/// one that is not a number would never change it.
#[inline(never)]
fn evaluate<T, I, const N: usize>(
    mechanism: &I,
    events: &[Event],
    state: &State<T, N>,
) -> Result<[T; ROOM], DynamicsError<T>>
where
    T: Real,
    I: Interface<T, N> + ?Sized,
{
    let mut values = [T::zero(); ROOM];
    mechanism.events(state, &mut values);
    for (event, value) in events.iter().zip(&values) {
        if value.partial_cmp(&T::zero()).is_none() {
            let (t, quantity) = (state.t, Watched::Event(event.name));
            return Err(DynamicsError::WatchedNotFinite { t, quantity });
        }
    }
    Ok(values)
}

/// The state at a time within a step; the ends are on the constraints already.
fn on_constraints<T: Real, const N: usize>(
    probe: &mut dyn Probe<T, N>,
    step: &Step<T, N>,
    t: T,
) -> Result<State<T, N>, DynamicsError<T>> {
    let mut state = step.at(t);
    if t > step.start().t && t < step.end().t {
        probe.project(&mut state)?;
    }
    Ok(state)
}
