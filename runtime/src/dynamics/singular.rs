//! The acceleration near a singular position.
//!
//! In:  a state, off the constraints by as much as the stages of a step are.
//! Out: the acceleration at the nearest state on the constraints.
//!
//! The rows there are exact, but a row of size `σ` turns round-off `ε` into an
//! error of `ε/σ³`. Below a certain size the branch rows `A q⃛ + K q̈ = κ` take the
//! place of such a row. They know nothing of the size of `A`, but need the jerk
//! `q⃛`, times `σ`. It is taken from the accelerations a little before and after on
//! the motion, which need it too, and its change: a contraction, since along the
//! motion `A` changes by less than `K`. What is left out is of order `σ³`.

use super::{Known, Metric, Solver, Source, Tangent, Which};
use crate::linalg::jerk_span;
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::{SMatrix, SVector};

/// Rounds of the contraction.
const ROUNDS: usize = 6;

/// How much of the difference to take over in each round. For holonomic constraints
/// `K = 3Ȧ`, so that an error of the jerk returns as −1/3 of itself and one of the
/// snap as −2/3: these shares remove it at once.
const JERK_SHARE: f64 = 0.75;
/// As [`JERK_SHARE`], for the snap.
const SNAP_SHARE: f64 = 0.6;

/// The equations of motion at one state, solved but for the jerk.
struct Local<T, const N: usize, const R: usize> {
    metric: Metric<T, N>,
    jacobian: SMatrix<T, R, N>,
    tangent: Tangent<T, N, R>,
    right: [T; R],
    free: [T; N],
}

impl<T: Real, const N: usize, const R: usize> Solver<T, N, R> {
    /// The acceleration at the nearest state on the constraints; on the branch that
    /// the velocity follows if the rows are too weak to tell.
    pub(super) fn near_singular<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let (landed, known) = self.landed(mechanism, state)?;
        if self.is_safe_at(&landed) {
            return self.landed_acceleration(mechanism, &landed);
        }
        self.counters.robust_accelerations += 1;
        self.singular_acceleration(mechanism, &landed, known)
    }

    /// The nearest state on the constraints, and what is known about it; the state
    /// itself where it could not be brought there, or by the published method.
    pub(super) fn landed<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<(State<T, N>, Known), DynamicsError<T>> {
        let mut landed = *state;
        if !self.settings.branch_rows {
            return Ok((landed, Known::Rank));
        }
        match self.land(mechanism, &mut landed) {
            Ok(_) => Ok((landed, Known::Landed)),
            Err(DynamicsError::ProjectionFailed { .. }) => Ok((*state, Known::Rank)),
            Err(error) => Err(error),
        }
    }

    /// The acceleration at a state as it is, by a rank decision.
    pub(crate) fn singular_acceleration<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        known: Known,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let here = self.local(mechanism, state, known)?;
        if here.tangent.strong == self.rows.regular(Which::All) {
            self.choose_rows(here.tangent.rows());
        }
        self.with_jerk(mechanism, state, &here)
    }

    /// The equations of motion at one state.
    fn local<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        known: Known,
    ) -> Result<Local<T, N, R>, DynamicsError<T>> {
        mechanism.terms(state, &mut self.terms);
        let bias = self.stabilised_bias(mechanism, state);
        self.factorise_metric(mechanism, Source::Terms, state.t)?;
        let tangent = self.tangent(mechanism, state, Source::Terms, Which::All, known)?;
        Ok(Local {
            free: self.free_acceleration(&bias),
            right: self.scaled(&bias),
            metric: self.metric.clone(),
            jacobian: self.terms.jacobian,
            tangent,
        })
    }

    /// The acceleration with the jerk that the branch rows need, if they are used.
    fn with_jerk<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        here: &Local<T, N, R>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let mut motion = Motion {
            acceleration: here.acceleration(self, &SVector::zeros()),
            jerk: SVector::zeros(),
            snap: SVector::zeros(),
        };
        let rate = here.tangent.rate();
        if here.tangent.branch == here.tangent.strong || rate <= T::zero() {
            return Ok(motion.acceleration);
        }
        let (strong, aimed) = (here.tangent.strong, here.tangent.aimed);
        let beside = Known::Beside { strong, aimed };
        let span = jerk_span::<T>() / rate;
        let next = self.local(mechanism, &motion.after(state, span), beside)?;
        for _ in 0..ROUNDS {
            let jerk = (next.acceleration(self, &motion.jerk) - motion.acceleration) / span;
            motion.jerk += (jerk - motion.jerk) * T::from_f64(JERK_SHARE);
            motion.acceleration = here.acceleration(self, &motion.jerk);
        }
        let next = self.local(mechanism, &motion.after(state, span), beside)?;
        let last = self.local(mechanism, &motion.after(state, -span), beside)?;
        for _ in 0..ROUNDS {
            let change = motion.snap * span;
            let ahead = next.acceleration(self, &(motion.jerk + change));
            let behind = last.acceleration(self, &(motion.jerk - change));
            let jerk = (ahead - behind) / (span + span);
            let bend = (ahead - motion.acceleration) - (motion.acceleration - behind);
            let snap = bend / (span * span);
            motion.jerk += (jerk - motion.jerk) * T::from_f64(JERK_SHARE);
            motion.snap += (snap - motion.snap) * T::from_f64(SNAP_SHARE);
            motion.acceleration = here.acceleration(self, &motion.jerk);
        }
        Ok(motion.acceleration)
    }
}

/// A motion near a state, as far as it is known.
struct Motion<T, const N: usize> {
    acceleration: SVector<T, N>,
    jerk: SVector<T, N>,
    snap: SVector<T, N>,
}

impl<T: Real, const N: usize> Motion<T, N> {
    /// The state a short time later.
    fn after(&self, state: &State<T, N>, span: T) -> State<T, N> {
        let (half, third) = (span / T::from_f64(2.0), span / T::from_f64(3.0));
        let turn = self.acceleration + self.jerk * half;
        let bend = self.acceleration + self.jerk * third;
        State::new(
            state.t + span,
            state.q + (state.v + bend * half) * span,
            state.v + turn * span,
        )
    }
}

impl<T: Real, const N: usize, const R: usize> Local<T, N, R> {
    /// `q̈` if the jerk is known.
    fn acceleration(&self, solver: &Solver<T, N, R>, jerk: &SVector<T, N>) -> SVector<T, N> {
        let weight = solver.scaled(&(self.jacobian * jerk));
        let mut w = self.tangent.solve(&self.right, &weight, &self.free);
        self.metric.factor.backward(&mut w);
        SVector::from(w)
    }
}
