//! The solver of one mechanism's equations: buffers, what it learned, counts.
//!
//! In:  a mechanism and [`Settings`].
//! Out: a [`ConstrainedSystem`](super::ConstrainedSystem), by [`Core::on`].
//!
//! Nothing allocates after construction: buffers have the sizes of the mechanism; large
//! ones are taken from the heap once.
//!
//! Not here: where it lives itself ([`super::public_solver`]).

use super::conditions::Conditions;
use super::coordinate_scale::CoordinateScale;
use super::{Metric, Rows, SchurComplement, Which};
use crate::linalg::{NotDefinite, is_finite};
use crate::singular::{Memory, Obstacle, Session};
use crate::{
    Acceleration, Correction, Counters, DynamicsError, Mechanism, Position, Real, Settings,
    Singularity, State, Structure, Terms,
};
use nalgebra::{SMatrix, SVector};

/// Solves the equations of motion of a mechanism with `N` coordinates and `R`
/// constraint equations.
///
/// It owns the buffers and remembers what accepted states taught about the constraints,
/// but not the mechanism: a program may change inputs and parameters between steps.
#[derive(Clone, Debug)]
pub(crate) struct Core<T, const N: usize, const R: usize> {
    /// The form of the equations and how the constraints are kept.
    pub(crate) settings: Settings<T>,
    pub(crate) counters: Counters,
    pub(crate) terms: Terms<T, N, R>,
    pub(crate) position: Position<T, N, R>,
    pub(crate) metric: Metric<T, N>,
    pub(crate) rows: Rows<T, R>,
    pub(crate) schur: SchurComplement<T, N, R>,
    /// Memory for code that runs seldom.
    pub(crate) memory: Memory<T, N, R>,
    /// The row that came last where constraints were nearest to dependence.
    pub(crate) weakest: usize,
    pub(crate) acceleration: Acceleration<T, N, R>,
    pub(crate) correction: Correction<T, N, R>,
    pub(crate) session: Session<T, N, R>,
    pub(super) conditions: Conditions<T, N>,
    /// Whether the mechanism provides emitted solves, as far as is known.
    pub(crate) emitted: bool,
    /// Whether emitted code may be called before anything else is asked.
    pub(crate) expected: bool,
    /// The time and position that the general factors at hand belong to.
    pub(crate) safe: Option<(T, SVector<T, N>)>,
    /// The lengths that round-off and differences of positions are measured by.
    pub(crate) coordinate_scale: CoordinateScale<T>,
    /// The sizes of the coordinates up to which these lengths are not measured again.
    pub(crate) sizes: [T; N],
    /// The diagonal of the metric where these lengths were measured; zero for integrals of states.
    pub(crate) weights: [T; N],
    /// How far each coordinate may move in a step that is not long.
    pub(crate) far: [T; N],
    prepared: bool,
}

