//! Room on the stack for the matrices of large mechanisms.
//!
//! In:  something to do.
//! Out: the same done, on a stack that is large enough for the sizes of the mechanism.
//!
//! Matrices of fixed size are values, which Rust moves and returns through the stack; those
//! of fifty bodies take megabytes each, and a thread has 2 MB. What works on large ones does
//! so on a stack of its own, taken from the system once and kept by the thread. Small
//! mechanisms, and programs without the standard library, have no code for this.

/// A large part of something, kept on the heap so that its owner fits onto any stack.
#[cfg(feature = "std")]
pub(crate) type MaybeBoxed<V> = Box<V>;
/// A large part of something, kept inside its owner, since there is no heap.
#[cfg(not(feature = "std"))]
pub(crate) type MaybeBoxed<V> = V;

/// Makes a large part in place, so that it need not be moved.
#[cfg(feature = "std")]
#[inline(always)]
pub(crate) fn maybe_boxed<V>(make: impl FnOnce() -> V) -> MaybeBoxed<V> {
    Box::write(Box::new_uninit(), make())
}
/// Makes a large part.
#[cfg(not(feature = "std"))]
pub(crate) fn maybe_boxed<V>(make: impl FnOnce() -> V) -> MaybeBoxed<V> {
    make()
}

/// Mechanisms whose matrices of all coordinates and constraint equations are larger than
/// this work on a stack of their own, in bytes.
const SMALL: usize = 16 << 10;
/// How many such matrices are on the stack at once, at most, also without optimisation.
const MATRICES: usize = 64;
/// What else there is room for, observers among it, in bytes: as much as a program begins
/// with. A page that is never touched costs nothing.
const REST: usize = 8 << 20;

/// Does something where there is room for the matrices of a mechanism with `N` coordinates
/// and `R` constraint equations, [`Terms`](crate::Terms) among them.
///
/// What this crate computes finds room by itself; programs that evaluate the equations of
/// large mechanisms themselves do so here. Where the system has no more memory to give, it
/// is done on the stack of the caller.
#[inline(always)]
pub fn with_room<T, V, const N: usize, const R: usize>(work: impl FnOnce() -> V) -> V {
    if const { matrix::<T>(N + R) <= SMALL } {
        return work();
    }
    room::within(const { REST + MATRICES * matrix::<T>(N + R) }, work)
}

/// The size of a square matrix, in bytes.
const fn matrix<T>(n: usize) -> usize {
    n * n * size_of::<T>()
}

#[cfg(all(
    feature = "std",
    any(unix, windows),
    any(
        target_arch = "x86",
        target_arch = "x86_64",
        target_arch = "aarch64",
        target_arch = "arm",
        target_arch = "riscv64",
        target_arch = "loongarch64"
    )
))]
mod room {
    use core::cell::Cell;
    use corosensei::{on_stack, stack::DefaultStack};

    /// A stack, and its size in bytes.
    type StackOfSize = (DefaultStack, usize);

    /// Where the thread is.
    #[derive(Clone, Copy)]
    struct Place {
        /// About the address at which the stack begins that it is on now.
        base: usize,
        /// The size of that stack; zero for its own.
        size: usize,
    }

    std::thread_local! {
        static PLACE: Cell<Place> = const { Cell::new(Place { base: 0, size: 0 }) };
        static KEPT: Cell<Option<StackOfSize>> = const { Cell::new(None) };
    }

    /// Says that the thread is back when it is, also by a panic.
    struct Back(Place);

    impl Drop for Back {
        fn drop(&mut self) {
            PLACE.set(self.0);
        }
    }

    /// About the address at which the stack ends.
    #[inline(always)]
    fn here() -> usize {
        let mark = 0_u8;
        core::hint::black_box(core::ptr::from_ref(&mark)).addr()
    }

    /// Does something on a stack of this size, of which a quarter may be in use already.
    #[inline(always)]
    pub(super) fn within<V>(size: usize, work: impl FnOnce() -> V) -> V {
        let Place { base, size: whole } = PLACE.get();
        if whole.saturating_sub(base.wrapping_sub(here())) >= size - size / 4 {
            return apart(work);
        }
        switched(size, work)
    }

    /// The work may need most of the stack, so it is not inlined into its caller.
    #[inline(never)]
    fn apart<V>(work: impl FnOnce() -> V) -> V {
        work()
    }

    #[cold]
    #[inline(never)]
    fn switched<V>(size: usize, work: impl FnOnce() -> V) -> V {
        let kept = KEPT.take().filter(|(_, kept)| *kept >= size);
        let taken = kept.or_else(|| Some((DefaultStack::new(size).ok()?, size)));
        let Some((mut stack, size)) = taken else {
            // The system has no more memory to give: perhaps this stack does.
            return apart(work);
        };
        let done = on_stack(&mut stack, || {
            let base = here();
            let _back = Back(PLACE.replace(Place { base, size }));
            work()
        });
        KEPT.set(Some((stack, size)));
        done
    }
}

#[cfg(not(all(
    feature = "std",
    any(unix, windows),
    any(
        target_arch = "x86",
        target_arch = "x86_64",
        target_arch = "aarch64",
        target_arch = "arm",
        target_arch = "riscv64",
        target_arch = "loongarch64"
    )
)))]
mod room {
    /// Does something on the stack that there is.
    #[inline(always)]
    pub(super) fn within<V>(_size: usize, work: impl FnOnce() -> V) -> V {
        work()
    }
}
