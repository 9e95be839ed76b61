//! How a method gets from a state to the next accepted one: with steps of fixed length, or with
//! one that follows a tolerance.
//!
//! In:  a [`Trial`]: a method that makes trial steps and tells their error.
//! Out: accepted steps.
//!
//! With adaptive steps, a trial step whose error is too large, whose error can't
//! be told (NaN), or on whose way the mechanics failed, is tried again with a
//! shorter one, until the step is lost in the round-off of time. A singular
//! position that the form of the equations can't pass is reported at once: no
//! step is short enough.

use super::IntegrateError;
use super::control::{Control, Tolerance, check_bound};
use super::step::Step;
use super::tableau::Tableau;
use crate::system::escalating;
use crate::{DynamicsError, Real, State, Switching, System};
use nalgebra::SVector;

/// The first step should change the derivative by this fraction (Hairer's guess).
const FIRST_STEP: f64 = 0.01;
/// First step where the state or its derivative is nearly zero (s).
const TINY_STEP: f64 = 1e-6;

/// What is kept of the inside of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Inside {
    /// Nothing: [`Step::at`] is not called.
    Nothing,
    /// The Hermite polynomials through both ends, which cost nothing.
    Hermite,
    /// The method's own interpolant, extra stages included.
    Full,
}

/// A method that makes trial steps.
pub(super) trait Trial<T: Real, const N: usize> {
    /// Its coefficients.
    fn tableau(&self) -> &'static Tableau;

    /// The step that is being made.
    fn step(&mut self) -> &mut Step<T, N>;

    /// Chooses what is kept of the inside of steps.
    fn keep(&mut self, inside: Inside);

    /// Forgets the derivative at the end of the last step.
    fn forget(&mut self);

    /// Makes `state` the start of the next step and gives the acceleration
    /// there, evaluated unless the last step ended in this very state.
    fn begin<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>>;

    /// Makes a trial step to the time `end`, whose end is projected.
    fn attempt<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        end: T,
    ) -> Result<(), IntegrateError<T>>;

    /// The error of the trial step in units of the tolerance.
    fn error(&self, tolerance: &Tolerance<T, N>) -> T;

    /// Completes an accepted step: the derivative at its end, and so much of its inside.
    fn accept<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        inside: Inside,
    ) -> Result<(), DynamicsError<T>>;

    /// What is kept of the inside of steps.
    fn kept(&self) -> Inside;
}

/// What decides how long a step is.
#[derive(Clone, Debug)]
struct Adaptive<T, const N: usize> {
    tolerance: Tolerance<T, N>,
    control: Control<T>,
}

/// A method and its step control: fixed steps without an [`Adaptive`].
#[derive(Clone, Debug)]
pub(super) struct Controlled<K, T, const N: usize> {
    pub(super) method: K,
    adaptive: Option<Adaptive<T, N>>,
}

impl<K: Trial<T, N>, T: Real, const N: usize> Controlled<K, T, N> {
    /// Goes to each bound at once.
    pub(super) fn fixed(method: K) -> Self {
        Self {
            method,
            adaptive: None,
        }
    }

    /// Goes as far as the tolerance allows.
    pub(super) fn adaptive(method: K, tolerance: Tolerance<T, N>) -> Self {
        let tableau = method.tableau();
        let control = Control::new(tableau.error_order, tableau.gains, tableau.jumps);
        Self {
            method,
            adaptive: Some(Adaptive { tolerance, control }),
        }
    }

