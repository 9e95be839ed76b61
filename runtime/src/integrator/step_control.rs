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
//! step is short enough. One whose kind can't be determined ends the run as soon as steps only
//! creep up to it.

use super::IntegrateError;
use super::control::{Control, Tolerance, check_bound};
use super::step::Step;
use super::tableau::Tableau;
use crate::stack::with_room;
use crate::system::escalating;
use crate::{DynamicsError, Real, Singularity, State, Switching, System};
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

/// A method that makes trial steps with a system.
pub(crate) trait Trial<T: Real, const N: usize, Y: System<T, N> + ?Sized> {
    /// The acceleration at the start of the next step, known already if that `goes_on`
    /// where the last one ended.
    fn begin(
        &mut self,
        system: &mut Y,
        step: &mut Step<T, N>,
        goes_on: bool,
    ) -> Result<SVector<T, N>, DynamicsError<T>>;

    /// Makes a trial step to the time `end`, whose end is projected.
    fn attempt(
        &mut self,
        system: &mut Y,
        step: &mut Step<T, N>,
        end: T,
    ) -> Result<(), IntegrateError<T>>;

    /// The error of the trial step in units of the tolerance.
    fn error(&self, step: &Step<T, N>, tolerance: &Tolerance<T, N>) -> T;

    /// Completes an accepted step: the derivative at its end, and so much of its inside.
    fn accept(
        &mut self,
        system: &mut Y,
        step: &mut Step<T, N>,
        inside: Inside,
    ) -> Result<(), DynamicsError<T>>;
}

/// What decides how long a step is.
#[derive(Clone, Debug)]
struct Adaptive<T, const N: usize> {
    tolerance: Tolerance<T, N>,
    control: Control<T>,
    /// Order of the method.
    order: u8,
}

/// A method and its step control.
#[derive(Clone, Debug)]
pub(crate) struct Controlled<K, T, const N: usize> {
    method: K,
    steps: Steps<T, N>,
}

/// The steps of a method, whichever it is: fixed without an [`Adaptive`].
#[derive(Clone, Debug)]
struct Steps<T, const N: usize> {
    /// The step that is being made.
    step: Step<T, N>,
    adaptive: Option<Adaptive<T, N>>,
    /// What is kept of the inside of steps.
    inside: Inside,
    /// Whether what the method knows of the last step's end is still true.
    fresh: bool,
}

impl<K, T: Real, const N: usize> Controlled<K, T, N> {
    /// Steps that follow a tolerance, or go to each bound at once.
    pub(super) fn new(method: K, tableau: &Tableau, tolerance: Option<Tolerance<T, N>>) -> Self {
        let adaptive = tolerance.map(|tolerance| Adaptive {
            tolerance,
            control: Control::new(tableau.error_order, tableau.gains, tableau.jumps),
            order: tableau.order,
        });
        let steps = Steps {
            step: Step::new(),
            adaptive,
            inside: Inside::Full,
            fresh: false,
        };
        Self { method, steps }
    }

    /// Forgets what is known of the last step's end.
    pub(crate) fn forget(&mut self) {
        self.steps.fresh = false;
    }

    /// Chooses what is kept of the inside of steps.
    pub(crate) fn keep(&mut self, inside: Inside) {
        self.steps.inside = inside;
    }

    /// Makes one accepted step.
    pub(crate) fn step<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
        bound: T,
    ) -> Result<&Step<T, N>, IntegrateError<T>>
    where
        K: Trial<T, N, Y>,
    {
        // Whichever method it is, the control exists once.
        let made =
            with_room::<T, _, N, N>(|| self.steps.make(&mut self.method, system, state, bound));
        match made {
            Ok(()) => Ok(&self.steps.step),
            Err(failure) => {
                self.steps.restart();
                Err(failure)
            }
        }
    }
}

impl<T: Real, const N: usize> Steps<T, N> {
    /// Makes one accepted step.
    fn make<Y: System<T, N> + ?Sized>(
        &mut self,
        method: &mut dyn Trial<T, N, Y>,
        system: &mut Y,
        state: &State<T, N>,
        bound: T,
    ) -> Result<(), IntegrateError<T>> {
        check_bound(state.t, bound)?;
        let inside = match system.begin(state) {
            true => Inside::Full,
            false => self.inside,
        };
        let mut acceleration = self.begin(method, system, state)?;
        let mut bound = bound;
        loop {
            self.advance(method, system, &acceleration, (bound, inside))?;
            match system.switch(&mut self.step)? {
                Switching::Nowhere => break,
                Switching::AtEnd => {
                    self.fresh = false;
                    break;
                }
                Switching::Within(t) => bound = t,
                Switching::AtStart => {
                    self.fresh = false;
                    acceleration = self.begin(method, system, state)?;
                }
            }
            self.step.rejected += 1;
        }
        system.commit(&self.step)?;
        Ok(())
    }

    /// Begins anew after a step that failed.
    #[cold]
    fn restart(&mut self) {
        self.fresh = false;
        if let Some(adaptive) = &mut self.adaptive {
            adaptive.control.restart();
        }
    }

