//! What an observer may ask about a mechanism, whatever its sizes.
//!
//! In:  a state.
//! Out: energies, constraint errors, rank, reactions.

use crate::dynamics::ConstrainedSystem;
use crate::linalg::{dot, is_zero};
use crate::{
    ConstraintError, DynamicsError, Energy, Interface, Mechanism, Position, Rank, Real, State,
    Structure,
};
use nalgebra::SVector;

/// What to do with a state within a step that is nearer to another branch of motion than to
/// its own, by more than the end of a step may be off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OtherBranch {
    /// Refuse it: nothing tells whether its own branch is still the one that is followed.
    Refused,
    /// Bring it back onto its own: it may lie exactly where branches cross.
    Crossed,
}

/// Answers questions about a mechanism at a state.
pub trait Probe<T: Real, const N: usize> {
    /// What was known when the mechanism's code was generated.
    fn structure(&self) -> &'static Structure;

    /// Energies (J).
    fn energy(&self, state: &State<T, N>) -> Energy<T>;

    /// The rate of [`Energy::balance`] (W): [`Energy::power`] and the power of
    /// the reactions of moving constraints.
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] if the reactions are needed and can't be computed.
    fn power(&mut self, state: &State<T, N>) -> Result<T, DynamicsError<T>>;

    /// How far the state is off the constraints.
    fn constraint_error(&mut self, state: &State<T, N>) -> ConstraintError<T>;

    /// The rank of the constraints.
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] if it can't be decided.
    fn rank(&mut self, state: &State<T, N>) -> Result<Rank<T>, DynamicsError<T>>;

    /// The generalized reaction forces `r` (N or N·m).
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] if the acceleration can't be computed.
    fn reaction(&mut self, state: &State<T, N>) -> Result<SVector<T, N>, DynamicsError<T>>;

    /// The acceleration. Writes the multipliers of the constraints, `r = Aᵀλ`, as many as
    /// there is room for; none where constraints depend on one another, so that nothing
    /// tells how they share their reactions.
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] if it can't be computed.
    fn acceleration(
        &mut self,
        state: &State<T, N>,
        multipliers: &mut [Option<T>],
    ) -> Result<SVector<T, N>, DynamicsError<T>>;

    /// Brings a state within a step back onto the constraints.
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] if that fails.
    fn project(
        &mut self,
        state: &mut State<T, N>,
        other: OtherBranch,
    ) -> Result<(), DynamicsError<T>>;

    /// Writes the outputs and the inputs, as many as there is room for.
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] if some are of accelerations, which can't be computed.
    fn outputs(
        &mut self,
        state: &State<T, N>,
        outputs: &mut [T],
        inputs: &mut [T],
    ) -> Result<(), DynamicsError<T>>;
}

impl<M, T, const N: usize, const R: usize> Probe<T, N> for ConstrainedSystem<'_, M, T, N, R>
where
    T: Real,
    M: Mechanism<T, N, R> + Interface<T, N> + ?Sized,
{
    fn structure(&self) -> &'static Structure {
        self.mechanism().structure()
    }

    fn energy(&self, state: &State<T, N>) -> Energy<T> {
        self.mechanism().energy(state)
    }

    fn power(&mut self, state: &State<T, N>) -> Result<T, DynamicsError<T>> {
        let supplied = self.mechanism().energy(state).power + self.sliding_power(state)?;
        let mut position = Position::<T, N, R>::default();
        self.mechanism().position(state, &mut position);
        if is_zero(position.drift.as_slice()) {
            // Constraints at rest do no work.
            return Ok(supplied);
        }
        let reaction = Probe::reaction(self, state)?;
        // The reactions stand on the left: M q̈ + r = p₁.
        Ok(supplied - dot(reaction.as_slice(), state.v.as_slice()))
    }

    fn constraint_error(&mut self, state: &State<T, N>) -> ConstraintError<T> {
        ConstrainedSystem::constraint_error(self, state)
    }

    fn rank(&mut self, state: &State<T, N>) -> Result<Rank<T>, DynamicsError<T>> {
        ConstrainedSystem::rank(self, state)
    }

    fn reaction(&mut self, state: &State<T, N>) -> Result<SVector<T, N>, DynamicsError<T>> {
        self.reaction_within(state)
    }

    fn acceleration(
        &mut self,
        state: &State<T, N>,
        multipliers: &mut [Option<T>],
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        if !multipliers.is_empty() {
            let found = self.multipliers_within(state)?;
            for (place, value) in multipliers.iter_mut().zip(found) {
                *place = value;
            }
        }
        self.acceleration_within(state)
    }

    fn project(
        &mut self,
        state: &mut State<T, N>,
        other: OtherBranch,
    ) -> Result<(), DynamicsError<T>> {
        match other {
            OtherBranch::Refused => self.project_within(state),
            OtherBranch::Crossed => self.project_past(state),
        }
    }

    fn outputs(
        &mut self,
        state: &State<T, N>,
        outputs: &mut [T],
        inputs: &mut [T],
    ) -> Result<(), DynamicsError<T>> {
        let mechanism = self.mechanism();
        mechanism.outputs(state, outputs);
        let acceleration = match mechanism.structure().accelerated && !outputs.is_empty() {
            true => self.acceleration_within(state)?,
            false => SVector::zeros(),
        };
        mechanism.signals(state, &acceleration, outputs, inputs);
        Ok(())
    }
}
