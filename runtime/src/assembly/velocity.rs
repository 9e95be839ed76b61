//! Velocities that satisfy the constraints.
//!
//! In:  a position on the constraints, guesses, which velocities are held.
//! Out: the velocities, to round-off.
//!
//! At a regular position `A q̇ + b = 0` decides. At a singular one some
//! combinations `w` of the rows vanish, and `wᵀ p₂(q, q̇) = 0` remains: without it
//! no acceleration would satisfy the constraints. It is quadratic in `q̇`; its
//! solutions are the velocities along the branches that meet there.

use super::AssemblyError;
use super::decomposition::Decomposition;
use super::room::Room;
use super::scales::Scales;
use crate::linalg::{Breakdown, norm};
use crate::tolerance::regular;
use crate::{Mechanism, Position, Real, State, Terms};
use nalgebra::{SMatrix, SVector};

/// Velocity errors up to this multiple of the round-off of an equation's terms
/// are no contradiction.
const CONTRADICTION: f64 = 4096.0;
/// Newton steps towards a branch.
const MOST_STEPS: usize = 60;
/// The rest of `p₂` that the rows can't produce is accepted below this part of
/// the quadratic terms that it is the sum of.
const ON_BRANCH: f64 = 1e-9;
/// A direction towards a branch counts if it changes that rest by this part of
/// what the most effective one does.
const EFFECTIVE: f64 = 1e-6;

/// Moves the velocities that are not held onto the constraints.
pub(super) fn assemble<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    state: &mut State<T, N>,
    Room { at, matrix }: &mut Room<T, N, R>,
    held: &[bool; N],
) -> Result<(), AssemblyError<T, N, R>> {
    let failure = AssemblyError::NotFinite { t: state.t };
    let broken = |Breakdown| failure;
    let measured = Scales::measure(mechanism, state, at);
    let guessed = speed(&state.v, &measured);
    let scales = Scales::measure_free(mechanism, state, held, at);
    mechanism.position(state, at);
    matrix.decompose(&at.jacobian, &scales).map_err(broken)?;
    correct(state, at, &scales, matrix);
    if !state.is_finite() {
        return Err(failure);
    }
    // The corrections are as good as the velocities are that they begin with, which may be
    // far larger than those that they end with.
    let speed = guessed.max(speed(&state.v, &measured));
    check(mechanism, (state, speed), at, &measured, held)?;
    matrix.decompose(&at.jacobian, &measured).map_err(broken)?;
    if matrix.rank(regular()) == R {
        return Ok(());
    }
    let followed = follow_branch(mechanism, state, (at, matrix), [&measured, &scales]);
    match followed.map_err(broken)? {
        true => Ok(()),
        false => Err(AssemblyError::NoBranch {
            structure: mechanism.structure(),
            held: *held,
        }),
    }
}

/// Moves the free velocities at a singular position to those of the nearest branch, if there
/// is one; with the decomposition of all rows. Apart from what a regular position takes,
/// because its matrices are large.
#[cold]
#[inline(never)]
fn follow_branch<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    state: &mut State<T, N>,
    (at, whole): (&Position<T, N, R>, &Decomposition<T, N, R>),
    [measured, scales]: [&Scales<T, N, R>; 2],
) -> Result<bool, Breakdown> {
    let mut free = Decomposition::default();
    free.decompose(&at.jacobian, scales)?;
    let branches = Branches {
        mechanism,
        measured,
        scales,
        free: &free,
        whole,
    };
    let found = branches.choose(state)?;
    if found {
        correct(state, at, scales, &free);
    }
    Ok(found)
}

/// Moves the free velocities to `A q̇ + b = 0`, as little as they can. Twice: the
/// second correction takes the round-off of the first.
fn correct<T: Real, const N: usize, const R: usize>(
    state: &mut State<T, N>,
    at: &Position<T, N, R>,
    scales: &Scales<T, N, R>,
    free: &Decomposition<T, N, R>,
) {
    for _ in 0..2 {
        let error = opening(at, &state.v).component_mul(&scales.rows);
        let (step, _) = free.solve(&-error, regular());
        state.v += step.component_mul(&scales.columns);
    }
}

/// `A q̇ + b`; `A` is not copied, as `*` does.
fn opening<T: Real, const N: usize, const R: usize>(
    at: &Position<T, N, R>,
    v: &SVector<T, N>,
) -> SVector<T, R> {
    let mut opening = at.drift;
    opening.gemv(T::one(), &at.jacobian, v, T::one());
    opening
}

/// The size of velocities in the kinetic metric, where a row of norm one turns a speed of
/// one into an error of one.
fn speed<T: Real, const N: usize, const R: usize>(
    v: &SVector<T, N>,
    measured: &Scales<T, N, R>,
) -> T {
    let squares = (0..N).fold(T::zero(), |sum, j| {
        let x = v[j] / measured.columns[j];
        sum + x * x
    });
    squares.sqrt()
}