/// Which buffer terms are in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    Terms,
    Position,
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// A solver that knows nothing yet.
    #[inline(never)]
    pub(crate) fn new(settings: Settings<T>) -> Self {
        Self {
            settings,
            counters: Counters::default(),
            terms: Terms::default(),
            position: Position::default(),
            metric: Metric::default(),
            rows: Rows::new(&Structure::PLAIN),
            schur: SchurComplement::default(),
            memory: Memory::new(),
            weakest: 0,
            acceleration: Acceleration::default(),
            correction: Correction::default(),
            session: Session::new(),
            conditions: Conditions::new(),
            emitted: true,
            expected: false,
            safe: None,
            coordinate_scale: CoordinateScale::default(),
            sizes: [-T::one(); N],
            weights: [T::zero(); N],
            far: [T::zero(); N],
            prepared: false,
        }
    }

    /// Takes over from another solver whether it is prepared, its metric, and the lengths that it
    /// measures coordinates by.
    pub(crate) fn adopt(&mut self, other: &Self) {
        self.prepared = other.prepared;
        self.coordinate_scale = other.coordinate_scale;
        (self.sizes, self.weights) = (other.sizes, other.weights);
        self.metric.clone_from(&other.metric);
        self.safe = None;
        self.expect_regular();
    }

    /// How many directions the constraints leave free at regular states.
    pub(crate) fn freedoms(&self) -> usize {
        N - self.rows.regular
    }

    /// Factorises the metric at the state whose terms are in a buffer.
    pub(crate) fn factorise_metric(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        source: Source,
        t: T,
    ) -> Result<(), DynamicsError<T>> {
        (self.expected, self.safe) = (false, None);
        let (mass, jacobian) = match source {
            Source::Terms => (&self.terms.mass, &self.terms.jacobian),
            Source::Position => (&self.position.mass, &self.position.jacobian),
        };
        factorise(
            (&mut self.metric, &mut self.rows, &mut self.counters),
            (mass, jacobian),
            mechanism.structure(),
            t,
        )
    }

    /// Factorises the metric at a state of a trial step; where that fails because constraints
    /// become dependent, though no row shows it, the step wants a chart.
    pub(crate) fn factorise_trial(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        source: Source,
        t: T,
    ) -> Result<(), DynamicsError<T>> {
        let result = self.factorise_metric(mechanism, source, t);
        let degenerates = matches!(result, Err(DynamicsError::MassSingular { .. }));
        match degenerates && self.follows() && self.metric.hides_dependence() {
            true => Err(self.want_chart(mechanism, t)),
            false => result,
        }
    }

    /// Factorises independent constraints in the metric and returns the smallest
    /// squared sine of a row; zero if none are known to be independent.
    #[inline(never)]
    pub(crate) fn factorise_constraints(&mut self, source: Source, which: Which) -> T {
        let Some(list) = self.rows.active(which) else {
            return T::zero();
        };
        let jacobian = match source {
            Source::Terms => &self.terms.jacobian,
            Source::Position => &self.position.jacobian,
        };
        self.counters.constraint_factorisations += 1;
        self.schur
            .factorise(&self.metric, jacobian, &self.rows, list)
    }

    /// Whether nothing is to be learned before the first state.
    #[inline]
    pub(crate) fn is_prepared(&self) -> bool {
        self.prepared || R == 0
    }

    /// Learns the sizes and the rank of the rows at the first state there is.
    #[cold]
    pub(crate) fn prepare(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if self.is_prepared() {
            return Ok(());
        }
        let structure = mechanism.structure();
        self.rows = Rows::new(structure);
        self.sample_sizes(mechanism, state);
        mechanism.position(state, &mut self.position);
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        self.observe_coordinate_scale(mechanism, state)?;
        self.observe_curvature(mechanism, state);
        self.learn_rank(mechanism, state)?;
        self.prepared = true;
        Ok(())
    }

    /// What a run is told of an obstacle.
    #[inline(never)]
    pub(crate) fn refusal(
        &self,
        mechanism: &dyn Mechanism<T, N, R>,
        obstacle: Obstacle,
        t: T,
    ) -> DynamicsError<T> {
        let structure = mechanism.structure();
        let kind = match obstacle {
            Obstacle::NotFinite => return DynamicsError::NotFinite { t },
            Obstacle::NotRegular | Obstacle::Unresolved => Singularity::Unresolved,
            Obstacle::NotContracting | Obstacle::LeftSheet => Singularity::Turning,
            Obstacle::Touching => Singularity::Touching,
            Obstacle::Drifted => Singularity::Drifted,
            Obstacle::Undetermined => Singularity::Undetermined,
        };
        DynamicsError::SingularConfiguration {
            t,
            kind,
            row: self.weakest,
            structure,
        }
    }
}

/// Factorises a metric.
#[inline(never)]
pub(super) fn factorise<T: Real, const N: usize, const R: usize>(
    (metric, rows, counters): (&mut Metric<T, N>, &mut Rows<T, R>, &mut Counters),
    (mass, jacobian): (&SMatrix<T, N, N>, &SMatrix<T, R, N>),
    structure: &'static Structure,
    t: T,
) -> Result<(), DynamicsError<T>> {
    let result = metric.factorise(mass, jacobian, rows, structure.constant_mass, counters);
    result.map_err(|NotDefinite { row }| {
        match is_finite(mass.as_slice()) && is_finite(jacobian.as_slice()) {
            true => DynamicsError::MassSingular {
                t,
                coordinate: row,
                structure,
            },
            false => DynamicsError::NotFinite { t },
        }
    })
}
