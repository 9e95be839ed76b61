//! The acceleration near a singular position.
//!
//! In:  a state, off the constraints by as much as the stages of a step are.
//! Out: the acceleration at the nearest state on the constraints.
//!
//! The rows there are exact, but a row of size `σ` turns round-off `ε` into an
//! error of `ε/σ³`. Below a certain size the branch rows `A q⃛ + K q̈ = κ` take the
//! place of such a row. They know nothing of the size of `A`, but need the jerk
//! `q⃛`, times `σ`. It is taken from the accelerations a little before and after on
//! the motion, which need it too, and its changes: a contraction, since along the
//! motion `A` changes by less than `K`. What is left out is of order `σ⁴`.

use super::{Known, Solver, Source, Tangent, Which};
use crate::linalg::{add_scaled, crackle_span, dot, jerk_span, norm};
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::{SMatrix, SVector};

/// Rounds of the contraction.
const ROUNDS: usize = 8;

/// How much of the difference to take over in each round. For holonomic constraints
/// `K = 3Ȧ`, so that an error of the jerk returns as −1/3 of itself, one of the snap
/// as −2/3 and one of the crackle as −1: these shares remove it at once.
const JERK_SHARE: f64 = 0.75;
/// As [`JERK_SHARE`], for the snap.
const SNAP_SHARE: f64 = 0.6;
/// As [`JERK_SHARE`], for the crackle.
const CRACKLE_SHARE: f64 = 0.5;

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
        if let Some(acceleration) = self.bridged_acceleration(&landed) {
            return Ok(acceleration);
        }
        self.singular_acceleration(mechanism, &landed, known)
    }

    /// The nearest state on the constraints, and what is known about it; the state
    /// itself where it could not be brought there, or by the published method.
    pub(super) fn landed<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<(State<T, N>, Known<'static, T, N, R>), DynamicsError<T>> {
        let mut landed = *state;
        if !self.settings.branch_rows {
            return Ok((landed, Known::Rank));
        }
        match self.land(mechanism, &mut landed) {
            Ok(_) => {
                self.slide(mechanism, state, &mut landed)?;
                Ok((landed, Known::Landed))
            }
            Err(DynamicsError::ProjectionFailed { .. }) => Ok((*state, Known::Rank)),
            Err(error) => Err(error),
        }
    }

    /// The acceleration at a state as it is, by a rank decision.
    pub(crate) fn singular_acceleration<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        known: Known<T, N, R>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let (mut tangent, mut here) = (Tangent::default(), Affine::default());
        self.decide(mechanism, state, known, &mut tangent, &mut here)?;
        if tangent.strong == self.rows.regular(Which::All) {
            self.choose_rows(tangent.rows());
        }
        if !self.turns_at_once(state, &tangent, &here.free) {
            let found = self.with_jerk(mechanism, state, &tangent, &here)?;
            let lifted = self.metric.factor.transposed_product(&found.data.0[0]);
            if !self.turns_at_once(state, &tangent, &lifted) {
                return Ok(found);
            }
        }
        self.acceleration_by_rows(mechanism, state)
    }

    /// Whether an acceleration `w` in the metric changes the velocity altogether in the
    /// time over which branch rows look along the motion, as next to rest. They are of
    /// no use then, and hardly needed: round-off `ε` of the position makes no more than
    /// `ε v²/σ³` in a row of size `σ`.
    pub(crate) fn turns_at_once(
        &self,
        state: &State<T, N>,
        tangent: &Tangent<T, N, R>,
        w: &[T; N],
    ) -> bool {
        let speed = self.metric.factor.length(&state.v.data.0[0]);
        // False for NaN, too.
        let goes_on = norm(w) * crackle_span() <= speed * tangent.rate();
        tangent.branch > tangent.strong && !goes_on
    }

    /// The acceleration by the rows alone, however weak, as long as they say anything.
    #[inline(never)]
    fn acceleration_by_rows<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let (mut like, mut here) = (Tangent::default(), Affine::default());
        self.decide(mechanism, state, Known::Landed, &mut like, &mut here)?;
        let strong = like.aimed;
        let known = Known::Beside {
            like: &like,
            strong,
        };
        let mut tangent = Tangent::default();
        self.decide(mechanism, state, known, &mut tangent, &mut here)?;
        Ok(here.constant)
    }

    /// Decides what the constraints leave free at a state and solves the equations of
    /// motion there but for the jerk. Never inlined: what it needs on the stack is needed
    /// once.
    #[inline(never)]
    fn decide<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        known: Known<T, N, R>,
        tangent: &mut Tangent<T, N, R>,
        out: &mut Affine<T, N, R>,
    ) -> Result<(), DynamicsError<T>> {
        mechanism.terms(state, &mut self.terms);
        let bias = self.stabilised_bias(mechanism, state);
        self.factorise_metric(mechanism, Source::Terms, state.t)?;
        self.tangent(mechanism, state, Source::Terms, Which::All, known, tangent)?;
        self.solve_but_for_jerk(tangent, &bias, out);
        Ok(())
    }

    /// `q̈` as a function of the jerk, by the terms in the buffer.
    fn solve_but_for_jerk(
        &self,
        tangent: &Tangent<T, N, R>,
        bias: &SVector<T, R>,
        out: &mut Affine<T, N, R>,
    ) {
        out.free = self.free_acceleration(bias);
        out.constant = self.lower(tangent.solve(&self.scaled(bias), &out.free));
        out.terms = tangent.branch - tangent.strong;
        for k in 0..out.terms {
            let (left, across) = tangent.across(tangent.strong + k);
            out.across.set_column(k, &self.lower(across));
            let scaled = SVector::from_fn(|row, _| left[row] * self.rows.scale(row));
            let weights = self.terms.jacobian.tr_mul(&scaled);
            out.weights.set_column(k, &weights);
        }
    }

    /// The acceleration with the jerk that the branch rows need, if they are used.
    #[inline(never)]
    fn with_jerk<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        like: &Tangent<T, N, R>,
        here: &Affine<T, N, R>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let rate = like.rate();
        if like.branch == like.strong || rate <= T::zero() {
            return Ok(here.constant);
        }
        let strong = like.strong;
        let known = Known::Beside { like, strong };
        let mut tangent = Tangent::default();
        let mut beside = |motion: &Motion<T, N>, span: T, out: &mut Affine<T, N, R>| {
            let state = motion.after(state, span);
            self.decide(mechanism, &state, known, &mut tangent, out)
        };
        let mut motion = Motion::new(here.constant);
        let mut around: [Affine<T, N, R>; 4] = core::array::from_fn(|_| Affine::default());
        let [before, behind, ahead, after] = &mut around;
        let span = jerk_span::<T>() / rate;
        beside(&motion, span, ahead)?;
        motion.find_jerk(here, ahead, span);
        beside(&motion, -span, behind)?;
        beside(&motion, span, ahead)?;
        motion.find_snap(here, [behind, ahead], span);
        let span = crackle_span::<T>() / rate;
        beside(&motion, -(span + span), before)?;
        beside(&motion, -span, behind)?;
        beside(&motion, span, ahead)?;
        beside(&motion, span + span, after)?;
        motion.find_crackle(here, &around, span);
        Ok(motion.acceleration)
    }
}

