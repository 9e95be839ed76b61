//! Reactions of constraints, and how constraints share them.
//!
//! In:  states.
//! Out: the generalized reaction forces `r = p₁ − M q̈`, the multipliers `λ` of
//!      `r = Aᵀλ`, as far as they are determined.

use super::{ConstrainedSystem, Core};
use crate::linalg::{add_scaled, dot};
use crate::stack::with_room;
use crate::system::escalating;
use crate::{DynamicsError, Mechanism, Real, Sides, State};
use nalgebra::SVector;

impl<M, T: Real, const N: usize, const R: usize> ConstrainedSystem<'_, M, T, N, R>
where
    M: Mechanism<T, N, R> + ?Sized,
{
    /// The acceleration `q̈` and the generalized reaction forces `r` of the
    /// constraints (`N` each; N or N·m), `M q̈ + r = p₁`.
    ///
    /// `r` is unique where multipliers are not: redundant constraints share it in a
    /// way that the equations of motion do not determine.
    ///
    /// # Errors
    ///
    /// As [`acceleration`](Self::acceleration).
    pub fn reaction(
        &mut self,
        state: &State<T, N>,
    ) -> Result<(SVector<T, N>, SVector<T, N>), DynamicsError<T>> {
        let acceleration = self.acceleration(state)?;
        with_room::<T, _, N, R>(|| self.mechanism.terms(state, &mut self.solver.terms));
        let terms = &self.solver.terms;
        let mut reaction = terms.force;
        terms.take_inertia(&mut reaction, &acceleration);
        Ok((acceleration, reaction))
    }

    /// The multipliers `λ` of the constraints, `r = Aᵀλ`, in their order; none where the
    /// constraint depends on others, so that nothing tells how they share their
    /// reactions.
    ///
    /// # Errors
    ///
    /// As [`acceleration`](Self::acceleration).
    pub fn multipliers(&mut self, state: &State<T, N>) -> Result<[Option<T>; R], DynamicsError<T>> {
        with_room::<T, _, N, R>(|| {
            let (_, reaction) = self.reaction(state)?;
            self.solver.shares_of(&self.mechanism, state, &reaction)
        })
    }

    /// The acceleration at a state within a step from the last accepted one, with the
    /// conditions of that step, or at any other.
    pub(crate) fn acceleration_within(
        &mut self,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let charted = self.solver.session.chart.is_some();
        let Some((sides, _)) = self.solver.conditions.decided.made else {
            return match charted {
                true => self.solver.acceleration(self.mechanism, state),
                false => self.acceleration(state),
            };
        };
        self.solver.decide(sides);
        if charted {
            return self.solver.held_acceleration(self.mechanism, state);
        }
        self.solver.begin_step(state);
        escalating(self, |system| {
            system.solver.held_acceleration(system.mechanism, state)
        })
    }

    /// The reaction within a step; see [`acceleration_within`](Self::acceleration_within).
    pub(crate) fn reaction_within(
        &mut self,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let acceleration = self.acceleration_within(state)?;
        Ok(self
            .solver
            .held_reaction(&self.mechanism, state, &acceleration))
    }

    /// By how much the power of the applied forces within a step, of a motion that slides, differs
    /// from that of the forces that its state alone would give: friction that holds a body on a
    /// belt moves it.
    pub(crate) fn sliding_power(&mut self, state: &State<T, N>) -> Result<T, DynamicsError<T>> {
        let slides = |(_, sliding)| sliding != 0;
        if !self.solver.conditions.decided.made.is_some_and(slides) {
            return Ok(T::zero());
        }
        // The weights of the forces are those of this state.
        self.acceleration_within(state)?;
        Ok(self.solver.held_power(&self.mechanism, state))
    }

    /// The multipliers within a step; see [`acceleration_within`](Self::acceleration_within).
    pub(crate) fn multipliers_within(
        &mut self,
        state: &State<T, N>,
    ) -> Result<[Option<T>; R], DynamicsError<T>> {
        let reaction = self.reaction_within(state)?;
        self.solver.shares_of(&self.mechanism, state, &reaction)
    }
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// `p₁ − M q̈`, of a motion that slides with the weights of its forces.
    #[inline(never)]
    fn held_reaction(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        acceleration: &SVector<T, N>,
    ) -> SVector<T, N> {
        let mut reaction = self.held_force(mechanism, state);
        self.terms.take_inertia(&mut reaction, acceleration);
        reaction
    }

    /// By how much the power of the forces differs from what a state says of them, with their
    /// conditions held, and the weights of those that the motion slides along.
    #[inline(never)]
    pub(super) fn held_power(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> T {
        let sides = self.terms.sides;
        let held = self.held_force(mechanism, state);
        self.terms.sides = Sides::FREE;
        mechanism.terms(state, &mut self.terms);
        self.terms.sides = sides;
        let more = held - self.terms.force;
        // States of the first order, which come last, have rates but no power.
        let freedoms = mechanism.structure().freedoms().len();
        dot(
            &more.as_slice()[..freedoms],
            &state.v.as_slice()[..freedoms],
        )
    }

    /// `p₁`, of a motion that slides with the weights of its forces.
    #[inline(never)]
    fn held_force(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> SVector<T, N> {
        let terms = &mut self.terms;
        let decided = &self.conditions.decided;
        let sides = terms.sides;
        let mut below = sides;
        let mut force = SVector::<T, N>::zeros();
        let mut add = |sides, weight| {
            terms.sides = sides;
            mechanism.terms(state, terms);
            add_scaled(force.as_mut_slice(), weight, terms.force.as_slice());
        };
        let sliding = (0..decided.list.len()).filter(|index| decided.slides(*index));
        for index in sliding.clone() {
            below.hold(index as u32, false);
        }
        for index in sliding {
            let mut above = below;
            above.hold(index as u32, true);
            let weight = decided.weights[index];
            add(above, weight);
            add(below, -weight);
        }
        add(below, T::one());
        terms.sides = sides;
        force
    }
}
