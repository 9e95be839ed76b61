//! The methods: explicit Runge–Kutta at a fixed pace, or at one that follows a
//! tolerance.
//!
//! In:  nothing, or a [`Tolerance`].
//! Out: [`Rk4`], [`Dp5`], [`Dop853`].
//!
//! At an adaptive pace, a trial step whose error is too large, whose error can't be told (NaN), or on
//! whose way the mechanics failed, is tried again with a shorter one, until the
//! step is lost in the round-off of time. A singular position that the form of
//! the equations can't pass is reported at once: no step is short enough.

use super::control::{Control, Tolerance, check_bound};
use super::explicit::{Explicit, Inside};
use super::step::Step;
use super::tableau::{DOP853, DP5, RK4, Tableau};
use super::{IntegrateError, Integrator};
use crate::{DynamicsError, Real, State, System};

/// Slots of RK4: four stages and the slope at the end.
const SLOTS_RK4: usize = 5;
/// Slots of DP5: six stages and the slope at the end.
const SLOTS_DP5: usize = 7;
/// Slots of DOP853: twelve stages, the slope at the end, three extra stages.
const SLOTS_DOP853: usize = 16;
/// Weight of the third-order estimate in the error of DOP853, which damps the
/// fifth-order one where that is accidentally small.
const THIRD_ORDER_WEIGHT: f64 = 0.01;
/// The first step should change the slope by this fraction (Hairer's guess).
const FIRST_STEP: f64 = 0.01;
/// First step where the state or its slope is nearly zero (s).
const TINY_STEP: f64 = 1e-6;

/// What decides how long a step is.
#[derive(Clone, Debug)]
struct Pace<T, const N: usize> {
    tolerance: Tolerance<T, N>,
    control: Control<T>,
}

/// An explicit method at a pace: fixed without a [`Pace`].
#[derive(Clone, Debug)]
struct Paced<T, const N: usize, const S: usize> {
    method: Explicit<T, N, S>,
    pace: Option<Pace<T, N>>,
}

impl<T: Real, const N: usize, const S: usize> Paced<T, N, S> {
    fn fixed(tableau: &'static Tableau) -> Self {
        Self {
            method: Explicit::new(tableau),
            pace: None,
        }
    }

    fn adaptive(tableau: &'static Tableau, tolerance: Tolerance<T, N>) -> Self {
        let (least, most) = tableau.jumps;
        let control = Control::new(tableau.error_order, least, most);
        Self {
            method: Explicit::new(tableau),
            pace: Some(Pace { tolerance, control }),
        }
    }

    fn step<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
        bound: T,
    ) -> Result<&Step<T, N>, IntegrateError<T>> {
        check_bound(state.t, bound)?;
        self.method.begin(system, state)?;
        match &mut self.pace {
            None => self.method.attempt(system, bound)?,
            Some(pace) => pace.advance(&mut self.method, system, bound)?,
        }
        self.method.accept(system)?;
        Ok(&self.method.step)
    }
}