    /// The acceleration at the start of a step.
    fn begin<Y: System<T, N> + ?Sized>(
        &mut self,
        method: &mut dyn Trial<T, N, Y>,
        system: &mut Y,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, IntegrateError<T>> {
        let step = &mut self.step;
        let goes_on = self.fresh && step.end == *state;
        (step.rejected, step.evaluations) = (0, 0);
        step.start = *state;
        let acceleration = escalating(system, |system| method.begin(system, step, goes_on))?;
        self.fresh = true;
        Ok(acceleration)
    }

    /// Makes attempts at a step until one is accepted.
    fn advance<Y: System<T, N> + ?Sized>(
        &mut self,
        method: &mut dyn Trial<T, N, Y>,
        system: &mut Y,
        acceleration: &SVector<T, N>,
        (bound, inside): (T, Inside),
    ) -> Result<(), IntegrateError<T>> {
        let step = &mut self.step;
        let Some(adaptive) = &mut self.adaptive else {
            return in_parts(step.start.t, bound, |end| {
                attempt(method, system, step, end)?;
                while !complete(method, system, step, inside)? {
                    attempt(method, system, step, end)?;
                }
                Ok::<_, IntegrateError<T>>(())
            });
        };
        let t = step.start.t;
        if adaptive.control.is_unknown(t, bound) {
            adaptive.control.h = adaptive.first_step(system, step, acceleration, bound);
        }
        // What stood in the way of the last trial, to be reported if no step is
        // short enough to avoid it.
        let mut obstacle = None;
        loop {
            let end = match adaptive.control.end(t, bound) {
                Ok(end) => end,
                Err(underflow) => return Err(obstacle.unwrap_or(underflow)),
            };
            let error = match adaptive.trial(method, system, step, (end, inside)) {
                Ok(Some(error)) => error,
                Ok(None) => continue,
                Err(failure) if is_final(&failure, &adaptive.control, end - t) => {
                    return Err(failure);
                }
                Err(failure) => {
                    obstacle = Some(failure);
                    T::from_f64(f64::NAN)
                }
            };
            if adaptive.control.judge(end - t, error) {
                return Ok(());
            }
            if error.is_finite() {
                obstacle = None;
            } else if obstacle.is_none() {
                obstacle = Some(IntegrateError::NotFinite { t });
            }
            step.rejected += 1;
        }
    }
}

/// Parts of a fixed step, each half as long as the one before, that are tried.
const PARTS: usize = 8;

/// Makes a step of fixed length, or a shorter part of it where the motion next to a
/// singular configuration can't be followed so far at once, or the equations of an implicit step
/// can't be solved.
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
                | IntegrateError::NewtonDiverged { .. }
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
fn attempt<T: Real, Y: System<T, N> + ?Sized, const N: usize>(
    method: &mut dyn Trial<T, N, Y>,
    system: &mut Y,
    step: &mut Step<T, N>,
    end: T,
) -> Result<(), IntegrateError<T>> {
    escalating(system, |system| {
        system.begin(&step.start);
        method.attempt(system, step, end)
    })
}

/// Completes a trial step that is about to be accepted and has it verified; `false` if it
/// is to be made once more from its start.
fn complete<T: Real, Y: System<T, N> + ?Sized, const N: usize>(
    method: &mut dyn Trial<T, N, Y>,
    system: &mut Y,
    step: &mut Step<T, N>,
    inside: Inside,
) -> Result<bool, IntegrateError<T>> {
    let made = method.accept(system, step, inside);
    let verified = made.and_then(|()| system.verify(&step.start, &step.end));
    match verified {
        Ok(()) => Ok(true),
        Err(error) => match system.escalate()? {
            true => Ok(false),
            false => Err(error.into()),
        },
    }
}

impl<T: Real, const N: usize> Adaptive<T, N> {
    /// One trial step and its error; none if it is to be made once more.
    fn trial<Y: System<T, N> + ?Sized>(
        &self,
        method: &mut dyn Trial<T, N, Y>,
        system: &mut Y,
        step: &mut Step<T, N>,
        (end, inside): (T, Inside),
    ) -> Result<Option<T>, IntegrateError<T>> {
        attempt(method, system, step, end)?;
        let error = method.error(step, &self.tolerance);
        if error <= T::one() && !complete(method, system, step, inside)? {
            return Ok(None);
        }
        Ok(Some(error))
    }

    /// Hairer's guess of the first step: the derivative and an explicit Euler step
    /// tell how fast things change (II.4, "Starting Step Size").
    #[inline(never)]
    fn first_step<Y: System<T, N> + ?Sized>(
        &self,
        system: &mut Y,
        step: &mut Step<T, N>,
        a: &SVector<T, N>,
        bound: T,
    ) -> T {
        let start = step.start;
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
        step.evaluations += 1;
        let curvature = self.curvature(system, &start, a, guess);
        let change = rate.max(curvature);
        let better = if change.is_finite() && change > T::from_f64(1e-15) {
            let order = f64::from(self.order);
            (T::from_f64(FIRST_STEP) / change).powf(T::from_f64(1.0 / order))
        } else {
            tiny.max(guess * T::from_f64(1e-3))
        };
        (guess * T::from_f64(100.0)).min(better).min(span)
    }

    /// How fast the derivative changes over an Euler step of length `h`; infinite
    /// where the mechanics fail on the way.
    fn curvature<Y: System<T, N> + ?Sized>(
        &self,
        system: &mut Y,
        start: &State<T, N>,
        a: &SVector<T, N>,
        h: T,
    ) -> T {
        let state = State {
            t: start.t + h,
            q: start.q + start.v * h,
            v: start.v + a * h,
        };
        match system.acceleration(&state) {
            Ok(end) => {
                let change = (state.v - start.v, end - a);
                self.tolerance.norm((&change.0, &change.1), start, start) / h
            }
            Err(_) => T::from_f64(f64::INFINITY),
        }
    }
}

/// Whether a shorter step can't help.
fn is_final<T: Real>(failure: &IntegrateError<T>, control: &Control<T>, h: T) -> bool {
    match failure {
        IntegrateError::Dynamics(DynamicsError::SingularPosition { .. }) => true,
        IntegrateError::Dynamics(DynamicsError::SingularConfiguration { kind, .. }) => match kind {
            Singularity::Kink => control.is_short(h),
            _ => control.creeps(h),
        },
        _ => false,
    }
}
