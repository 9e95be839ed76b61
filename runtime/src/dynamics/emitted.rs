//! The cheap path in code that was written for this mechanism.
//!
//! In:  a mechanism that provides [`Mechanism::acceleration`] and
//!      [`Mechanism::correction`].
//! Out: accelerations and projections by them, where the pivots they hand out are
//!      safe.
//!
//! Of rows that are redundant wherever the constraints hold, such code leaves some out. It is
//! used where the others are as many as are independent.
//!
//! Not here: what happens elsewhere.

use super::{Core, Rows};
use crate::model;
use crate::state::all_finite;
use crate::tolerance::{definite, negligible, passes, window};
use crate::{Acceleration, DynamicsError, Form, Mechanism, Pivots, Real, Stabilisation, State};
use nalgebra::SVector;

/// Coordinates and constraint equations of a mechanism whose pivots fit into registers;
/// those of a larger one have a buffer that need not be cleared.
const IN_REGISTERS: usize = 16;
/// Square of the part of the velocities, and of the coordinates' scale, that a small correction
/// changes.
const SMALL: f64 = 1e-8;

/// Corrections after which a position is given up.
pub(crate) const MAX_ITERATIONS: usize = 20;

/// What one correction by emitted code came to.
enum Correcting<T> {
    /// The state is on the constraints, with this squared sine.
    Done(T),
    /// It was off them by this much, a length in the metric.
    Off(T),
    /// There is no such code, or it is not safe.
    Lost,
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Whether emitted code may be asked for accelerations and projections.
    fn asks_emitted(&self) -> bool {
        self.emitted
            && self.settings.form == Form::Reduced
            && !matches!(self.settings.stabilisation, Stabilisation::Baumgarte { .. })
            && self.rows.solves_all()
            && self.metric.is_emitted()
            && self.session.chart.is_none()
            && !self.session.at_rest
            && !self.session.chooses_rows
    }

    /// Decides whether emitted code may be called before anything else is asked.
    pub(crate) fn expect_regular(&mut self) {
        self.expected = self.is_prepared() && self.asks_emitted();
    }

    /// The acceleration by emitted code, if there is any and it is safe here.
    pub(super) fn emitted_acceleration(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Option<SVector<T, N>> {
        if !self.asks_emitted() {
            return None;
        }
        let mut acceleration = SVector::zeros();
        let squared = self.evaluate(mechanism, state, &mut acceleration);
        passes(squared, window()).then_some(acceleration)
    }

    /// The acceleration by emitted code, and the smallest squared sine that its pivots
    /// show: zero if something is not definite or not finite, or there is no such code.
    ///
    /// Short code is inlined here and nowhere else in what is called often; there is one copy
    /// of long code.
    #[inline(never)]
    pub(super) fn evaluate<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        acceleration: &mut SVector<T, N>,
    ) -> T {
        let mut small = Acceleration {
            sides: self.acceleration.sides,
            ..Acceleration::default()
        };
        let solved = if N + R <= IN_REGISTERS {
            &mut small
        } else {
            &mut self.acceleration
        };
        if !mechanism.structure().weighed.is_empty() {
            solved.weights = SVector::from(self.rows.weight);
        }
        self.emitted = match N + R <= IN_REGISTERS {
            true => mechanism.acceleration(state, solved),
            false => model::acceleration(mechanism, state, solved),
        };
        if !self.emitted {
            return T::zero();
        }
        let mut squared = squared_sine(&solved.pivots, &self.rows);
        let is_finite = all_finite(&solved.acceleration);
        *acceleration = solved.acceleration;
        self.session.observe(state, squared);
        if !is_finite {
            squared = T::zero();
        }
        squared
    }

    /// Brings a state onto the constraints by emitted code and returns the squared
    /// sine there; none if there is no such code or it is not safe.
    ///
    /// # Errors
    ///
    /// The iteration does not end.
    #[inline(always)]
    pub(crate) fn emitted_projection<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Result<Option<T>, DynamicsError<T>> {
        if !self.expected && !self.asks_emitted() {
            return Ok(None);
        }
        let mut before = None;
        for _ in 0..MAX_ITERATIONS {
            match self.correct(mechanism, state, before) {
                Correcting::Done(squared) => return Ok(Some(squared)),
                Correcting::Off(worst) => before = Some(worst),
                Correcting::Lost => return Ok(None),
            }
        }
        // Rows that were left out need not follow from the others with other parameters.
        match mechanism.structure().redundant {
            [] => Err(self.lost(&mechanism, state)),
            _ => Ok(None),
        }
    }

