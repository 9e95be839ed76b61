//! The solver of one mechanism's equations: buffers, what it learned, counts.
//!
//! In:  a mechanism and [`Settings`].
//! Out: a [`ConstrainedSystem`], by [`Solver::on`].
//!
//! Nothing allocates: all buffers have the sizes of the mechanism and live here
//! or on the stack.

use super::{ConstrainedSystem, Lifted, Metric, Rows, Tangent, Which};
use crate::linalg::{
    Breakdown, NotDefinite, first_guard, guard, independent, passes, safe_steps, truncation,
    useless, weak,
};
use crate::{
    Branch, Correction, Counters, DynamicsError, Mechanism, Position, Real, Regular, Settings,
    State, Structure, Terms,
};
use nalgebra::{SMatrix, SVector};

/// By which factor a coordinate grows before the length of the coordinates is measured
/// again: round-off is needed to no more digits.
const REACH_STEP: f64 = 1.125;

/// Solves the equations of motion of a mechanism with `N` coordinates and `R`
/// constraint equations.
///
/// It owns the buffers and remembers what it learned about the constraints (their
/// size and rank at regular positions), but not the mechanism: a program may
/// change inputs and parameters between steps and bind it again with
/// [`on`](Self::on).
#[derive(Clone, Debug)]
pub struct Solver<T, const N: usize, const R: usize> {
    /// The form of the equations and how the constraints are kept.
    pub settings: Settings<T>,
    pub(crate) counters: Counters,
    pub(crate) terms: Terms<T, N, R>,
    pub(crate) position: Position<T, N, R>,
    pub(crate) branch: Branch<T, N, R>,
    pub(crate) metric: Metric<T, N>,
    pub(crate) rows: Rows<T, R>,
    pub(crate) lifted: Lifted<T, N, R>,
    pub(crate) regular: Regular<T, N, R>,
    pub(crate) correction: Correction<T, N, R>,
    /// Whether the mechanism provides the last two, as far as is known.
    pub(crate) emitted: bool,
    /// Whether emitted code may be called before anything else is asked.
    pub(crate) expected: bool,
    /// The time and position that is known to be on the constraints, with rows that
    /// are safely independent.
    pub(crate) safe: Option<(T, SVector<T, N>)>,
    /// The state that was last brought onto its branch by interpolation, and the
    /// acceleration there.
    pub(crate) bridged: Option<(State<T, N>, SVector<T, N>)>,
    /// Whether `metric` and `lifted` belong to that position.
    pub(crate) shared: bool,
    /// The largest length of the coordinates in the metric so far: what their
    /// round-off is measured by.
    pub(crate) reach: T,
    /// The sizes of the coordinates up to which that is not measured again.
    sizes: [T; N],
    /// The inverse squares of those sizes; zero where a coordinate has only been zero.
    pub(crate) weights: [T; N],
    /// The sine of the constraints at the last accepted state.
    pub(crate) sine: Option<T>,
    /// The smallest squared sine since then.
    pub(crate) lowest: T,
    /// Whether the step from there comes near a singular position. Then all of its
    /// stages are taken on the constraints: a step mixed of two kinds of stages
    /// would lose its order.
    pub(crate) near: bool,
    prepared: bool,
}

/// Which buffer the terms of a rank decision are in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    Terms,
    Position,
}

impl<T: Real, const N: usize, const R: usize> Solver<T, N, R> {
    /// A solver that knows nothing yet.
    pub fn new(settings: Settings<T>) -> Self {
        Self {
            settings,
            counters: Counters::default(),
            terms: Terms::default(),
            position: Position::default(),
            branch: Branch::default(),
            metric: Metric::default(),
            rows: Rows::new(|_| true),
            lifted: Lifted::default(),
            regular: Regular::default(),
            correction: Correction::default(),
            emitted: true,
            expected: false,
            safe: None,
            bridged: None,
            shared: false,
            reach: T::zero(),
            sizes: [-T::one(); N],
            weights: [T::zero(); N],
            sine: None,
            lowest: T::one(),
            near: false,
            prepared: false,
        }
    }

    /// The system that an integrator sees, for as long as the mechanism does not
    /// change.
    pub fn on<'a, M>(&'a mut self, mechanism: &'a M) -> ConstrainedSystem<'a, M, T, N, R>
    where
        M: Mechanism<T, N, R> + ?Sized,
    {
        self.metric.forget();
        self.safe = None;
        self.bridged = None;
        self.expect_regular();
        ConstrainedSystem::new(mechanism, self)
    }

