//! Positions that satisfy the constraints.
//!
//! In:  a guess, which coordinates are held.
//! Out: the coordinates, to round-off.
//!
//! Newton's method with the step of least change, damped as Levenberg and
//! Marquardt do wherever the linear model promises more than it keeps.
//! Source: Moré, Lecture Notes in Mathematics 630 (1978) 105–116.

use super::AssemblyError;
use super::decomposition::Decomposition;
use super::scales::{Scales, disturbed};
use super::vanishing::vanishing_row;
use crate::tolerance::negligible;
use crate::{Mechanism, Position, Real, State};
use nalgebra::SVector;

/// Constraint errors up to this multiple of the round-off of an equation's terms
/// are no contradiction. The iteration doesn't stop here: it ends where nothing
/// improves.
const CONTRADICTION: f64 = 4096.0;
/// Trial steps of one descent.
const MOST_TRIALS: usize = 300;
/// Damping at which steps are too short to change anything.
const MOST_DAMPING: f64 = 1e14;
/// How fast damping comes and goes.
const DAMPING_FACTOR: f64 = 8.0;
/// The part of the promised improvement that a step must keep.
const KEPT_PROMISE: f64 = 0.1;
/// At a double root Newton's step goes half the way and leaves a quarter of the
/// error; between these bounds twice the step is tried.
const DOUBLE_ROOT: (f64, f64) = (0.1, 0.4);
/// Disturbances of the guess, in sizes of the coordinates, tried in turn where
/// the guess itself leads nowhere.
const DISTURBANCES: [f64; 5] = [0.0, 1e-3, 1e-2, 0.1, 1.0];
/// Moves the coordinates that are not held onto the constraints.
pub(super) fn assemble<T, M, const N: usize, const R: usize>(
    mechanism: &M,
    state: &mut State<T, N>,
    held: &[bool; N],
) -> Result<(), AssemblyError<T, N, R>>
where
    T: Real,
    M: Mechanism<T, N, R> + ?Sized,
{
    let guess = state.q;
    let mut measured = Scales::measure(mechanism, state);
    measured.leave_out_velocities(mechanism.structure().constraints);
    let mut scales = measured.clone();
    scales.hold(held);
    let mut best: Option<Descent<'_, T, N, R>> = None;
    for disturbance in DISTURBANCES {
        let distance = SVector::from_fn(|i, _| match held[i] {
            true => T::zero(),
            false => scales.sizes[i] * T::from_f64(disturbance),
        });
        state.q = disturbed(&guess, &distance);
        let mut descent = Descent::new(mechanism, state, &scales)?;
        descent.run(mechanism, state)?;
        if descent.is_satisfied() {
            return match descent.vanishing_row(mechanism, state, &measured) {
                Some(row) => Err(AssemblyError::Vanishing {
                    structure: mechanism.structure(),
                    row,
                }),
                None => Ok(()),
            };
        }
        if best.as_ref().is_none_or(|best| descent.merit < best.merit) {
            best = Some(descent);
        }
    }
    match best {
        Some(descent) => Err(descent.report(mechanism, &measured, held)),
        None => Ok(()),
    }
}

/// One descent of the constraint error.
struct Descent<'a, T, const N: usize, const R: usize> {
    scales: &'a Scales<T, N, R>,
    at: Position<T, N, R>,
    /// Sum of the squares of the scaled constraint errors.
    merit: T,
    damping: T,
}

impl<'a, T: Real, const N: usize, const R: usize> Descent<'a, T, N, R> {
    fn new<M: Mechanism<T, N, R> + ?Sized>(
        mechanism: &M,
        state: &State<T, N>,
        scales: &'a Scales<T, N, R>,
    ) -> Result<Self, AssemblyError<T, N, R>> {
        let mut at = Position::default();
        mechanism.position(state, &mut at);
        let merit = merit(&at, scales);
        if !merit.is_finite() {
            return Err(AssemblyError::NotFinite { t: state.t });
        }
        Ok(Self {
            scales,
            at,
            merit,
            damping: T::zero(),
        })
    }

