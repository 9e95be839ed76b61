//! What a C program holds in its hands.
//!
//! In:  a pointer, what to do.
//! Out: a [`Status`].
//!
//! A call that comes while another is at work on the same handle, from a second thread or
//! from a callback, is turned away: so nothing is ever borrowed twice. A panic ends here.

use crate::Embedded;
use crate::abi::{Handle, Interface};
use crate::engine::{Engine, Outcome};
use crate::status::Status;
use core::any::TypeId;
use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicBool, Ordering};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A mechanism, as it is.
#[repr(C)]
pub(crate) struct Body<M, const N: usize, const R: usize> {
    handle: Handle,
    /// Whether a call is at work.
    busy: AtomicBool,
    /// Whether a run is to end.
    pub(crate) stop: AtomicBool,
    /// Whether a call has panicked, so that nothing is known of what is inside.
    broken: AtomicBool,
    engine: UnsafeCell<Engine<M, N, R>>,
}

impl<M: Embedded<N, R>, const N: usize, const R: usize> Body<M, N, R> {
    /// Puts an engine into a place of its own.
    pub(crate) fn boxed(interface: &'static Interface, engine: Engine<M, N, R>) -> *mut Handle {
        let body = Box::new(Self {
            handle: Handle {
                interface,
                kind: TypeId::of::<M>(),
            },
            busy: AtomicBool::new(false),
            stop: AtomicBool::new(false),
            broken: AtomicBool::new(false),
            engine: UnsafeCell::new(engine),
        });
        Box::into_raw(body).cast()
    }

    /// The body behind a pointer, if it is not null.
    ///
    /// # Safety
    ///
    /// The pointer is null or came from [`boxed`](Self::boxed) for the same mechanism, and was
    /// not freed.
    pub(crate) unsafe fn of<'a>(handle: *mut Handle) -> Option<&'a Self> {
        // SAFETY: as promised; what is inside is only ever shared, but for the engine, which
        // is borrowed by `lend` alone.
        unsafe { handle.cast::<Self>().as_ref() }
    }

    /// Whether a handle is one of this mechanism.
    ///
    /// # Safety
    ///
    /// The handle is null or came from the table of any mechanism, and was not freed.
    pub(crate) unsafe fn is_of(handle: *mut Handle) -> bool {
        // SAFETY: as promised; the handle is what every body begins with.
        unsafe { handle.as_ref() }.is_none_or(|handle| handle.kind == TypeId::of::<M>())
    }

    /// Gives a body back.
    ///
    /// # Safety
    ///
    /// As [`of`](Self::of), and nobody uses it any more.
    pub(crate) unsafe fn drop_boxed(handle: *mut Handle) {
        if !handle.is_null() {
            // SAFETY: it was made by `Box::into_raw` in `boxed`.
            drop(unsafe { Box::from_raw(handle.cast::<Self>()) });
        }
    }

    /// Does something with the engine of a handle, alone.
    ///
    /// # Safety
    ///
    /// As [`of`](Self::of).
    pub(crate) unsafe fn enter(
        handle: *mut Handle,
        act: impl FnOnce(&mut Engine<M, N, R>) -> Outcome,
    ) -> Status {
        // SAFETY: as promised.
        match unsafe { Self::of(handle) } {
            Some(body) => body.lend(act),
            None => Status::Null,
        }
    }

    /// Does something with the engine, alone.
    pub(crate) fn lend(&self, act: impl FnOnce(&mut Engine<M, N, R>) -> Outcome) -> Status {
        if self.broken.load(Ordering::Relaxed) {
            return Status::Panic;
        }
        if self.busy.swap(true, Ordering::Acquire) {
            return Status::Busy;
        }
        // SAFETY: `busy` was false and is true until the end of this call, so that no other
        // borrow of the engine exists.
        let engine = unsafe { &mut *self.engine.get() };
        let status = caught(|| {
            engine.text.is_new = false;
            match act(engine) {
                Ok(()) => Status::Ok,
                Err(status) => {
                    // The message of an earlier call would mislead.
                    if !engine.text.is_new {
                        engine.text.say(&status.words().to_string_lossy());
                    }
                    status
                }
            }
        });
        if status == Status::Panic {
            self.broken.store(true, Ordering::Relaxed);
        }
        self.busy.store(false, Ordering::Release);
        status
    }
}

/// Does something that doesn't unwind into C, whatever happens.
pub(crate) fn caught(act: impl FnOnce() -> Status) -> Status {
    match catch_unwind(AssertUnwindSafe(act)) {
        Ok(status) => status,
        Err(payload) => {
            // Dropping it could panic again; what that leaves is lost.
            if let Err(again) = catch_unwind(AssertUnwindSafe(|| drop(payload))) {
                core::mem::forget(again);
            }
            Status::Panic
        }
    }
}

#[cfg(test)]
mod tests {
    use super::caught;
    use crate::status::Status;

    #[test]
    fn a_panic_ends_as_a_status() {
        assert_eq!(caught(|| panic!("a defect")), Status::Panic);
        assert_eq!(caught(|| Status::Full), Status::Full);
    }
}
