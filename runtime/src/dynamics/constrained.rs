//! A mechanism with its solver: what integrators and observers talk to.
//!
//! In:  states.
//! Out: accelerations, reactions, projections, rank, constraint errors.

use super::turns::check_angles;
use super::{Core, Source, Which};
use crate::singular::Found;
use crate::stack::with_room;
use crate::system::escalating;
use crate::tolerance::{passes, regular, window};
use crate::{
    AccelerationJacobian, Counters, DynamicsError, Mechanism, Real, Sides, State, Step, Switches,
    Switching, System,
};
use nalgebra::{SMatrix, SVector};

/// A mechanism bound to the solver of its equations, by [`Solver::on`](crate::Solver::on).
#[derive(Debug)]
pub struct ConstrainedSystem<'a, M: ?Sized, T, const N: usize, const R: usize> {
    pub(super) mechanism: &'a M,
    pub(super) solver: &'a mut Core<T, N, R>,
}

/// Rank of the constraints at a position, and how far it is from falling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rank<T> {
    /// How many constraint equations are independent here.
    pub rank: usize,
    /// How many are at regular positions, as far as is known.
    pub regular: usize,
    /// Sine of the angle by which the weakest row is independent of the others, in
    /// the metric of the kinetic energy and relative to the row's usual size: one
    /// or less, zero in a singular position, free of units.
    pub sine: T,
}

/// How far a state is off the constraints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConstraintError<T> {
    /// `max |g|`, in the units of the rows.
    pub position: T,
    /// `max |A q̇ + b|`, in the units of the rows per second.
    pub velocity: T,
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// The system that an integrator sees, for as long as the mechanism does not
    /// change.
    pub(crate) fn on<'a, M>(&'a mut self, mechanism: &'a M) -> ConstrainedSystem<'a, M, T, N, R>
    where
        M: Mechanism<T, N, R> + ?Sized,
    {
        self.metric.forget();
        self.session.nodes.forget();
        self.safe = None;
        self.expect_regular();
        let conditions = match self.settings.across_switches {
            true => &[],
            false => {
                let (state, still) = (State::default(), SVector::zeros());
                mechanism.switches(&state, &still, &mut Switches::of(Sides::FREE, &mut []))
            }
        };
        self.conditions.forget(conditions);
        ConstrainedSystem {
            mechanism,
            solver: self,
        }
    }
}