    /// Descends until nothing improves.
    fn run<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Result<(), AssemblyError<T, N, R>> {
        let failure = AssemblyError::NotFinite { t: state.t };
        for _ in 0..MOST_TRIALS {
            if self.merit == T::zero() || self.damping > T::from_f64(MOST_DAMPING) {
                break;
            }
            let matrix = Decomposition::new(&self.at.jacobian, self.scales).map_err(|_| failure)?;
            let target = -self.at.residual.component_mul(&self.scales.rows);
            let (step, fall) = matrix.solve(&target, negligible(), self.damping);
            let step = step.component_mul(&self.scales.columns);
            if self.improves(mechanism, state, &step, fall) {
                continue;
            }
            if self.damping == T::zero() && self.is_satisfied() {
                break;
            }
            self.damping = (self.damping * T::from_f64(DAMPING_FACTOR)).max(least_damping());
        }
        Ok(())
    }

    /// Tries a step that promises to reduce the merit by `fall`, and goes there
    /// if the promise is kept.
    fn improves<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
        step: &SVector<T, N>,
        fall: T,
    ) -> bool {
        let from = self.merit;
        let mut trial = *state;
        trial.q += step;
        let to = self.merit_at(mechanism, &trial);
        if !(to < from && from - to >= fall * T::from_f64(KEPT_PROMISE)) {
            return false;
        }
        let left = (to / from).sqrt().to_f64();
        if left > DOUBLE_ROOT.0 && left < DOUBLE_ROOT.1 {
            let mut twice = trial;
            twice.q += step;
            if self.merit_at(mechanism, &twice) < to {
                trial = twice;
            }
        }
        *state = trial;
        mechanism.position(state, &mut self.at);
        self.merit = merit(&self.at, self.scales);
        self.damping /= T::from_f64(DAMPING_FACTOR);
        if self.damping < least_damping() {
            self.damping = T::zero();
        }
        true
    }

    /// The merit at another state.
    fn merit_at<M: Mechanism<T, N, R> + ?Sized>(&self, mechanism: &M, state: &State<T, N>) -> T {
        let mut at = Position::default();
        mechanism.position(state, &mut at);
        merit(&at, self.scales)
    }

    /// Whether every constraint error is down to round-off.
    fn is_satisfied(&self) -> bool {
        self.contradictions().iter().all(|x| *x == T::zero())
    }

    /// A constraint that lost its gradient on the way, and can't be crossed here.
    fn vanishing_row<M: Mechanism<T, N, R> + ?Sized>(
        &self,
        mechanism: &M,
        state: &State<T, N>,
        measured: &Scales<T, N, R>,
    ) -> Option<usize> {
        let round_off = T::EPSILON * T::from_f64(CONTRADICTION);
        vanishing_row(mechanism, state, &self.at.jacobian, measured, round_off)
    }

    /// Constraint errors that are more than round-off; zero for the others.
    fn contradictions(&self) -> SVector<T, R> {
        let round_off = T::EPSILON * T::from_f64(CONTRADICTION);
        self.at
            .residual
            .zip_map(&self.scales.reach, |error, reach| {
                if error.abs() <= round_off * reach {
                    T::zero()
                } else {
                    error
                }
            })
    }

    /// The error that tells which constraints and which held values contradict.
    fn report<M: Mechanism<T, N, R> + ?Sized>(
        &self,
        mechanism: &M,
        measured: &Scales<T, N, R>,
        held: &[bool; N],
    ) -> AssemblyError<T, N, R> {
        let residual = self.contradictions();
        let conflicting = measured.influential(&self.at.jacobian, &residual, held);
        AssemblyError::Positions {
            structure: mechanism.structure(),
            residual,
            conflicting,
        }
    }
}

/// Smallest damping that is worth having, relative to the largest singular value
/// squared: that of the smallest singular value that counts. Between two roots next to
/// each other more would make steps too short ever to reach one.
fn least_damping<T: Real>() -> T {
    negligible::<T>() * negligible()
}

/// Sum of the squares of the scaled constraint errors.
fn merit<T: Real, const N: usize, const R: usize>(
    at: &Position<T, N, R>,
    scales: &Scales<T, N, R>,
) -> T {
    at.residual
        .iter()
        .zip(scales.rows.iter())
        .fold(T::zero(), |sum, (error, scale)| {
            let scaled = *error * *scale;
            sum + scaled * scaled
        })
}