    /// Makes one accepted step.
    pub(super) fn step<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
        bound: T,
    ) -> Result<&Step<T, N>, IntegrateError<T>> {
        check_bound(state.t, bound)?;
        let switches = system.begin(state);
        let inside = match switches {
            true => Inside::Full,
            false => self.method.kept(),
        };
        let mut acceleration = self.begin(system, state)?;
        let mut bound = bound;
        loop {
            self.advance(system, &acceleration, bound, inside)?;
            match system.switch(self.method.step())? {
                Switching::Nowhere => break,
                Switching::AtEnd => {
                    self.method.forget();
                    break;
                }
                Switching::Within(t) => bound = t,
                Switching::AtStart => {
                    self.method.forget();
                    acceleration = self.begin(system, state)?;
                }
            }
            self.method.step().rejected += 1;
        }
        let step = self.method.step();
        system.commit(step)?;
        Ok(step)
    }

    /// The acceleration at the start of a step.
    fn begin<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, IntegrateError<T>> {
        Ok(escalating(system, |system| {
            self.method.begin(system, state)
        })?)
    }

    /// Makes attempts at a step until one is accepted.
    fn advance<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        acceleration: &SVector<T, N>,
        bound: T,
        inside: Inside,
    ) -> Result<(), IntegrateError<T>> {
        match &mut self.adaptive {
            None => in_parts(self.method.step().start.t, bound, |end| {
                attempt(&mut self.method, system, end)?;
                if !complete(&mut self.method, system, inside)? {
                    attempt(&mut self.method, system, end)?;
                    complete(&mut self.method, system, inside)?;
                }
                Ok::<_, IntegrateError<T>>(())
            }),
            Some(adaptive) => {
                adaptive.advance(&mut self.method, system, acceleration, (bound, inside))
            }
        }
    }
}

/// Parts of a fixed step, each half as long as the one before, that are tried.
const PARTS: usize = 8;

/// Makes a step of fixed length, or a shorter part of it where the motion next to a
/// singular configuration can't be followed so far at once.
pub(super) fn in_parts<T: Real, V, E: Copy + Into<IntegrateError<T>>>(
    t: T,
    bound: T,
    mut step: impl FnMut(T) -> Result<V, E>,
) -> Result<V, IntegrateError<T>> {
    let mut end = bound;
    let mut first = None;
    for _ in 0..PARTS {
        let failure: IntegrateError<T> = match step(end) {
            Ok(made) => return Ok(made),
            Err(failure) => *first.get_or_insert(failure.into()),
        };
        let shorter = t + (end - t) * T::from_f64(0.5);
        let helps = matches!(
            failure,
            IntegrateError::Dynamics(DynamicsError::SingularConfiguration { .. })
        );
        if !helps || shorter <= t {
            break;
        }
        end = shorter;
    }
    Err(first.unwrap_or(IntegrateError::BadBound { t, bound }))
}

/// Makes a trial step and has it verified; once more from its start if the system wants
/// to look at it more closely.
fn attempt<K: Trial<T, N>, T: Real, Y: System<T, N> + ?Sized, const N: usize>(
    method: &mut K,
    system: &mut Y,
    end: T,
) -> Result<(), IntegrateError<T>> {
    escalating(system, |system| {
        system.begin(&method.step().start);
        method.attempt(system, end)
    })
}

/// Completes a trial step that is about to be accepted and has it verified; `false` if it
/// is to be made once more from its start.
fn complete<K: Trial<T, N>, T: Real, Y: System<T, N> + ?Sized, const N: usize>(
    method: &mut K,
    system: &mut Y,
    inside: Inside,
) -> Result<bool, IntegrateError<T>> {
    let mut once = || {
        method.accept(system, inside)?;
        let Step { start, end, .. } = *method.step();
        system.verify(&start, &end)
    };
    match once() {
        Ok(()) => Ok(true),
        Err(error) => match system.escalate()? {
            true => Ok(false),
            false => Err(error.into()),
        },
    }
}