    /// One correction by emitted code of a state that was off by `before` until the last
    /// correction. A function of its own: most states need just one correction, and in the body of
    /// a loop the compiler would load registers for a second one.
    #[inline(never)]
    fn correct<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
        before: Option<T>,
    ) -> Correcting<T> {
        if !mechanism.structure().weighed.is_empty() {
            self.correction.weights = SVector::from(self.rows.weight);
        }
        let provided = match N + R <= IN_REGISTERS {
            true => mechanism.correction(state, &mut self.correction),
            false => model::correction(mechanism, state, &mut self.correction),
        };
        if !provided {
            return Correcting::Lost;
        }
        let squared = squared_sine(&self.correction.pivots, &self.rows);
        if squared < self.session.trial.lowest {
            self.session.trial.lowest = squared;
        }
        let worst = match self.worst(&self.correction.residual) {
            Some(worst) if passes(squared, window()) => worst,
            _ => return Correcting::Lost,
        };
        let done = self.is_on_constraints(worst, before);
        if !done {
            self.counters.projection_iterations += 1;
            state.q += self.correction.position;
        }
        if done || self.is_straight(worst, squared, &state.v) {
            state.v += self.correction.velocity;
            return Correcting::Done(squared);
        }
        Correcting::Off(worst)
    }

    /// Takes note of the sizes of the rows at an accepted state that emitted code
    /// corrected.
    pub(crate) fn learn_emitted_rows(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) {
        // Mostly no row has grown; where some have, all are evaluated once.
        let mut alone = None;
        for row in 0..R {
            let size = self.correction.pivots.row_squares[row];
            self.rows.observe(row, size, || {
                let alone = alone.get_or_insert_with(|| {
                    mechanism.position(state, &mut self.position);
                    self.position.rows_alone()
                });
                alone[row]
            });
        }
    }

    /// The largest constraint error as a length in the metric, if all are finite.
    #[inline(always)]
    fn worst(&self, residual: &SVector<T, R>) -> Option<T> {
        let [residual] = &residual.data.0;
        let (mut worst, mut sum) = (T::zero(), T::zero());
        for (row, residual) in residual.iter().enumerate() {
            let size = (*residual * self.rows.scale[row]).abs();
            sum += size;
            if size > worst {
                worst = size;
            }
        }
        sum.is_finite().then_some(worst)
    }

    /// Whether the constraints are straight, to round-off, over the corrections of the
    /// residual and of the velocities, so that the state is on them after one correction. Takes
    /// note of corrections that are not small.
    #[inline]
    fn is_straight(&mut self, worst: T, squared_sine: T, velocities: &SVector<T, N>) -> bool {
        let [corrections] = &self.correction.velocity.data.0;
        let [velocities] = &velocities.data.0;
        let (mut turned, mut whole) = (T::zero(), T::zero());
        for ((weight, dv), v) in self.weights.iter().zip(corrections).zip(velocities) {
            turned = (*weight * *dv).mul_add(*dv, turned);
            whole = (*weight * *v).mul_add(*v, whole);
        }
        // The squares of the lengths of a correction and of a position.
        let (moved, coordinate_scale) = (
            worst * worst,
            squared_sine * self.coordinate_scale.range * self.coordinate_scale.range,
        );
        let (most, round_off, part) = (negligible::<T>(), T::EPSILON, T::from_f64(SMALL));
        if !(turned <= part * whole && moved <= part * coordinate_scale) {
            self.session.trial.is_moved = true;
        }
        moved <= most * most * coordinate_scale
            && moved * turned <= round_off * round_off * coordinate_scale * whole
    }
}

/// The smallest squared sine that emitted pivots show, zero if the metric is not safely
/// definite.
#[inline(always)]
fn squared_sine<T: Real, const N: usize, const R: usize>(
    pivots: &Pivots<T, N, R>,
    rows: &Rows<T, R>,
) -> T {
    let mut valid = true;
    // Pivots that are diagonal entries themselves are not written.
    for i in 0..N {
        let whole = pivots.mass_diagonal.data.0[0][i];
        valid &= pivots.mass_pivots.data.0[0][i] >= definite::<T>() * whole;
    }
    let mut smallest = T::one();
    for row in 0..R {
        let ratio = pivots.row_pivots.data.0[0][row] * rows.inverse_size[row];
        // NaN is not valid.
        valid &= ratio < T::from_f64(f64::INFINITY);
        if ratio < smallest {
            smallest = ratio;
        }
    }
    if valid { smallest } else { T::zero() }
}
