//! What positions and velocities of a mechanism of known sizes are assembled in.
//!
//! In:  a mechanism, a state, what is held.
//! Out: the state on the constraints, or [`AssemblyError`].

use super::AssemblyError;
use super::draft::{Assemble, Draft, Refusal};
use super::memory::Memory;
use crate::equations::Bound;
use crate::{Mechanism, Position, Real, State, Terms};
use nalgebra::SVector;

/// What a mechanism of these sizes is assembled in. Positions and velocities share the buffers,
/// since those of a large mechanism take a good part of the stack.
pub(super) struct Room<T, const N: usize, const R: usize> {
    position: Position<T, N, R>,
    terms: Terms<T, N, R>,
    memory: Memory<T, N, R>,
    /// Whether constraints that are independent were found to nearly depend on one another.
    pub(super) near_singular: bool,
}

impl<T: Real, const N: usize, const R: usize> Room<T, N, R> {
    pub(super) fn new() -> Self {
        Self {
            position: Position::default(),
            terms: Terms::default(),
            memory: Memory::new(),
            near_singular: false,
        }
    }

    /// Moves what is not held onto the constraints: coordinates or velocities, by a
    /// routine for any size.
    #[inline(never)]
    pub(super) fn assemble(
        &mut self,
        routine: Assemble<T>,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &mut State<T, N>,
        held: &[bool; N],
    ) -> Result<(), AssemblyError<T, N, R>> {
        let mut equations = Bound {
            mechanism,
            position: &mut self.position,
            terms: &mut self.terms,
        };
        let mut residual = SVector::<T, R>::zeros();
        let mut conflicting = [false; N];
        let draft = Draft {
            t: state.t,
            q: state.q.as_mut_slice(),
            v: state.v.as_mut_slice(),
            held,
            residual: residual.as_mut_slice(),
            conflicting: &mut conflicting,
            near_singular: &mut self.near_singular,
        };
        let Err(refusal) = routine(&mut equations, draft, &self.memory.workspace()) else {
            return Ok(());
        };
        let structure = mechanism.structure();
        Err(match refusal {
            Refusal::NotFinite => AssemblyError::NotFinite { t: state.t },
            Refusal::Positions => AssemblyError::Positions {
                structure,
                residual,
                conflicting,
            },
            Refusal::Velocities => AssemblyError::Velocities {
                structure,
                residual,
                conflicting,
            },
            Refusal::NoBranch => AssemblyError::NoBranch {
                structure,
                held: *held,
            },
            Refusal::ManyBranches(coordinate) => AssemblyError::ManyBranches {
                structure,
                coordinate,
                velocity: state.v[coordinate],
            },
            Refusal::Vanishing(row) => AssemblyError::Vanishing { structure, row },
        })
    }
}