impl<T: Real, const N: usize> Pace<T, N> {
    /// Makes trial steps until one is accepted.
    fn advance<Y: System<T, N> + ?Sized, const S: usize>(
        &mut self,
        method: &mut Explicit<T, N, S>,
        system: &mut Y,
        bound: T,
    ) -> Result<(), IntegrateError<T>> {
        let t = method.step.start.t;
        if self.control.h <= T::zero() {
            self.control.h = self.first_step(method, system, bound);
        }
        // What stood in the way of the last trial, to be reported if no step is
        // short enough to avoid it.
        let mut obstacle = None;
        loop {
            let end = match self.control.end(t, bound) {
                Ok(end) => end,
                Err(underflow) => return Err(obstacle.unwrap_or(underflow)),
            };
            let error = match method.attempt(system, end) {
                Ok(()) => self.error(method),
                Err(singular @ DynamicsError::SingularPosition { .. }) => {
                    return Err(singular.into());
                }
                Err(failure) => {
                    obstacle = Some(failure.into());
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
            method.step.rejected += 1;
        }
    }

    /// The error of the trial step in units of the tolerance.
    fn error<const S: usize>(&self, method: &Explicit<T, N, S>) -> T {
        let Step { start, end, .. } = &method.step;
        let h = (end.t - start.t).abs();
        let norm = |row: &[_]| {
            let (q, v) = method.combine(row);
            self.tolerance.norm((&q, &v), start, end)
        };
        match method.tableau.errors {
            [fine, coarse] => {
                let (fine, coarse) = (norm(fine), norm(coarse));
                let square = fine * fine + T::from_f64(THIRD_ORDER_WEIGHT) * coarse * coarse;
                if square == T::zero() {
                    square
                } else {
                    h * fine * fine / square.sqrt()
                }
            }
            rows => rows
                .iter()
                .fold(T::zero(), |most, row| most.max(h * norm(row))),
        }
    }

    /// Hairer's guess of the first step: the slope and an explicit Euler step
    /// tell how fast things change (II.4, "Starting Step Size").
    fn first_step<Y: System<T, N> + ?Sized, const S: usize>(
        &self,
        method: &mut Explicit<T, N, S>,
        system: &mut Y,
        bound: T,
    ) -> T {
        let start = method.step.start;
        let span = bound - start.t;
        let (v, a) = method.first_slope();
        let (v, a) = (*v, *a);
        let size = self.tolerance.norm((&start.q, &start.v), &start, &start);
        let slope = self.tolerance.norm((&v, &a), &start, &start);
        let tiny = T::from_f64(TINY_STEP);
        let small = T::from_f64(1e-5);
        let guess = if size < small || slope < small {
            tiny
        } else {
            T::from_f64(FIRST_STEP) * size / slope
        };
        let guess = guess.min(span);
        let curvature = self.curvature(method, system, guess);
        let change = slope.max(curvature);
        let better = if change.is_finite() && change > T::from_f64(1e-15) {
            let order = f64::from(method.tableau.order);
            (T::from_f64(FIRST_STEP) / change).powf(T::from_f64(1.0 / order))
        } else {
            tiny.max(guess * T::from_f64(1e-3))
        };
        (guess * T::from_f64(100.0)).min(better).min(span)
    }

    /// How fast the slope changes over an Euler step of length `h`; infinite
    /// where the mechanics fail on the way.
    fn curvature<Y: System<T, N> + ?Sized, const S: usize>(
        &self,
        method: &mut Explicit<T, N, S>,
        system: &mut Y,
        h: T,
    ) -> T {
        let start = method.step.start;
        method.step.evaluations += 1;
        let (v, a) = method.first_slope();
        let state = State {
            t: start.t + h,
            q: start.q + v * h,
            v: start.v + a * h,
        };
        match system.acceleration(&state) {
            Ok(end) => {
                let change = (state.v - v, end - a);
                self.tolerance.norm((&change.0, &change.1), &start, &start) / h
            }
            Err(_) => T::from_f64(f64::INFINITY),
        }
    }
}

macro_rules! method {
    ($(#[$docs:meta])* $name:ident, $slots:ident) => {
        $(#[$docs])*
        #[derive(Clone, Debug)]
        pub struct $name<T, const N: usize>(Paced<T, N, $slots>);

        impl<T: Real, const N: usize> $name<T, N> {
            /// Forgets the slope at the last step's end, because the system has
            /// changed since; an adaptive pace keeps its step size.
            pub fn forget(&mut self) {
                self.0.method.forget();
            }

            pub(crate) fn keep(&mut self, inside: Inside) {
                self.0.method.inside = inside;
            }
        }

        impl<T: Real, const N: usize> Integrator<T, N> for $name<T, N> {
            fn step<Y: System<T, N> + ?Sized>(
                &mut self,
                system: &mut Y,
                state: &State<T, N>,
                bound: T,
            ) -> Result<&Step<T, N>, IntegrateError<T>> {
                self.0.step(system, state, bound)
            }
        }
    };
}

macro_rules! adaptive {
    ($name:ident, $tableau:ident) => {
        impl<T: Real, const N: usize> $name<T, N> {
            /// The method at a fixed pace: each step goes to its bound at once.
            pub fn fixed() -> Self {
                Self(Paced::fixed(&$tableau))
            }

            /// The method at a pace that follows a tolerance.
            pub fn adaptive(tolerance: Tolerance<T, N>) -> Self {
                Self(Paced::adaptive(&$tableau, tolerance))
            }
        }
    };
}

method!(
    /// The classical Runge–Kutta method of order 4: four accelerations a step.
    ///
    /// Between the ends, the quintic Hermite polynomial for `q` and the cubic one
    /// for `q̇`.
    Rk4, SLOTS_RK4
);
method!(
    /// The pair of orders 5 and 4 of Dormand and Prince: six accelerations a
    /// step, interpolant of order 4.
    Dp5, SLOTS_DP5
);
method!(
    /// The method of order 8 of Dormand and Prince with Hairer's error estimate:
    /// twelve accelerations a step, three more for the interpolant of order 7.
    Dop853, SLOTS_DOP853
);

impl<T: Real, const N: usize> Rk4<T, N> {
    /// The method: each step goes to its bound at once.
    pub fn new() -> Self {
        Self(Paced::fixed(&RK4))
    }
}

impl<T: Real, const N: usize> Default for Rk4<T, N> {
    fn default() -> Self {
        Self::new()
    }
}

adaptive!(Dp5, DP5);
adaptive!(Dop853, DOP853);