impl<'a, M, T: Real, const N: usize, const R: usize> ConstrainedSystem<'a, M, T, N, R>
where
    M: Mechanism<T, N, R> + ?Sized,
{
    /// The mechanism.
    pub fn mechanism(&self) -> &'a M {
        self.mechanism
    }

    /// What was done so far.
    pub fn counters(&self) -> Counters {
        self.solver.counters
    }

    /// The acceleration `q̈` (m/s² or rad/s²) at a state on the constraints, whatever
    /// state was asked about before.
    ///
    /// # Errors
    ///
    /// As [`System::acceleration`]; in a singular configuration also where nothing tells
    /// which sheet of the constraint set is meant.
    pub fn acceleration(&mut self, state: &State<T, N>) -> Result<SVector<T, N>, DynamicsError<T>> {
        with_room::<T, _, N, R>(|| {
            self.solver.begin_step(state);
            self.solver.release();
            escalating(self, |system| {
                system.solver.acceleration(system.mechanism, state)
            })
        })
    }

    /// Begins at a state, which is moved onto the constraints if it is not on them to
    /// round-off, and decides the conditions of forces there.
    #[inline(never)]
    pub(crate) fn start(
        &mut self,
        state: &mut State<T, N>,
        tolerance: Option<T>,
    ) -> Result<(), DynamicsError<T>> {
        check_angles(self.mechanism.structure(), state.t, state.q.as_slice())?;
        self.solver.session.tolerance = tolerance;
        self.solver.begin_step(state);
        if R > 0 && self.solver.is_projected() {
            self.put_onto_constraints(state)?;
        }
        escalating(self, |system| {
            system.solver.settle(&system.mechanism, state)
        })
    }

    fn put_onto_constraints(&mut self, state: &mut State<T, N>) -> Result<(), DynamicsError<T>> {
        self.solver.prepare(&self.mechanism, state)?;
        let mut placed = *state;
        self.project_within(&mut placed)?;
        self.solver.start(&self.mechanism, state, &placed)
    }

    /// Brings a state near the constraints onto them, positions, then velocities, whatever
    /// state was asked about before.
    ///
    /// # Errors
    ///
    /// As [`System::project`]; in a singular configuration also where nothing tells which
    /// sheet of the constraint set is meant.
    pub fn project(&mut self, state: &mut State<T, N>) -> Result<(), DynamicsError<T>> {
        with_room::<T, _, N, R>(|| {
            self.solver.begin_step(state);
            self.project_within(state)
        })
    }

    /// Brings a state within a step back onto the constraints.
    pub(crate) fn project_within(
        &mut self,
        state: &mut State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        self.project_past(state)?;
        self.solver.refuse_strayed(&self.mechanism, state.t)
    }

    /// Brings a state within a step back onto the constraints, also if it is moved past another
    /// sheet.
    pub(crate) fn project_past(&mut self, state: &mut State<T, N>) -> Result<(), DynamicsError<T>> {
        let solver = &mut *self.solver;
        if solver.session.chart.is_none() {
            solver.begin_step(state);
        }
        *state = escalating(self, |system| {
            let mut projected = *state;
            system.solver.project(system.mechanism, &mut projected)?;
            Ok::<_, DynamicsError<T>>(projected)
        })?;
        Ok(())
    }

    /// The rank of the constraints at a position, which should be on them.
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] if the mass matrix is singular or something is not
    /// finite.
    pub fn rank(&mut self, state: &State<T, N>) -> Result<Rank<T>, DynamicsError<T>> {
        with_room::<T, _, N, R>(|| self.decided_rank(state))
    }

    #[inline(never)]
    fn decided_rank(&mut self, state: &State<T, N>) -> Result<Rank<T>, DynamicsError<T>> {
        let solver = &mut *self.solver;
        if R == 0 {
            return Ok(Rank {
                rank: 0,
                regular: 0,
                sine: T::one(),
            });
        }
        solver.prepare(&self.mechanism, state)?;
        self.mechanism.position(state, &mut solver.position);
        solver.factorise_metric(&self.mechanism, Source::Position, state.t)?;
        let full = solver.rows.regular;
        let squared = solver.factorise_constraints(Source::Position, Which::All);
        if passes(squared, window()) {
            return Ok(Rank {
                rank: full,
                regular: full,
                sine: squared.sqrt(),
            });
        }
        let (mut rank, mut sine) = (0, T::one());
        solver.decompose(Source::Position, state.t, &mut |decomposition| {
            rank = decomposition.above(regular()).min(full);
            for value in &decomposition.values[..full] {
                sine = sine.min(*value);
            }
        })?;
        Ok(Rank {
            rank,
            regular: full,
            sine,
        })
    }

    /// The passages after a time of a step that was accepted last; none where it was far
    /// from singular configurations.
    pub(crate) fn passages_after(&mut self, step: &Step<T, N>, after: T) -> Option<Found<T>> {
        self.solver.passages_after(&self.mechanism, step, after)
    }

    /// Takes over what another solver of the same mechanism knows about its last
    /// accepted state.
    #[inline(never)]
    pub(crate) fn follow(&mut self, other: &Self) {
        let (here, there) = (&mut *self.solver, &*other.solver);
        here.conditions.decided.adopt(&there.conditions.decided);
        let chart = there
            .session
            .step_chart
            .as_ref()
            .or(there.session.chart.as_ref());
        if here.session.chart.is_some() || chart.is_some() {
            here.session.base = there.session.base;
            here.session.chart = chart.copied();
            here.session.near = there.session.near;
            here.rows.clone_from(&there.rows);
            here.adopt(there);
        }
    }

    /// How the acceleration changes with coordinates and velocities, and with applied forces,
    /// `∂q̈/∂p₁`, by the emitted linearisation; `None` where there is none, near singular
    /// positions and with Baumgarte's stabilisation.
    pub fn acceleration_jacobian_and_compliance(
        &mut self,
        state: &State<T, N>,
    ) -> Option<(AccelerationJacobian<T, N>, SMatrix<T, N, N>)> {
        with_room::<T, _, N, R>(|| {
            let jacobian = self.solver.acceleration_jacobian(&self.mechanism, state)?;
            Some((jacobian, self.solver.compliance()))
        })
    }

    /// How far a state is off the constraints.
    pub fn constraint_error(&mut self, state: &State<T, N>) -> ConstraintError<T> {
        let mut error = ConstraintError {
            position: T::zero(),
            velocity: T::zero(),
        };
        if R == 0 {
            return error;
        }
        let position = &mut self.solver.position;
        with_room::<T, _, N, R>(|| self.mechanism.position(state, position));
        let velocity = position.speed(&state.v);
        for row in 0..R {
            error.position = error.position.max(position.residual[row].abs());
            error.velocity = error.velocity.max(velocity[row].abs());
        }
        error
    }
}

impl<M, T: Real, const N: usize, const R: usize> System<T, N> for ConstrainedSystem<'_, M, T, N, R>
where
    M: Mechanism<T, N, R> + ?Sized,
{
    #[inline]
    fn begin(&mut self, state: &State<T, N>) -> bool {
        self.solver.begin_step(state);
        self.solver.hold(&self.mechanism, state)
    }

    #[inline]
    fn acceleration(&mut self, state: &State<T, N>) -> Result<SVector<T, N>, DynamicsError<T>> {
        with_room::<T, _, N, R>(|| self.solver.held_acceleration(self.mechanism, state))
    }

    fn project(&mut self, state: &mut State<T, N>) -> Result<(), DynamicsError<T>> {
        with_room::<T, _, N, R>(|| {
            self.solver.project(self.mechanism, state)?;
            self.solver.refuse_strayed(&self.mechanism, state.t)?;
            self.solver.project_sliding(&self.mechanism, state)
        })
    }

    fn escalate(&mut self) -> Result<bool, DynamicsError<T>> {
        self.solver.escalate(&self.mechanism)
    }

    fn verify(&mut self, start: &State<T, N>, end: &State<T, N>) -> Result<(), DynamicsError<T>> {
        self.solver.verify(&self.mechanism, start, end)
    }

    fn switch(&mut self, step: &mut Step<T, N>) -> Result<Switching<T>, DynamicsError<T>> {
        match self.solver.switch(&self.mechanism, step)? {
            Switching::Nowhere if self.solver.changes_chart() => Ok(Switching::AtEnd),
            found => Ok(found),
        }
    }

    fn commit(&mut self, step: &Step<T, N>) -> Result<(), DynamicsError<T>> {
        self.solver.commit(&self.mechanism, step)
    }

    fn acceleration_jacobian(&mut self, state: &State<T, N>) -> Option<AccelerationJacobian<T, N>> {
        with_room::<T, _, N, R>(|| self.solver.acceleration_jacobian(&self.mechanism, state))
    }

    fn extents(&self) -> SVector<T, N> {
        self.solver.extents(self.mechanism.structure())
    }
}
