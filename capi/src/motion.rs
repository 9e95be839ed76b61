//! How a mechanism moves, and what is evaluated along the way.
//!
//! In:  an [`Engine`], commands.
//! Out: states, numbers; a [`Status`] and a message where that fails.

use crate::Embedded;
use crate::engine::{Engine, Outcome};
use crate::evaluate::{Quantity, evaluate};
use crate::names::List;
use crate::status::{Status, time};
use crate::watch::{Ended, Listeners, Writer};
use bricard_runtime::{
    Grid, Interface, Observer, Options, Picture, SimulateError, State, Summary, simulate, with_room,
};
use core::sync::atomic::AtomicBool;

/// How a run ended, and what it did if it began.
pub type Run<const N: usize> = (Result<Option<Ended>, Status>, Option<Summary<f64, N>>);

impl<M, const N: usize, const R: usize> Engine<M, N, R>
where
    M: Embedded<N, R>,
{
    /// Goes to a time as [`simulate`] does, and tells those who listen.
    ///
    /// # Errors
    ///
    /// Why the run could not begin or go on, and what was done until then; the state is
    /// then the last good one.
    pub fn run(
        &mut self,
        until: f64,
        listeners: Option<&mut Listeners>,
        stop: &AtomicBool,
    ) -> Run<N> {
        let state = match self.state() {
            Ok(state) => state,
            Err(status) => return (Err(status), None),
        };
        let options = Options {
            until,
            ..*self.options()
        };
        let mut quiet = Listeners::quiet();
        let listeners = listeners.unwrap_or(&mut quiet);
        let grid = match listeners.every.map(Grid::new).transpose() {
            Ok(grid) => grid,
            Err(error) => return (self.refuse(Status::Argument, &error), None),
        };
        let mut writer = Writer::new(listeners, grid, stop);
        let observers: &mut [&mut dyn Observer<f64, N>] = &mut [&mut writer];
        let result = simulate::<_, _, N, R>(&self.driven, &state, &options, observers);
        let mut ended = writer.ended;
        if !listeners.sheet.hand_over() {
            ended = ended.or(Some(Ended::Stopped));
        }
        match result {
            Ok(summary) => {
                self.place(summary.end);
                (Ok(ended), Some(summary))
            }
            Err(failure) => {
                self.place(failure.summary.end);
                (Err(self.fault(&failure.error)), Some(failure.summary))
            }
        }
    }

    /// What a failed motion is called, with its message.
    pub(crate) fn fault(&mut self, error: &SimulateError<f64>) -> Status {
        let last = self.state.map(|state| state.t);
        self.failed_at = time(error).or(last);
        match self.driven.take_failed() {
            None => {
                self.text.say(error);
                Status::of(error)
            }
            Some(input) => {
                let name = self.names.list(List::Inputs)[input].name.to_string_lossy();
                let t = self.failed_at.unwrap_or_default();
                self.text.say(&format_args!(
                    "at t = {t} s the function of the input `{name}` failed"
                ));
                Status::Callback
            }
        }
    }

    /// Goes on by a span of time (s), in as many steps as the step control wants, for programs that
    /// act between: what steps taught is remembered, and nobody listens.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub fn step(&mut self, span: f64) -> Outcome {
        let mut state = self.state()?;
        let result = self.stepper.step(&self.driven, &mut state, span);
        self.stepped(state, result)
    }

    /// Goes on by one step, as long as the step control wants it and at most to a time.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub fn step_once(&mut self, bound: f64) -> Outcome {
        let mut state = self.state()?;
        let result = self.stepper.step_once(&self.driven, &mut state, bound);
        self.stepped(state, result)
    }

    #[inline]
    fn stepped(&mut self, state: State<f64, N>, result: Result<(), SimulateError<f64>>) -> Outcome {
        self.state = Some(state);
        result.map_err(|error| self.fault(&error))
    }

    /// Evaluates a quantity, at a state or where the mechanism is.
    ///
    /// # Errors
    ///
    /// [`Status::Length`], [`Status::NotFinite`], [`Status::Order`], [`Status::Run`];
    /// [`Status::Argument`] for derivatives that the mechanism lacks.
    pub fn evaluate(
        &mut self,
        quantity: Quantity,
        at: Option<State<f64, N>>,
        out: &mut [f64],
    ) -> Outcome {
        // The matrices of a large mechanism don't fit onto the stack of every thread.
        with_room::<f64, _, N, R>(|| self.evaluated(quantity, at, out))
    }

    fn evaluated(
        &mut self,
        quantity: Quantity,
        at: Option<State<f64, N>>,
        out: &mut [f64],
    ) -> Outcome {
        if quantity.is_slope() {
            self.expect_differentiated()?;
        }
        let wanted = quantity.size(self.structure(), N, R);
        self.expect_length(out.len(), wanted, "this")?;
        let state = self.point(at)?;
        if quantity.is_slope() {
            out.fill(0.0);
            self.slopes(quantity, &state, out)?;
        }
        match evaluate(&self.driven, &mut self.inquiry, quantity, &state, out) {
            Ok(()) if self.driven.take_failed().is_some() => self.refuse(
                Status::Callback,
                &format_args!("at t = {} s the function of an input failed", state.t),
            ),
            Ok(()) if out.iter().any(|value| !value.is_finite()) => {
                self.failed_at = Some(state.t);
                self.refuse(
                    Status::Run,
                    &format_args!("at t = {} s the result is infinite or NaN", state.t),
                )
            }
            Ok(()) => Ok(()),
            Err(error) => Err(self.fault(&SimulateError::Observe(error))),
        }
    }

    /// A state to evaluate at; where the mechanism is if none is given.
    fn point(&mut self, at: Option<State<f64, N>>) -> Outcome<State<f64, N>> {
        match at {
            Some(state) if !state.is_finite() => {
                let reason = "the state to evaluate at is infinite or NaN";
                self.refuse(Status::NotFinite, &reason)
            }
            Some(state) => Ok(state),
            None => self.state(),
        }
    }

    /// Draws the mechanism, as many numbers as there is room for; how many there are.
    ///
    /// # Errors
    ///
    /// [`Status::NotFinite`], [`Status::Order`].
    pub fn draw(&mut self, at: Option<State<f64, N>>, out: &mut [f64]) -> Outcome<usize> {
        let state = self.point(at)?;
        let mut picture = Picture::new(out);
        self.driven.draw(&state, &mut picture);
        Ok(picture.length())
    }

    /// Brings a state near the constraints onto them.
    ///
    /// # Errors
    ///
    /// [`Status::NotFinite`], [`Status::Run`].
    pub fn project(&mut self, mut state: State<f64, N>) -> Outcome<State<f64, N>> {
        if !state.is_finite() {
            let reason = "the state to project is infinite or NaN";
            return self.refuse(Status::NotFinite, &reason);
        }
        match self.inquiry.on(&self.driven).project(&mut state) {
            Ok(()) => Ok(state),
            Err(error) => Err(self.fault(&SimulateError::Observe(error))),
        }
    }
}