impl<T: Real, const N: usize> Adaptive<T, N> {
    /// Makes trial steps until one is accepted.
    fn advance<K: Trial<T, N>, Y: System<T, N> + ?Sized>(
        &mut self,
        method: &mut K,
        system: &mut Y,
        acceleration: &SVector<T, N>,
        (bound, inside): (T, Inside),
    ) -> Result<(), IntegrateError<T>> {
        let t = method.step().start.t;
        if self.control.h <= T::zero() {
            self.control.h = self.first_step(method, system, acceleration, bound);
        }
        // What stood in the way of the last trial, to be reported if no step is
        // short enough to avoid it.
        let mut obstacle = None;
        loop {
            let end = match self.control.end(t, bound) {
                Ok(end) => end,
                Err(underflow) => return Err(obstacle.unwrap_or(underflow)),
            };
            let error = match self.trial(method, system, (end, inside)) {
                Ok(Some(error)) => error,
                Ok(None) => continue,
                Err(failure) if is_final(&failure) => return Err(failure),
                Err(failure) => {
                    obstacle = Some(failure);
                    T::from_f64(f64::NAN)
                }
            };
            if self.control.judge(end - t, error) {
                return Ok(());
            }
            if error.is_finite() {
                obstacle = None;
            } else if obstacle.is_none() {
                obstacle = Some(IntegrateError::NotFinite { t });
            }
            method.step().rejected += 1;
        }
    }

    /// One trial step and its error; none if it is to be made once more.
    fn trial<K: Trial<T, N>, Y: System<T, N> + ?Sized>(
        &self,
        method: &mut K,
        system: &mut Y,
        (end, inside): (T, Inside),
    ) -> Result<Option<T>, IntegrateError<T>> {
        attempt(method, system, end)?;
        let error = method.error(&self.tolerance);
        if error <= T::one() && !complete(method, system, inside)? {
            return Ok(None);
        }
        Ok(Some(error))
    }

    /// Hairer's guess of the first step: the derivative and an explicit Euler step
    /// tell how fast things change (II.4, "Starting Step Size").
    fn first_step<K: Trial<T, N>, Y: System<T, N> + ?Sized>(
        &self,
        method: &mut K,
        system: &mut Y,
        a: &SVector<T, N>,
        bound: T,
    ) -> T {
        let start = method.step().start;
        let span = bound - start.t;
        let size = self.tolerance.norm((&start.q, &start.v), &start, &start);
        let rate = self.tolerance.norm((&start.v, a), &start, &start);
        let tiny = T::from_f64(TINY_STEP);
        let small = T::from_f64(1e-5);
        let guess = if size < small || rate < small {
            tiny
        } else {
            T::from_f64(FIRST_STEP) * size / rate
        };
        let guess = if guess < span { guess } else { span };
        let curvature = self.curvature(method, system, a, guess);
        let change = rate.max(curvature);
        let better = if change.is_finite() && change > T::from_f64(1e-15) {
            let order = f64::from(method.tableau().order);
            (T::from_f64(FIRST_STEP) / change).powf(T::from_f64(1.0 / order))
        } else {
            tiny.max(guess * T::from_f64(1e-3))
        };
        (guess * T::from_f64(100.0)).min(better).min(span)
    }

    /// How fast the derivative changes over an Euler step of length `h`; infinite
    /// where the mechanics fail on the way.
    fn curvature<K: Trial<T, N>, Y: System<T, N> + ?Sized>(
        &self,
        method: &mut K,
        system: &mut Y,
        a: &SVector<T, N>,
        h: T,
    ) -> T {
        let start = method.step().start;
        method.step().evaluations += 1;
        let state = State {
            t: start.t + h,
            q: start.q + start.v * h,
            v: start.v + a * h,
        };
        match system.acceleration(&state) {
            Ok(end) => {
                let change = (state.v - start.v, end - a);
                self.tolerance.norm((&change.0, &change.1), &start, &start) / h
            }
            Err(_) => T::from_f64(f64::INFINITY),
        }
    }
}

/// Whether a shorter step can't help.
fn is_final<T>(failure: &IntegrateError<T>) -> bool {
    matches!(
        failure,
        IntegrateError::Dynamics(DynamicsError::SingularPosition { .. })
    )
}
