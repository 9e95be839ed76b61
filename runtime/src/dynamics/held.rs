//! The solver that programs have: small, wherever its matrices are.
//!
//! Out: [`Solver`].

use super::{ConstrainedSystem, Core};
use crate::stack::{Held, held, with_room};
use crate::{Counters, Mechanism, Real, Settings};

/// Solves the equations of motion of a mechanism with `N` coordinates and `R`
/// constraint equations.
///
/// It owns the buffers and remembers what accepted states taught about the constraints,
/// but not the mechanism: a program may change inputs and parameters between steps and
/// bind it again with [`on`](Self::on).
///
/// With the standard library its matrices are on the heap, where they are put when it is
/// made; after that nothing is allocated. Without it they are part of it.
#[derive(Debug)]
pub struct Solver<T, const N: usize, const R: usize> {
    core: Held<Core<T, N, R>>,
}

impl<T: Clone, const N: usize, const R: usize> Clone for Solver<T, N, R> {
    fn clone(&self) -> Self {
        with_room::<T, _, N, R>(|| Self {
            core: self.core.clone(),
        })
    }

    /// Without allocating.
    fn clone_from(&mut self, other: &Self) {
        with_room::<T, _, N, R>(|| self.core.clone_from(&other.core));
    }
}

impl<T: Real, const N: usize, const R: usize> Solver<T, N, R> {
    /// A solver that knows nothing yet.
    pub fn new(settings: Settings<T>) -> Self {
        with_room::<T, _, N, R>(|| Self {
            core: held(|| Core::new(settings)),
        })
    }

    /// Becomes a solver that knows nothing yet, in the memory that it has.
    pub fn renew(&mut self, settings: Settings<T>) {
        let core: &mut Core<T, N, R> = &mut self.core;
        with_room::<T, _, N, R>(|| *core = Core::new(settings));
    }

    /// What was done so far.
    pub fn counters(&self) -> Counters {
        self.core.counters()
    }

    /// The system that an integrator sees, for as long as the mechanism does not
    /// change.
    pub fn on<'a, M>(&'a mut self, mechanism: &'a M) -> ConstrainedSystem<'a, M, T, N, R>
    where
        M: Mechanism<T, N, R> + ?Sized,
    {
        self.core.on(mechanism)
    }

    /// Steps follow this error, relative; none if their length is fixed.
    pub(crate) fn expect_error(&mut self, tolerance: Option<T>) {
        self.core.expect_error(tolerance);
    }
}
