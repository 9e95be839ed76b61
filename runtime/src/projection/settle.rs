//! Onto the constraints where rows of them vanish.
//!
//! In:  a state near a singular position.
//! Out: the state on its own branch.
//!
//! Let `x` be the distance across the branch and `y` the distance to the singular
//! position along it, so that a weak row reads `g = xy`. The nearest position may
//! lie on another branch (`y = 0`), and `x = g/y` magnifies round-off. So:
//!
//! - A state moves across its branch only. Which direction that is, the branch rows
//!   tell, as they do for accelerations.
//! - `x` is taken from `g` where `y` is large, and where it is small from the
//!   velocity level, `ẏx + yẋ = 0`; likewise `ẋ` from the velocity level, or from
//!   the acceleration level, `2ẏẋ + y ẍ + … = 0`. For holonomic constraints
//!   `K = 3Ȧ`, so `ẏ = K/3`.
//! - A residual that is not well above its own round-off is left alone.

use crate::dynamics::{Known, Solver, Source, Tangent, Which};
use crate::linalg::{acceptable, norm, on_constraint, same_branch, significant, useless};
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::SVector;

/// Corrections after which a state is taken as it is. Newton's iteration halves its
/// distance only to a point where branches cross, so there are as many as a number
/// has bits.
const MAX_ITERATIONS: usize = 53;

/// What is needed to judge residuals at one state.
struct Scene<T> {
    /// Round-off of the position, a length in the metric.
    round_off: T,
    /// Change of position up to which its square is round-off.
    settled: T,
    /// The size of the velocity in the metric.
    speed: T,
    /// Singular value below which branch rows take the place of a row.
    floor: T,
}

impl<T: Real> Scene<T> {
    /// Whether changes of position and velocity are round-off, or no longer grow
    /// smaller and are small enough.
    fn is_at_rest(&self, moved: T, turned: T, before: Option<(T, T)>) -> bool {
        let noise = T::EPSILON * self.speed;
        if moved <= on_constraint::<T>() * self.round_off && turned <= on_constraint::<T>() * noise
        {
            return true;
        }
        let half = T::from_f64(0.5);
        let stuck = before.is_some_and(|(q, v)| moved > q * half && turned > v * half);
        stuck && moved <= self.settled && turned <= T::EPSILON.sqrt() * self.speed
    }
}