/// The acceleration at a state, as far as it depends on the jerk there:
/// `q̈ = constant − Σ across_k (weights_k · q⃛)`, a term for each branch direction.
struct Affine<T, const N: usize, const R: usize> {
    constant: SVector<T, N>,
    across: SMatrix<T, N, R>,
    weights: SMatrix<T, N, R>,
    terms: usize,
    /// What the forces alone would give, in the metric.
    free: [T; N],
}

impl<T: Real, const N: usize, const R: usize> Default for Affine<T, N, R> {
    fn default() -> Self {
        Self {
            constant: SVector::zeros(),
            across: SMatrix::zeros(),
            weights: SMatrix::zeros(),
            terms: 0,
            free: [T::zero(); N],
        }
    }
}

impl<T: Real, const N: usize, const R: usize> Affine<T, N, R> {
    fn at(&self, jerk: &SVector<T, N>) -> SVector<T, N> {
        let mut acceleration = self.constant;
        for k in 0..self.terms {
            let share = dot(&self.weights.data.0[k], &jerk.data.0[0]);
            add_scaled(&mut acceleration.data.0[0], -share, &self.across.data.0[k]);
        }
        acceleration
    }
}

/// A motion near a state, as far as it is known.
struct Motion<T, const N: usize> {
    acceleration: SVector<T, N>,
    jerk: SVector<T, N>,
    snap: SVector<T, N>,
    crackle: SVector<T, N>,
}

