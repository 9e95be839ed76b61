//! Events that happen at the same instant as another.
//!
//! In:  the event functions at a state, and in the step that it is part of.
//! Out: which functions are zero there but for round-off.
//!
//! A run that goes on from where an event ended another doesn't tell that event again, nor others
//! that happen there, so that those are told before the run ends.

use super::event::{Along, Events, On, state_at};
use super::event_functions::{Functions, ROOM, round_off, same_state};
use crate::crossing::moment;
use crate::once::compiled_once;
use crate::{DynamicsError, Probe, Real, State, Step};

impl<T: Real> Events<T> {
    /// Keeps of the events that are left in the step those that happen where an observer broke off,
    /// too: a run that goes on from there takes them for told.
    pub(super) fn keep_simultaneous<const N: usize>(
        &mut self,
        functions: Functions<'_, T, N>,
        probe: &mut dyn Probe<T, N>,
        step: &Step<T, N>,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        let mut here = [T::zero(); ROOM];
        functions(state, &mut here);
        let round_off = round_off(functions, state, &here, same_state(state));
        let mut write = |t, on, values: &mut [T]| {
            functions(&state_at(probe, step, t, on)?, values);
            Ok(())
        };
        let ends = (state.t, step.end().t);
        let mut along = Along {
            ends,
            write: &mut write,
        };
        self.ends = true;
        keep_zeros()(self, &mut along, (&here, &round_off))
    }

    /// Keeps of the events that are left those that are zero at the beginning, but for round-off,
    /// and until they happen.
    fn keep_zeros(
        &mut self,
        along: &mut Along<'_, T>,
        (here, round_off): (&[T; ROOM], &[T; ROOM]),
    ) -> Result<(), DynamicsError<T>> {
        let start = along.ends.0;
        let same_time = moment(start);
        for index in 0..self.events.len() {
            let Some(next) = self.next[index] else {
                continue;
            };
            let t = self.polished(along, (index, next))?;
            // In between, what happened already and happens again is clear of zero.
            let between = (start + t) * T::from_f64(0.5);
            let between = along.value(self.events, between, On::Constraints, index)?;
            let is_zero = |value: T| value.abs() <= round_off[index];
            let at_once = is_zero(here[index]) && is_zero(between);
            if !at_once && t > start + same_time {
                self.next[index] = None;
            }
        }
        Ok(())
    }
}

compiled_once! {
    fn keep_zeros<T>: fn(
        &mut Events<T>,
        &mut Along<'_, T>,
        (&[T; ROOM], &[T; ROOM])
    ) -> Result<(), DynamicsError<T>> = Events::keep_zeros;
}