/// Refuses velocities that contradict the constraints. The speed is the largest that took
/// part in finding them.
fn check<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    (state, speed): (&State<T, N>, T),
    at: &Position<T, N, R>,
    measured: &Scales<T, N, R>,
    held: &[bool; N],
) -> Result<(), AssemblyError<T, N, R>> {
    let error = opening(at, &state.v);
    // Rows that count as dependent may be off by what they are.
    let slack = T::EPSILON * T::from_f64(CONTRADICTION) + regular();
    let residual = SVector::<T, R>::from_fn(|k, _| {
        let most = slack * (speed / measured.rows[k] + at.drift[k].abs());
        if error[k].abs() <= most {
            T::zero()
        } else {
            error[k]
        }
    });
    if residual.iter().all(|x| *x == T::zero()) {
        return Ok(());
    }
    let conflicting = measured.influential(&at.jacobian, &residual, held);
    Err(AssemblyError::Velocities {
        structure: mechanism.structure(),
        residual,
        conflicting,
    })
}

/// The branches that meet at a singular position.
struct Branches<'a, T, const N: usize, const R: usize> {
    mechanism: &'a dyn Mechanism<T, N, R>,
    measured: &'a Scales<T, N, R>,
    /// The same, with what is held taken out.
    scales: &'a Scales<T, N, R>,
    /// What the velocities that aren't held can do.
    free: &'a Decomposition<T, N, R>,
    /// What all velocities can do.
    whole: &'a Decomposition<T, N, R>,
}

impl<T: Real, const N: usize, const R: usize> Branches<'_, T, N, R> {
    /// Newton's method towards the nearest branch, along the directions that
    /// the constraints leave free; whether one was reached.
    fn choose(&self, state: &mut State<T, N>) -> Result<bool, Breakdown> {
        for _ in 0..MOST_STEPS {
            let bias = self.bias(state, state.v);
            let rest = self.whole.unreachable(&bias, regular());
            let slopes = self.slopes(state);
            let size = self.size(&bias, &state.v, &slopes);
            let reached = norm(&rest.data.0[0]) <= size * T::from_f64(ON_BRANCH);
            if norm(&rest.data.0[0]) > T::zero() {
                // Also where the branch is reached: the last step squares the
                // error.
                let step = self.step(&slopes, &rest)?;
                state.v += step.component_mul(&self.scales.columns);
            }
            if reached || !state.is_finite() {
                return Ok(reached && state.is_finite());
            }
        }
        Ok(false)
    }

    /// `p₂` at a velocity, scaled.
    fn bias(&self, state: &State<T, N>, v: SVector<T, N>) -> SVector<T, R> {
        let mut terms = Terms::default();
        self.mechanism.terms(&State { v, ..*state }, &mut terms);
        terms.bias.component_mul(&self.measured.rows)
    }

    /// How `p₂` changes with each scaled velocity, held or not. `p₂` is quadratic
    /// in the velocities, so that central differences are exact.
    fn slopes(&self, state: &State<T, N>) -> SMatrix<T, R, N> {
        let mut slopes = SMatrix::<T, R, N>::zeros();
        let two = T::from_f64(2.0);
        for j in 0..N {
            let (mut more, mut less) = (state.v, state.v);
            more[j] += self.measured.columns[j];
            less[j] -= self.measured.columns[j];
            let slope = (self.bias(state, more) - self.bias(state, less)) / two;
            slopes.set_column(j, &slope);
        }
        slopes
    }

    /// How large the terms are whose sum `p₂` is.
    fn size(&self, bias: &SVector<T, R>, v: &SVector<T, N>, slopes: &SMatrix<T, R, N>) -> T {
        let scaled = v.component_div(&self.measured.columns);
        (0..N).fold(norm(&bias.data.0[0]), |sum, j| {
            sum + norm(&slopes.data.0[j]) * scaled[j].abs()
        })
    }

    /// The step that removes the rest, in scaled velocities: of least norm,
    /// along what the constraints leave free.
    fn step(
        &self,
        slopes: &SMatrix<T, R, N>,
        rest: &SVector<T, R>,
    ) -> Result<SVector<T, N>, Breakdown> {
        let mut along = slopes.transpose();
        for column in along.data.0.iter_mut() {
            *column = self.along_free(&SVector::from(*column)).data.0[0];
        }
        let mut along = along.transpose();
        for column in along.data.0.iter_mut() {
            let reached = SVector::from(*column);
            *column = self.whole.unreachable(&reached, regular()).data.0[0];
        }
        let mut towards = Decomposition::<T, N, R>::default();
        towards.decompose_scaled(|k, j| along[(k, j)])?;
        let cut = towards.largest() * T::from_f64(EFFECTIVE);
        let (step, _) = towards.solve(&-rest, cut);
        Ok(self.along_free(&step))
    }

    /// The part of a scaled velocity that the constraints leave free and nobody holds.
    fn along_free(&self, velocity: &SVector<T, N>) -> SVector<T, N> {
        let mut along = self.free.ineffective(velocity, regular());
        for (entry, scale) in along.iter_mut().zip(self.scales.columns.iter()) {
            if *scale == T::zero() {
                // Held: free of the constraints, but not free.
                *entry = T::zero();
            }
        }
        along
    }
}