impl<T: Real, const N: usize> Motion<T, N> {
    fn new(acceleration: SVector<T, N>) -> Self {
        Self {
            acceleration,
            jerk: SVector::zeros(),
            snap: SVector::zeros(),
            crackle: SVector::zeros(),
        }
    }

    /// The state a short time later.
    fn after(&self, state: &State<T, N>, span: T) -> State<T, N> {
        let part = |n: f64| span / T::from_f64(n);
        let turn = self.acceleration + (self.jerk + self.snap * part(3.0)) * part(2.0);
        let bend = self.acceleration + (self.jerk + self.snap * part(4.0)) * part(3.0);
        State::new(
            state.t + span,
            state.q + (state.v + bend * part(2.0)) * span,
            state.v + turn * span,
        )
    }

    /// The jerk a short time later.
    fn jerk_after(&self, span: T) -> SVector<T, N> {
        self.jerk + (self.snap + self.crackle * (span / T::from_f64(2.0))) * span
    }

    /// The jerk by the acceleration at the next state, `span` later.
    fn find_jerk<const R: usize>(
        &mut self,
        here: &Affine<T, N, R>,
        next: &Affine<T, N, R>,
        span: T,
    ) {
        for _ in 0..ROUNDS {
            let jerk = (next.at(&self.jerk) - self.acceleration) / span;
            self.jerk += (jerk - self.jerk) * T::from_f64(JERK_SHARE);
            self.acceleration = here.at(&self.jerk);
        }
    }

    /// Jerk and snap by the accelerations `span` before and after.
    fn find_snap<const R: usize>(
        &mut self,
        here: &Affine<T, N, R>,
        around: [&Affine<T, N, R>; 2],
        span: T,
    ) {
        for _ in 0..ROUNDS {
            let [behind, ahead] = [-span, span].map(|at| self.jerk_after(at));
            let (behind, ahead) = (around[0].at(&behind), around[1].at(&ahead));
            let jerk = (ahead - behind) / (span + span);
            let bend = (ahead - self.acceleration) - (self.acceleration - behind);
            let snap = bend / (span * span);
            self.jerk += (jerk - self.jerk) * T::from_f64(JERK_SHARE);
            self.snap += (snap - self.snap) * T::from_f64(SNAP_SHARE);
            self.acceleration = here.at(&self.jerk);
        }
    }

    /// Jerk, snap and crackle by the accelerations at −2, −1, 1 and 2 times `span`.
    fn find_crackle<const R: usize>(
        &mut self,
        here: &Affine<T, N, R>,
        around: &[Affine<T, N, R>; 4],
        span: T,
    ) {
        let number = T::from_f64;
        for _ in 0..ROUNDS {
            let at = |i: usize, steps: f64| around[i].at(&self.jerk_after(span * number(steps)));
            let (far, near) = ([at(0, -2.0), at(3, 2.0)], [at(1, -1.0), at(2, 1.0)]);
            let (far_odd, near_odd) = (far[1] - far[0], near[1] - near[0]);
            let even = |pair: [SVector<T, N>; 2]| {
                (pair[1] - self.acceleration) - (self.acceleration - pair[0])
            };
            let jerk = (near_odd * number(8.0) - far_odd) / (span * number(12.0));
            let square = span * span;
            let snap = (even(near) * number(16.0) - even(far)) / (square * number(12.0));
            let crackle = (far_odd - near_odd * number(2.0)) / (square * span * number(2.0));
            self.jerk += (jerk - self.jerk) * number(JERK_SHARE);
            self.snap += (snap - self.snap) * number(SNAP_SHARE);
            self.crackle += (crackle - self.crackle) * number(CRACKLE_SHARE);
            self.acceleration = here.at(&self.jerk);
        }
    }
}
