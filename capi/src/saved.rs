//! What a mechanism is at, as numbers that can be kept in a file.
//!
//! In:  an [`Engine`].
//! Out: numbers: whether there is a state, time, coordinates, velocities, parameters, start
//!      values; and back.
//!
//! Not here: functions that inputs follow, and what the solver remembers of the last step.

use crate::Embedded;
use crate::engine::{Engine, Outcome};
use crate::status::Status;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Initial, State};

impl<M, const N: usize, const R: usize> Engine<M, N, R>
where
    M: Embedded<N, R>,
{
    /// How many numbers [`save`](Self::save) writes.
    pub fn saved_size(&self) -> usize {
        let structure = self.structure();
        let [parameters, inputs] = [structure.parameters.len(), structure.inputs.len()];
        2 + 2 * N + parameters + 2 * inputs + 4 * N
    }

    /// Writes what the mechanism is at.
    ///
    /// # Errors
    ///
    /// [`Status::Length`].
    pub fn save(&mut self, out: &mut [f64]) -> Outcome {
        self.expect_length(out.len(), self.saved_size(), "a saved mechanism")?;
        let state = self.state_if_any();
        let at = state.unwrap_or_default();
        let start = self.start();
        let parameters = (0..self.structure().parameters.len())
            .map(|index| self.parameter_at(index).unwrap_or_default());
        let held = self.held();
        let inputs = held.iter().flat_map(|held| pair(*held));
        let initial = start.q.iter().chain(&start.v);
        let starts = initial.flat_map(|initial| [initial.value, flag(initial.held)]);
        let values = [flag(state.is_some()), at.t]
            .into_iter()
            .chain(at.q.iter().copied())
            .chain(at.v.iter().copied())
            .chain(parameters)
            .chain(inputs)
            .chain(starts);
        for (place, value) in out.iter_mut().zip(values) {
            *place = value;
        }
        Ok(())
    }

    /// Reads what was written; the solver begins anew.
    ///
    /// # Errors
    ///
    /// [`Status::Length`], [`Status::NotFinite`]; nothing is changed then.
    pub fn load(&mut self, saved: &[f64]) -> Outcome {
        self.expect_length(saved.len(), self.saved_size(), "a saved mechanism")?;
        if saved.iter().any(|value| !value.is_finite()) {
            return self.refuse(
                Status::NotFinite,
                &"a saved mechanism holds a number that is infinite or NaN",
            );
        }
        let mut saved = saved.iter().copied();
        let mut next = || saved.next().unwrap_or_default();
        let is_placed = next() != 0.0;
        let t = next();
        let q = SVector::from_fn(|_, _| next());
        let v = SVector::from_fn(|_, _| next());
        for index in 0..self.structure().parameters.len() {
            self.set_parameter(index, next())?;
        }
        for index in 0..self.structure().inputs.len() {
            let (is_held, value) = (next() != 0.0, next());
            match is_held {
                true => self.hold_input(index, value)?,
                false => self.release_input(index)?,
            }
        }
        let mut initial = || Initial {
            value: next(),
            held: next() != 0.0,
        };
        let mut start = self.start();
        start.q = core::array::from_fn(|_| initial());
        start.v = core::array::from_fn(|_| initial());
        self.replace(is_placed.then_some(State { t, q, v }), start);
        Ok(())
    }
}

fn flag(is: bool) -> f64 {
    f64::from(u8::from(is))
}

fn pair(value: Option<f64>) -> [f64; 2] {
    [flag(value.is_some()), value.unwrap_or_default()]
}
