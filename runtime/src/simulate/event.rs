//! Events, located within steps.
//!
//! In:  the event functions at several times of a step.
//! Out: [`Occurrence`]s in the order of time.
//!
//! The function of an event is evaluated on states that are back on the
//! constraints, and its zero is found by Brent's method to the round-off of
//! time. An event whose function is zero at the start of a run has not happened;
//! one that reaches zero has, even if it turns back.
//!
//! Source: Brent, Algorithms for Minimization without Derivatives (1973),
//! chapter 4.

use super::SimulateError;
use crate::crossing::zero;
use crate::{
    Direction, DynamicsError, Event, Interface, Occurrence, Probe, Real, State, Step, Watched,
};

/// Events a mechanism may have.
pub(super) const ROOM: usize = 64;

/// Watches the event functions of a mechanism.
#[derive(Clone, Debug)]
pub(super) struct Events<T> {
    events: &'static [Event],
    values: [T; ROOM],
}

/// Occurrences within a part of a step, in the order of time.
#[derive(Clone, Debug)]
pub(super) struct Found<T, const N: usize> {
    list: [Option<Occurrence<T, N>>; ROOM],
    count: usize,
}

impl<T: Real, const N: usize> Found<T, N> {
    /// The occurrences, the earliest first.
    pub(super) fn iter(&self) -> impl Iterator<Item = &Occurrence<T, N>> {
        self.list[..self.count].iter().flatten()
    }

    fn insert(&mut self, occurrence: Occurrence<T, N>) {
        let later = |other: &Option<Occurrence<T, N>>| {
            other
                .as_ref()
                .is_some_and(|other| other.state.t > occurrence.state.t)
        };
        let place = self.list[..self.count]
            .iter()
            .position(later)
            .unwrap_or(self.count);
        if self.count < ROOM {
            self.list[place..=self.count].rotate_right(1);
            self.list[place] = Some(occurrence);
            self.count += 1;
        }
    }
}

impl<T: Real> Default for Events<T> {
    fn default() -> Self {
        Self {
            events: &[],
            values: [T::zero(); ROOM],
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
        Ok(Self { events, values })
    }

    pub(super) fn is_empty(&self) -> bool {
        self.events.is_empty()
    }

    /// Looks at the step up to the time `to`, where it has looked up to `from`.
    pub(super) fn look<I, const N: usize>(
        &mut self,
        mechanism: &I,
        probe: &mut dyn Probe<T, N>,
        step: &Step<T, N>,
        (from, to): (T, T),
    ) -> Result<Found<T, N>, DynamicsError<T>>
    where
        I: Interface<T, N> + ?Sized,
    {
        let mut found = Found {
            list: [None; ROOM],
            count: 0,
        };
        let state = on_constraints(probe, step, to)?;
        let after = evaluate(mechanism, self.events, &state)?;
        let before = core::mem::replace(&mut self.values, after);
        for (index, event) in self.events.iter().enumerate() {
            let (low, high) = (before[index], self.values[index]);
            let rising = low < T::zero() && high >= T::zero();
            let falling = low > T::zero() && high <= T::zero();
            let happened = match event.direction {
                Direction::Rising => rising,
                Direction::Falling => falling,
                Direction::Crossing => rising || falling,
            };
            if happened {
                let mut function = |t: T| {
                    let state = on_constraints(probe, step, t)?;
                    Ok(evaluate(mechanism, self.events, &state)?[index])
                };
                let t = zero(&mut function, (from, low), (to, high))?;
                let state = on_constraints(probe, step, t)?;
                found.insert(Occurrence {
                    index,
                    event,
                    rising,
                    state,
                });
            }
        }
        Ok(found)
    }
}

/// The event functions at a state, where all have a value. One that is infinite has a sign,
/// one that is not a number would never change it.
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