    /// What was done so far.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Factorises the metric at the state whose terms are in a buffer.
    pub(crate) fn factorise_metric<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        source: Source,
        t: T,
    ) -> Result<(), DynamicsError<T>> {
        self.expected = false;
        let structure = mechanism.structure();
        let constant = structure.constant_mass;
        let (mass, jacobian) = match source {
            Source::Terms => (&self.terms.mass, &self.terms.jacobian),
            Source::Position => (&self.position.mass, &self.position.jacobian),
        };
        let (rows, counters) = (&mut self.rows, &mut self.counters);
        let result = self
            .metric
            .factorise(mass, jacobian, rows, constant, counters);
        result.map_err(|NotDefinite { row }| {
            if mass.iter().chain(jacobian.iter()).all(|x| x.is_finite()) {
                DynamicsError::MassSingular {
                    t,
                    coordinate: row,
                    structure,
                }
            } else {
                DynamicsError::NotFinite { t }
            }
        })
    }

    /// Factorises independent constraints in the metric and returns the smallest
    /// squared sine of a row; zero if none are known to be independent.
    pub(crate) fn factorise_constraints(&mut self, source: Source, which: Which) -> T {
        let Some(list) = self.rows.active(which) else {
            return T::zero();
        };
        let jacobian = match source {
            Source::Terms => &self.terms.jacobian,
            Source::Position => &self.position.jacobian,
        };
        self.counters.constraint_factorisations += 1;
        let rows = &mut self.rows;
        let squared = self.lifted.factorise(&self.metric, jacobian, rows, list);
        self.lowest = self.lowest.min(squared);
        squared
    }

    /// Decides which directions the constraints leave free at the state whose
    /// terms are in a buffer and whose metric is factorised.
    ///
    /// A tangent space is large, so it is written into one that is at hand.
    #[inline(never)]
    pub(crate) fn tangent<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        source: Source,
        which: Which,
        known: Known<T, N, R>,
        tangent: &mut Tangent<T, N, R>,
    ) -> Result<(), DynamicsError<T>> {
        let jacobian = match source {
            Source::Terms => &self.terms.jacobian,
            Source::Position => &self.position.jacobian,
        };
        self.counters.rank_decisions += 1;
        let not_finite = |Breakdown| DynamicsError::NotFinite { t: state.t };
        let regular = self.rows.regular(which);
        let (limit, floor) = match known {
            Known::Nothing => (N.min(R), independent()),
            _ => (regular, truncation()),
        };
        let (metric, rows) = (&self.metric, &mut self.rows);
        match known {
            Known::Beside { like, .. } => tangent.begin_like(like, metric, rows, jacobian, limit),
            _ => tangent.begin(metric, rows, jacobian, which, limit),
        }
        let structure = mechanism.structure();
        if structure.regular || !self.settings.branch_rows {
            tangent.take_strong(floor, limit).map_err(not_finite)?;
            return match known {
                Known::Nothing => Ok(()),
                _ => as_declared(structure, state.t, tangent.rank(useless()), limit),
            };
        }
        match known {
            Known::Rank | Known::Nothing => tangent.take_strong(weak(), limit),
            Known::Landed => tangent.take_landed(limit),
            Known::Beside { like, strong } => tangent.take_counted(strong, like.aimed),
        }
        .map_err(not_finite)?;
        if tangent.strong < limit {
            self.counters.branch_evaluations += 1;
            mechanism.branch(state, &mut self.branch);
            let (metric, rows) = (&self.metric, &self.rows);
            let result = tangent.take_branch(metric, rows, &self.branch, limit);
            result.map_err(not_finite)?;
        }
        if tangent.used < limit {
            tangent.take_rest(floor, limit).map_err(not_finite)?;
            let undetermined = match known {
                Known::Nothing => tangent.at_rest_with_vanished_rows(&self.rows),
                _ => tangent.used < limit,
            };
            self.counters.undetermined += u64::from(undetermined);
        }
        Ok(())
    }

    /// Whether nothing is to be learned before the first state.
    #[inline]
    pub(crate) fn is_prepared(&self) -> bool {
        self.prepared || R == 0
    }

    /// Learns the sizes and the rank of the rows at the first state there is.
    #[cold]
    pub(crate) fn prepare<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if self.is_prepared() {
            return Ok(());
        }
        let constraints = mechanism.structure().constraints;
        self.rows = Rows::new(|row| constraints.get(row).is_none_or(|c| c.holonomic));
        self.sample_sizes(mechanism, state);
        mechanism.position(state, &mut self.position);
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        self.observe_reach(mechanism, state);
        self.learn(mechanism, state)?;
        self.prepared = true;
        Ok(())
    }

    /// Takes note of the length of the coordinates in the metric, where one of them is
    /// larger than it was.
    #[inline]
    pub(crate) fn observe_reach<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) {
        let [q] = &state.q.data.0;
        let sizes = q.iter().zip(&self.sizes);
        if sizes.fold(false, |any, (q, size)| any | (q.abs() > *size)) {
            self.extend_reach(mechanism, state);
        }
    }

    /// Functions of an angle have the round-off of an angle of one, however small it is.
    #[inline(never)]
    fn extend_reach<M: Mechanism<T, N, R> + ?Sized>(&mut self, mechanism: &M, state: &State<T, N>) {
        let mut sizes = state.q;
        for (size, coordinate) in sizes.iter_mut().zip(mechanism.structure().coordinates) {
            *size = size.abs();
            if coordinate.may_be_angle() {
                *size = size.max(T::one());
            }
        }
        let known = self.sizes.iter_mut().zip(&mut self.weights);
        for ((known, weight), size) in known.zip(&sizes) {
            *known = known.max(*size * T::from_f64(REACH_STEP));
            if *known > T::zero() {
                *weight = T::one() / (*known * *known);
            }
        }
        let reach = self.metric.factor.length(&sizes.data.0[0]);
        self.reach = self.reach.max(reach);
    }

    /// Takes note of the squared sine of the constraints at the first state. How far
    /// the first step will go is not known, so it may come near a singular position
    /// from farther away than others.
    #[inline]
    pub(crate) fn begin(&mut self, squared: T) {
        if self.sine.is_none() {
            self.near = !passes(squared, first_guard());
            self.sine = Some(squared.sqrt());
        }
    }

    /// Takes note of the squared sine of the constraints at an accepted state, and
    /// whether the next step comes near a singular position.
    pub(crate) fn observe_sine(&mut self, squared: T) {
        if self.sine.is_none() {
            return self.begin(squared);
        }
        let sine = squared.sqrt();
        let lowest = if self.lowest < squared {
            self.lowest.sqrt()
        } else {
            sine
        };
        let highest = match self.sine {
            Some(before) if before > sine => before,
            _ => sine,
        };
        let change = highest - lowest;
        self.lowest = T::one();
        self.near = sine < guard::<T>() + safe_steps::<T>() * change;
        self.sine = Some(sine);
    }

    /// Learns the rank at a state on the constraints whose position terms are in
    /// the buffer and factorised.
    pub(crate) fn learn<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        let alike = self.rows.all_holonomic();
        for which in [Which::Holonomic, Which::All] {
            if alike && which == Which::Holonomic {
                continue;
            }
            let mut tangent = Tangent::default();
            let known = Known::Nothing;
            self.tangent(
                mechanism,
                state,
                Source::Position,
                which,
                known,
                &mut tangent,
            )?;
            if tangent.used > self.rows.regular(which) {
                self.rows.observe_rank(tangent.used, which);
                if alike {
                    self.rows.observe_rank(tangent.used, Which::Holonomic);
                }
            }
            if which == Which::All && tangent.strong == self.rows.regular(which) {
                self.choose_rows(tangent.rows());
            }
        }
        Ok(())
    }

    /// Chooses an independent subset of the rows, where that is a choice.
    pub(crate) fn choose_rows(&mut self, rows: &SMatrix<T, N, R>) {
        if self.rows.regular(Which::All) < R {
            self.counters.row_choices += 1;
            self.rows.choose(*rows);
        }
    }
}

/// An error if a mechanism that was declared to be regular has a lower rank than that.
fn as_declared<T: Real>(
    structure: &'static Structure,
    t: T,
    rank: usize,
    regular: usize,
) -> Result<(), DynamicsError<T>> {
    if structure.regular && rank < regular {
        return Err(DynamicsError::NotRegular { t, rank, structure });
    }
    Ok(())
}

/// What is known about the state of a rank decision.
#[derive(Clone, Copy)]
pub(crate) enum Known<'a, T, const N: usize, const R: usize> {
    /// The rank at regular positions; the state may be off the constraints.
    Rank,
    /// The same, and that the state is on the constraints to round-off, so that even
    /// small rows tell the truth.
    Landed,
    /// The same as at a state nearby, and how many directions are strong: what is
    /// compared must be decided alike.
    Beside {
        /// What was decided there.
        like: &'a Tangent<T, N, R>,
        /// How many directions are strong.
        strong: usize,
    },
    /// Nothing but that the state is on the constraints to round-off; how many rows
    /// are independent is the question.
    Nothing,
}