impl<T: Real, const N: usize, const R: usize> Solver<T, N, R> {
    /// Brings a state onto its branch, as far as residuals tell it.
    pub(super) fn settle<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        let mut before: Option<(T, T)> = None;
        let mut acceleration = None;
        let mut tangent = Tangent::default();
        for _ in 0..MAX_ITERATIONS {
            mechanism.position(state, &mut self.position);
            self.finite_residual(state)?;
            self.factorise_metric(mechanism, Source::Position, state.t)?;
            self.counters.projection_iterations += 1;
            self.tangent_here(mechanism, state, Which::All, &mut tangent)?;
            let scene = Scene {
                round_off: self.round_off(),
                settled: T::EPSILON.sqrt() * self.reach,
                speed: self.metric.factor.length(&state.v.data.0[0]),
                floor: self.floor(mechanism, state, &tangent),
            };
            let across = if self.rows.all_holonomic() {
                self.position_change(state, &scene, &mut tangent)?
            } else {
                let mut holonomic = Tangent::default();
                self.tangent_here(mechanism, state, Which::Holonomic, &mut holonomic)?;
                self.position_change(state, &scene, &mut holonomic)?
            };
            let faster =
                self.velocity_change(mechanism, state, &scene, &mut tangent, &mut acceleration)?;
            let moved = self.metric.factor.length(&across);
            let turned = self.metric.factor.length(&faster);
            state.q += SVector::from(across);
            state.v += SVector::from(faster);
            if scene.is_at_rest(moved, turned, before) {
                break;
            }
            before = Some((moved, turned));
        }
        mechanism.position(state, &mut self.position);
        if self.finite_residual(state)? > acceptable::<T>() * self.reach {
            return Err(self.failed(mechanism, state));
        }
        Ok(())
    }

    /// The change of position that closes `g`.
    fn position_change(
        &self,
        state: &State<T, N>,
        scene: &Scene<T>,
        tangent: &mut Tangent<T, N, R>,
    ) -> Result<[T; N], DynamicsError<T>> {
        let gap = self.scaled(&-self.position.residual);
        let mut w = tangent.close_strong(&gap);
        if norm(&w) <= scene.settled {
            let speed = scene.speed * T::from_f64(3.0);
            let meaning = significant::<T>() * scene.round_off;
            let rate = tangent.rate();
            let far = |value: T, size: T| {
                size > meaning && size * rate > same_branch::<T>() * value * value * speed
            };
            self.refine(tangent, -T::one(), state)?;
            let floor = if tangent.any_weak(&gap, far) {
                T::one()
            } else {
                scene.floor
            };
            self.refine(tangent, floor, state)?;
            tangent.close_rows(&mut w, &gap, |_, size| size > meaning);
            let velocity = self.scaled(&-self.velocity_level(state));
            let noise = significant::<T>() * T::EPSILON * scene.speed;
            tangent.close_slopes(&mut w, &velocity, T::from_f64(3.0), noise);
        }
        Ok(self.lower(w).data.0[0])
    }

    /// The change of velocity that closes `A q̇ + b`. The acceleration that the weak
    /// directions need is computed once: near its place on the constraints a state
    /// hardly changes it.
    fn velocity_change<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        scene: &Scene<T>,
        tangent: &mut Tangent<T, N, R>,
        known: &mut Option<SVector<T, N>>,
    ) -> Result<[T; N], DynamicsError<T>> {
        let gap = self.scaled(&-self.velocity_level(state));
        let mut w = tangent.close_strong(&gap);
        let off = scene
            .round_off
            .max(self.residual(&self.position.residual).0);
        if off <= scene.settled && norm(&w) <= T::EPSILON.sqrt() * scene.speed {
            self.refine(tangent, scene.floor, state)?;
            let (rate, noise) = (tangent.rate(), T::EPSILON * scene.speed);
            // Across the branch the position is known only to `off/σ`, for which the
            // velocity level has an error that no velocity is to blame for.
            tangent.close_rows(&mut w, &gap, |value, size| {
                size > significant::<T>() * (noise + rate * off / value)
            });
            if tangent.branch < tangent.used {
                let acceleration = match *known {
                    Some(acceleration) => acceleration,
                    None => self.singular_acceleration(mechanism, state, Known::Rank)?,
                };
                *known = Some(acceleration);
                let level = self.acceleration_level(mechanism, state, &acceleration)?;
                let share = T::from_f64(1.5);
                tangent.close_slopes(&mut w, &level, share, significant::<T>() * noise * rate);
            }
        }
        Ok(self.lower(w).data.0[0])
    }

    /// Singular value below which branch rows take the place of a row; none where the
    /// motion turns at once, of which they say nothing.
    fn floor<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        tangent: &Tangent<T, N, R>,
    ) -> T {
        mechanism.terms(state, &mut self.terms);
        let free = self.free_acceleration(&self.terms.bias);
        match self.turns_at_once(state, tangent, &free) {
            true => -T::one(),
            false => useless(),
        }
    }

    /// `p₂ − A q̈`, scaled, at a state: zero in the weak rows on the branch.
    fn acceleration_level<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        acceleration: &SVector<T, N>,
    ) -> Result<[T; R], DynamicsError<T>> {
        mechanism.terms(state, &mut self.terms);
        let level = self.terms.bias - self.terms.jacobian * acceleration;
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        Ok(self.scaled(&level))
    }

    /// `A q̇ + b` at the position in the buffer.
    fn velocity_level(&self, state: &State<T, N>) -> SVector<T, R> {
        self.position.jacobian * state.v + self.position.drift
    }

    fn tangent_here<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        which: Which,
        out: &mut Tangent<T, N, R>,
    ) -> Result<(), DynamicsError<T>> {
        self.tangent(mechanism, state, Source::Position, which, Known::Rank, out)
    }

    fn refine(
        &self,
        tangent: &mut Tangent<T, N, R>,
        floor: T,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        let not_finite = |_| DynamicsError::NotFinite { t: state.t };
        tangent.refine(floor).map_err(not_finite)
    }
}
