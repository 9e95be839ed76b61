//! A mechanism with its solver: what integrators and observers talk to.
//!
//! In:  states.
//! Out: accelerations, reactions, projections, rank, constraint errors.

use super::solver::{Known, Source};
use super::{Solver, Tangent, Which};
use crate::linalg::{passes, reported_rank, weak};
use crate::{Counters, DynamicsError, Mechanism, Real, Slope, State, System};
use nalgebra::SVector;

/// A mechanism bound to the solver of its equations, by [`Solver::on`].
#[derive(Debug)]
pub struct ConstrainedSystem<'a, M: ?Sized, T, const N: usize, const R: usize> {
    mechanism: &'a M,
    solver: &'a mut Solver<T, N, R>,
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

impl<'a, M, T: Real, const N: usize, const R: usize> ConstrainedSystem<'a, M, T, N, R>
where
    M: Mechanism<T, N, R> + ?Sized,
{
    pub(super) fn new(mechanism: &'a M, solver: &'a mut Solver<T, N, R>) -> Self {
        Self { mechanism, solver }
    }

    /// The mechanism.
    pub fn mechanism(&self) -> &'a M {
        self.mechanism
    }

    /// What was done so far.
    pub fn counters(&self) -> Counters {
        self.solver.counters
    }

    /// The acceleration `q̈` and the generalized reaction forces `r` of the
    /// constraints (`N` each; N or N·m), `M q̈ + r = p₁`.
    ///
    /// `r` is unique where multipliers are not: redundant constraints share it in a
    /// way that the equations of motion do not determine.
    ///
    /// # Errors
    ///
    /// As [`System::acceleration`].
    pub fn reaction(
        &mut self,
        state: &State<T, N>,
    ) -> Result<(SVector<T, N>, SVector<T, N>), DynamicsError<T>> {
        let acceleration = self.acceleration(state)?;
        self.mechanism.terms(state, &mut self.solver.terms);
        let terms = &self.solver.terms;
        Ok((acceleration, terms.force - terms.mass * acceleration))
    }

    /// The rank of the constraints at a position, which should be on them.
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] if the mass matrix is singular or something is not
    /// finite.
    pub fn rank(&mut self, state: &State<T, N>) -> Result<Rank<T>, DynamicsError<T>> {
        let solver = &mut *self.solver;
        if R == 0 {
            return Ok(Rank {
                rank: 0,
                regular: 0,
                sine: T::one(),
            });
        }
        solver.prepare(self.mechanism, state)?;
        self.mechanism.position(state, &mut solver.position);
        solver.safe = None;
        solver.factorise_metric(self.mechanism, Source::Position, state.t)?;
        let regular = solver.rows.regular(Which::All);
        let list = solver.rows.active(Which::All);
        let squared = list.map(|list| {
            let jacobian = &solver.position.jacobian;
            let rows = &mut solver.rows;
            solver
                .lifted
                .factorise(&solver.metric, jacobian, rows, list)
        });
        if let Some(squared) = squared.filter(|squared| passes(*squared, weak())) {
            return Ok(Rank {
                rank: regular,
                regular,
                sine: squared.sqrt(),
            });
        }
        let (mut tangent, known) = (Tangent::default(), Known::Rank);
        let (source, all) = (Source::Position, Which::All);
        solver.tangent(self.mechanism, state, source, all, known, &mut tangent)?;
        let not_finite = |_| DynamicsError::NotFinite { t: state.t };
        tangent.refine(-T::one()).map_err(not_finite)?;
        let values = tangent.values();
        let rank = values.iter().filter(|&&x| x > reported_rank()).count();
        let weakest = values.iter().fold(T::one(), |least, &x| least.min(x));
        let sine = squared.map_or(weakest, |squared| squared.sqrt());
        Ok(Rank {
            rank,
            regular,
            sine,
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
        self.mechanism.position(state, position);
        let velocity = position.jacobian * state.v + position.drift;
        for row in 0..R {
            error.position = larger(error.position, position.residual[row].abs());
            error.velocity = larger(error.velocity, velocity[row].abs());
        }
        error
    }
}

/// The larger of two sizes; not finite if one of them is not.
fn larger<T: Real>(a: T, b: T) -> T {
    if b > a || !b.is_finite() { b } else { a }
}

impl<M, T: Real, const N: usize, const R: usize> System<T, N> for ConstrainedSystem<'_, M, T, N, R>
where
    M: Mechanism<T, N, R> + ?Sized,
{
    #[inline]
    fn acceleration(&mut self, state: &State<T, N>) -> Result<SVector<T, N>, DynamicsError<T>> {
        self.solver.acceleration(self.mechanism, state)
    }

    fn project(&mut self, state: &mut State<T, N>) -> Result<(), DynamicsError<T>> {
        self.solver.project(self.mechanism, state)
    }

    fn slope(&mut self, state: &State<T, N>) -> Option<Slope<T, N>> {
        self.solver.slope(self.mechanism, state)
    }
}
