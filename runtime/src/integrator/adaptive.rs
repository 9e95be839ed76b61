//! Runge–Kutta pairs whose steps follow a tolerance.
//!
//! In:  a [`Tolerance`].
//! Out: [`Dp5`], [`Dop853`].
//!
//! A trial step whose error is too large, whose error can't be told (NaN), or on
//! whose way the mechanics failed, is tried again with a shorter one, until the
//! step is lost in the round-off of time. A singular position that the form of
//! the equations can't pass is reported at once: no step is short enough.

use super::control::{Control, Tolerance, check_bound};
use super::explicit::{Explicit, Inside};
use super::step::Step;
use super::tableau::{DOP853, DP5, Tableau};
use super::{IntegrateError, Integrator};
use crate::{DynamicsError, Real, State, System};
use nalgebra::SVector;

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

/// An explicit pair under step-size control.
#[derive(Clone, Debug)]
struct Pair<T, const N: usize, const S: usize> {
    method: Explicit<T, N, S>,
    tolerance: Tolerance<T, N>,
    control: Control<T>,
}

impl<T: Real, const N: usize, const S: usize> Pair<T, N, S> {
    fn new(tableau: &'static Tableau, tolerance: Tolerance<T, N>, jumps: (f64, f64)) -> Self {
        let control = Control::new(tableau.error_order, jumps.0, jumps.1);
        Self {
            method: Explicit::new(tableau),
            tolerance,
            control,
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
        if self.control.h <= T::zero() {
            self.control.h = self.first_step(system, bound);
        }
        // What stood in the way of the last trial, to be reported if no step is
        // short enough to avoid it.
        let mut obstacle = None;
        loop {
            let end = match self.control.end(state.t, bound) {
                Ok(end) => end,
                Err(underflow) => return Err(obstacle.unwrap_or(underflow)),
            };
            let error = match self.method.attempt(system, end) {
                Ok(()) => self.error(),
                Err(singular @ DynamicsError::SingularPosition { .. }) => {
                    return Err(singular.into());
                }
                Err(failure) => {
                    obstacle = Some(failure.into());
                    T::from_f64(f64::NAN)
                }
            };
            if self.control.judge(end - state.t, error) {
                break;
            }
            if error.is_finite() {
                obstacle = None;
            } else if obstacle.is_none() {
                obstacle = Some(IntegrateError::NotFinite { t: state.t });
            }
            self.method.step.rejected += 1;
        }
        self.method.accept(system)?;
        Ok(&self.method.step)
    }

    /// The error of the trial step in units of the tolerance.
    fn error(&self) -> T {
        let Step { start, end, .. } = &self.method.step;
        let h = (end.t - start.t).abs();
        let norm = |row: &[_]| {
            let (q, v) = self.method.combine(row);
            self.tolerance.norm((&q, &v), start, end)
        };
        match self.method.tableau.errors {
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
    fn first_step<Y: System<T, N> + ?Sized>(&mut self, system: &mut Y, bound: T) -> T {
        let start = self.method.step.start;
        let span = bound - start.t;
        let (v, a) = self.method.first_slope();
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
        let curvature = self.curvature(system, guess, (&v, &a));
        let change = slope.max(curvature);
        let better = if change.is_finite() && change > T::from_f64(1e-15) {
            let order = f64::from(self.method.tableau.order);
            (T::from_f64(FIRST_STEP) / change).powf(T::from_f64(1.0 / order))
        } else {
            tiny.max(guess * T::from_f64(1e-3))
        };
        (guess * T::from_f64(100.0)).min(better).min(span)
    }

    /// How fast the slope changes over an Euler step of length `h`; infinite
    /// where the mechanics fail on the way.
    fn curvature<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        h: T,
        slope: (&SVector<T, N>, &SVector<T, N>),
    ) -> T {
        let start = self.method.step.start;
        let state = State {
            t: start.t + h,
            q: start.q + slope.0 * h,
            v: start.v + slope.1 * h,
        };
        self.method.step.evaluations += 1;
        match system.acceleration(&state) {
            Ok(a) => {
                let change = (state.v - slope.0, a - slope.1);
                self.tolerance.norm((&change.0, &change.1), &start, &start) / h
            }
            Err(_) => T::from_f64(f64::INFINITY),
        }
    }
}

macro_rules! pair {
    ($(#[$docs:meta])* $name:ident, $slots:ident, $tableau:ident, $jumps:expr) => {
        $(#[$docs])*
        #[derive(Clone, Debug)]
        pub struct $name<T, const N: usize>(Pair<T, N, $slots>);

        impl<T: Real, const N: usize> $name<T, N> {
            /// The method, ready for its first step.
            pub fn new(tolerance: Tolerance<T, N>) -> Self {
                Self(Pair::new(&$tableau, tolerance, $jumps))
            }

            /// Forgets the slope at the last step's end, because the system has
            /// changed since; the step size is kept.
            pub fn forget(&mut self) {
                self.0.method.forget();
            }

            /// Forgets everything: the next step is a first step.
            pub fn restart(&mut self) {
                self.0.method.forget();
                self.0.control.restart();
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

pair!(
    /// The pair of orders 5 and 4 of Dormand and Prince: six accelerations a
    /// step, interpolant of order 4.
    Dp5, SLOTS_DP5, DP5, (0.2, 10.0)
);
pair!(
    /// The method of order 8 of Dormand and Prince with Hairer's error estimate:
    /// twelve accelerations a step, three more for the interpolant of order 7.
    Dop853, SLOTS_DOP853, DOP853, (1.0 / 3.0, 6.0)
);
