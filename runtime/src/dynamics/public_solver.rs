//! The public solver: its matrices live in it where they are small, else on the heap.
//!
//! Out: [`Solver`].

use super::{ConstrainedSystem, Core};
use crate::stack::{MaybeBoxed, maybe_boxed, with_room};
use crate::{Counters, Mechanism, Real, Settings, Structure};
use core::ptr;

/// Solves the equations of motion of a mechanism with `N` coordinates and `R`
/// constraint equations.
///
/// It owns the buffers and remembers what accepted states taught about the constraints,
/// but not the mechanism: a program may change inputs and parameters between steps and
/// bind it again with [`on`](Self::on). With another mechanism it begins anew.
///
/// With the standard library, its matrices are on the heap, where they are put when the solver is
/// made; after that nothing is allocated. Without the standard library, they are part of the
/// solver.
#[derive(Debug)]
pub struct Solver<T, const N: usize, const R: usize> {
    core: MaybeBoxed<Core<T, N, R>>,
    /// What is known of the mechanism that it was bound to last.
    structure: Option<&'static Structure>,
}

impl<T: Clone, const N: usize, const R: usize> Clone for Solver<T, N, R> {
    fn clone(&self) -> Self {
        with_room::<T, _, N, R>(|| Self {
            core: self.core.clone(),
            structure: self.structure,
        })
    }

    /// Without allocating.
    fn clone_from(&mut self, other: &Self) {
        with_room::<T, _, N, R>(|| self.core.clone_from(&other.core));
        self.structure = other.structure;
    }
}

impl<T: Real, const N: usize, const R: usize> Solver<T, N, R> {
    /// A solver that knows nothing yet.
    pub fn new(settings: Settings<T>) -> Self {
        with_room::<T, _, N, R>(|| Self {
            core: maybe_boxed(|| Core::new(settings)),
            structure: None,
        })
    }

    /// Becomes a solver that knows nothing yet, in the memory that it has.
    pub fn renew(&mut self, settings: Settings<T>) {
        let core: &mut Core<T, N, R> = &mut self.core;
        with_room::<T, _, N, R>(|| *core = Core::new(settings));
        self.structure = None;
    }

    /// What was done so far.
    pub fn counters(&self) -> Counters {
        self.core.counters
    }

    /// The system that an integrator sees, for as long as the mechanism does not
    /// change.
    pub fn on<'a, M>(&'a mut self, mechanism: &'a M) -> ConstrainedSystem<'a, M, T, N, R>
    where
        M: Mechanism<T, N, R> + ?Sized,
    {
        self.bind(mechanism.structure());
        self.core.on(mechanism)
    }

    /// What it works with.
    pub(super) fn core(&mut self) -> &mut Core<T, N, R> {
        &mut self.core
    }

    /// Begins anew where the mechanism is another one: code writes no entry that is zero by
    /// structure, so what another mechanism has left there would be taken for its own.
    #[inline]
    pub(crate) fn bind(&mut self, structure: &'static Structure) {
        let is_known = self
            .structure
            .is_some_and(|known| ptr::eq(known, structure));
        if !is_known {
            self.bind_anew(structure);
        }
    }

    #[inline(never)]
    fn bind_anew(&mut self, structure: &'static Structure) {
        // A structure that is no static may have several addresses.
        if self.structure.is_some_and(|known| known != structure) {
            let counters = self.core.counters;
            self.renew(self.core.settings);
            self.core.counters = counters;
        }
        self.structure = Some(structure);
    }

    /// Steps follow this error, relative; none if their length is fixed.
    pub(crate) fn expect_error(&mut self, tolerance: Option<T>) {
        self.core.session.tolerance = tolerance;
    }
}
