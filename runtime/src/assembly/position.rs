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
use super::room::Room;
use super::scales::{Scales, disturbed};
use super::vanishing::vanishing_row;
use crate::linalg::Breakdown;
use crate::tolerance::negligible;
use crate::{Mechanism, Position, Real, State};
use core::ops::Range;
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
pub(super) fn assemble<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    state: &mut State<T, N>,
    Room { at, matrix }: &mut Room<T, N, R>,
    held: &[bool; N],
) -> Result<(), AssemblyError<T, N, R>> {
    let guess = state.q;
    let mut measured = Scales::measure(mechanism, state, at);
    measured.leave_out_velocities(mechanism.structure().constraints);
    let mut scales = measured.clone();
    scales.hold(held);
    let mut best: Option<(T, State<T, N>)> = None;
    for disturbance in DISTURBANCES {
        let distance = SVector::from_fn(|i, _| match held[i] {
            true => T::zero(),
            false => scales.sizes[i] * T::from_f64(disturbance),
        });
        state.q = disturbed(&guess, &distance);
        let mut descent = Descent::new(mechanism, state, (at, matrix), &scales)?;
        descent.run()?;
        let (merit, reached) = (descent.merit, descent.state);
        *state = reached;
        if is_satisfied(&descent.residual, &scales) {
            return check_gradients(mechanism, state, at, &measured);
        }
        if best.as_ref().is_none_or(|(least, _)| merit < *least) {
            best = Some((merit, reached));
        }
    }
    match best {
        Some((_, closest)) => {
            mechanism.position(&closest, at);
            Err(contradiction(mechanism, at, &measured, held))
        }
        None => Ok(()),
    }
}

/// One descent of the constraint error.
struct Descent<'a, T, const N: usize, const R: usize> {
    mechanism: &'a dyn Mechanism<T, N, R>,
    scales: &'a Scales<T, N, R>,
    /// Where the descent is.
    state: State<T, N>,
    /// The constraint errors there.
    residual: SVector<T, R>,
    /// Sum of the squares of the scaled constraint errors.
    merit: T,
    damping: T,
    /// What the mechanism was evaluated into last, here or at a trial.
    at: &'a mut Position<T, N, R>,
    matrix: &'a mut Decomposition<T, N, R>,
}

impl<'a, T: Real, const N: usize, const R: usize> Descent<'a, T, N, R> {
    fn new(
        mechanism: &'a dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        (at, matrix): (&'a mut Position<T, N, R>, &'a mut Decomposition<T, N, R>),
        scales: &'a Scales<T, N, R>,
    ) -> Result<Self, AssemblyError<T, N, R>> {
        mechanism.position(state, at);
        let merit = merit(at, scales);
        if !merit.is_finite() {
            return Err(AssemblyError::NotFinite { t: state.t });
        }
        Ok(Self {
            mechanism,
            scales,
            state: *state,
            residual: at.residual,
            merit,
            damping: T::zero(),
            at,
            matrix,
        })
    }

    /// Descends until nothing improves.
    fn run(&mut self) -> Result<(), AssemblyError<T, N, R>> {
        let mut trials = 0..MOST_TRIALS;
        while self.merit > T::zero() && self.advances(&mut trials)? {}
        Ok(())
    }

    /// Goes one step, the first that improves among those of rising damping; whether there
    /// was one.
    fn advances(&mut self, trials: &mut Range<usize>) -> Result<bool, AssemblyError<T, N, R>> {
        let failure = AssemblyError::NotFinite { t: self.state.t };
        let decomposed = self.matrix.decompose(&self.at.jacobian, self.scales);
        decomposed.map_err(|Breakdown| failure)?;
        let target = -self.residual.component_mul(&self.scales.rows);
        while self.damping <= T::from_f64(MOST_DAMPING) && trials.next().is_some() {
            self.matrix.damp(self.damping);
            let (step, fall) = self.matrix.solve(&target, negligible());
            let step = step.component_mul(&self.scales.columns);
            if self.improves(&step, fall) {
                return Ok(true);
            }
            if self.damping == T::zero() && is_satisfied(&self.residual, self.scales) {
                return Ok(false);
            }
            self.damping = (self.damping * T::from_f64(DAMPING_FACTOR)).max(least_damping());
        }
        Ok(false)
    }

    /// Tries a step that promises to reduce the merit by `fall`, and goes there
    /// if the promise is kept.
    fn improves(&mut self, step: &SVector<T, N>, fall: T) -> bool {
        let from = self.merit;
        let mut trial = self.state;
        trial.q += step;
        let mut to = self.merit_at(&trial);
        if !(to < from && from - to >= fall * T::from_f64(KEPT_PROMISE)) {
            return false;
        }
        let left = (to / from).sqrt().to_f64();
        if left > DOUBLE_ROOT.0 && left < DOUBLE_ROOT.1 {
            let mut twice = trial;
            twice.q += step;
            let beyond = self.merit_at(&twice);
            if beyond < to {
                (trial, to) = (twice, beyond);
            } else {
                self.merit_at(&trial);
            }
        }
        (self.state, self.merit) = (trial, to);
        self.residual = self.at.residual;
        self.damping /= T::from_f64(DAMPING_FACTOR);
        if self.damping < least_damping() {
            self.damping = T::zero();
        }
        true
    }

    /// The merit at another state, which the mechanism is evaluated at.
    fn merit_at(&mut self, state: &State<T, N>) -> T {
        self.mechanism.position(state, self.at);
        merit(self.at, self.scales)
    }
}

/// Refuses a constraint that lost its gradient on the way and can't be crossed here.
fn check_gradients<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    state: &State<T, N>,
    at: &mut Position<T, N, R>,
    measured: &Scales<T, N, R>,
) -> Result<(), AssemblyError<T, N, R>> {
    let round_off = T::EPSILON * T::from_f64(CONTRADICTION);
    mechanism.position(state, at);
    match vanishing_row(mechanism, state, at, measured, round_off) {
        Some(row) => Err(AssemblyError::Vanishing {
            structure: mechanism.structure(),
            row,
        }),
        None => Ok(()),
    }
}

/// Whether every constraint error is down to round-off.
fn is_satisfied<T: Real, const N: usize, const R: usize>(
    residual: &SVector<T, R>,
    scales: &Scales<T, N, R>,
) -> bool {
    let left = contradictions(residual, scales);
    left.iter().all(|x| *x == T::zero())
}

/// Constraint errors that are more than round-off; zero for the others.
fn contradictions<T: Real, const N: usize, const R: usize>(
    residual: &SVector<T, R>,
    scales: &Scales<T, N, R>,
) -> SVector<T, R> {
    let round_off = T::EPSILON * T::from_f64(CONTRADICTION);
    residual.zip_map(&scales.reach, |error, reach| {
        if error.abs() <= round_off * reach {
            T::zero()
        } else {
            error
        }
    })
}

/// The error that tells which constraints and which held values contradict.
fn contradiction<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    at: &Position<T, N, R>,
    measured: &Scales<T, N, R>,
    held: &[bool; N],
) -> AssemblyError<T, N, R> {
    let residual = contradictions(&at.residual, measured);
    let conflicting = measured.influential(&at.jacobian, &residual, held);
    AssemblyError::Positions {
        structure: mechanism.structure(),
        residual,
        conflicting,
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
