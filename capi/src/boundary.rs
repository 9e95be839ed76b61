//! The functions that C calls: pointers are checked, and turned into what Rust wants.
//!
//! In:  pointers and numbers.
//! Out: a [`Status`].
//!
//! What all of them rely on, and the header says: a handle is null or came from `create` or
//! `clone` of the same table and was not freed; an array has as many numbers as is said
//! beside it; other pointers are null or lead to what their type says. None of them is
//! needed after the call, but functions, and what is given back to them.

use crate::Embedded;
use crate::abi::Handle;
use crate::callback::{Callback, LawFunction};
use crate::engine::{Engine, Outcome};
use crate::handle::{Body, caught};
use crate::names::{Entry, List};
use crate::pointer::give;
use crate::status::Status;
use bricard_runtime::Initial;
use core::ffi::{CStr, c_char, c_int, c_void};
use core::ptr;

impl<M: Embedded<N, R>, const N: usize, const R: usize> Body<M, N, R> {
    pub(crate) unsafe extern "C" fn create(handle: *mut *mut Handle) -> Status {
        caught(|| {
            if handle.is_null() {
                return Status::Null;
            }
            let made = match Engine::<M, N, R>::new() {
                Ok(engine) => Self::boxed(Self::INTERFACE, engine),
                Err(_) => return Status::Panic,
            };
            // SAFETY: the header's promise for `handle`.
            match unsafe { give(handle, made) } {
                Ok(()) => Status::Ok,
                Err(status) => status,
            }
        })
    }

    pub(crate) unsafe extern "C" fn clone(handle: *mut Handle, copy: *mut *mut Handle) -> Status {
        // SAFETY: the header's promise, also for `copy`.
        unsafe {
            Self::enter(handle, |engine| match copy.is_null() {
                true => Err(Status::Null),
                false => give(copy, Self::boxed(Self::INTERFACE, engine.copy())),
            })
        }
    }

    pub(crate) unsafe extern "C" fn assign(into: *mut Handle, from: *mut Handle) -> Status {
        if ptr::eq(into, from) && !into.is_null() {
            return Status::Ok;
        }
        // SAFETY: the header's promise for both.
        unsafe {
            if !Self::is_of(from) {
                let reason = "only a mechanism of the same kind can be taken over";
                return Self::enter(into, |target| target.refuse(Status::Argument, &reason));
            }
            Self::enter(into, |target| {
                let copied = Self::enter(from, |source| {
                    target.assign(source);
                    Ok(())
                });
                match copied {
                    Status::Ok => Ok(()),
                    status => Err(status),
                }
            })
        }
    }

    pub(crate) unsafe extern "C" fn free(handle: *mut *mut Handle) {
        // SAFETY: the header's promise: it leads to a handle, or nowhere.
        if let Some(handle) = unsafe { handle.as_mut() } {
            let freed = core::mem::replace(handle, ptr::null_mut());
            caught(|| {
                // SAFETY: the header's promise; the program's own pointer is null now.
                unsafe { Self::drop_boxed(freed) };
                Status::Ok
            });
        }
    }

    pub(crate) unsafe extern "C" fn message(handle: *mut Handle) -> *const c_char {
        let mut text = ptr::null();
        let act = |engine: &mut Engine<M, N, R>| {
            text = engine.text.as_c().as_ptr();
            Ok(())
        };
        // SAFETY: the header's promise.
        match unsafe { Self::enter(handle, act) } {
            Status::Ok => text,
            status => status.words().as_ptr(),
        }
    }

    pub(crate) unsafe extern "C" fn failed_at(handle: *mut Handle, t: *mut f64) -> Status {
        // SAFETY: the header's promise, also for `t`.
        unsafe {
            Self::enter(handle, |engine| match engine.failed_at {
                Some(time) => give(t, time),
                None => engine.refuse(Status::Order, &"no motion has failed"),
            })
        }
    }

    pub(crate) unsafe extern "C" fn count(
        handle: *mut Handle,
        list: c_int,
        out: *mut usize,
    ) -> Status {
        // SAFETY: the header's promise, also for `out`.
        unsafe {
            Self::enter(handle, |engine| {
                let list = Self::listed(engine, list)?;
                give(out, engine.names.list(list).len())
            })
        }
    }

    /// The list of a number.
    fn listed(engine: &mut Engine<M, N, R>, number: c_int) -> Outcome<List> {
        match List::of(number) {
            Some(list) => Ok(list),
            None => engine.refuse(Status::Argument, &format_args!("there is no list {number}")),
        }
    }

    /// A text of an entry; null if there is none.
    ///
    /// # Safety
    ///
    /// As [`enter`](Self::enter).
    unsafe fn entry_text(
        handle: *mut Handle,
        list: c_int,
        index: usize,
        pick: impl FnOnce(&Entry) -> &CStr,
    ) -> *const c_char {
        let mut text = ptr::null();
        let act = |engine: &mut Engine<M, N, R>| {
            let list = Self::listed(engine, list)?;
            if let Some(entry) = engine.names.list(list).get(index) {
                text = pick(entry).as_ptr();
            }
            Ok(())
        };
        // SAFETY: as promised.
        let _told_by_null = unsafe { Self::enter(handle, act) };
        text
    }

    pub(crate) unsafe extern "C" fn name(
        handle: *mut Handle,
        list: c_int,
        index: usize,
    ) -> *const c_char {
        // SAFETY: the header's promise.
        unsafe { Self::entry_text(handle, list, index, |entry| &entry.name) }
    }

    pub(crate) unsafe extern "C" fn unit(
        handle: *mut Handle,
        list: c_int,
        index: usize,
    ) -> *const c_char {
        // SAFETY: the header's promise.
        unsafe { Self::entry_text(handle, list, index, |entry| &entry.unit) }
    }

    pub(crate) unsafe extern "C" fn docs(
        handle: *mut Handle,
        list: c_int,
        index: usize,
    ) -> *const c_char {
        // SAFETY: the header's promise.
        unsafe { Self::entry_text(handle, list, index, |entry| &entry.docs) }
    }

    pub(crate) unsafe extern "C" fn find(
        handle: *mut Handle,
        list: c_int,
        name: *const c_char,
        index: *mut usize,
    ) -> Status {
        // SAFETY: the header's promise, also for `index` and for `name`: a text that ends
        // with a zero.
        unsafe {
            Self::enter(handle, |engine| {
                if name.is_null() {
                    return Err(Status::Null);
                }
                let list = Self::listed(engine, list)?;
                give(index, engine.place_of(list, CStr::from_ptr(name))?)
            })
        }
    }

    pub(crate) unsafe extern "C" fn parameter(
        handle: *mut Handle,
        index: usize,
        value: *mut f64,
    ) -> Status {
        // SAFETY: the header's promise, also for `value`.
        unsafe { Self::enter(handle, |engine| give(value, engine.parameter(index)?)) }
    }

    pub(crate) unsafe extern "C" fn set_parameter(
        handle: *mut Handle,
        index: usize,
        value: f64,
    ) -> Status {
        // SAFETY: the header's promise.
        unsafe { Self::enter(handle, |engine| engine.set_parameter(index, value)) }
    }

    pub(crate) unsafe extern "C" fn hold_input(
        handle: *mut Handle,
        index: usize,
        value: f64,
    ) -> Status {
        // SAFETY: the header's promise.
        unsafe { Self::enter(handle, |engine| engine.hold_input(index, value)) }
    }

    pub(crate) unsafe extern "C" fn release_input(handle: *mut Handle, index: usize) -> Status {
        // SAFETY: the header's promise.
        unsafe { Self::enter(handle, |engine| engine.release_input(index)) }
    }

    pub(crate) unsafe extern "C" fn drive_input(
        handle: *mut Handle,
        index: usize,
        law: Option<LawFunction>,
        user: *mut c_void,
    ) -> Status {
        // SAFETY: the header's promise, also for the function, until the input does
        // something else.
        unsafe {
            Self::enter(handle, |engine| {
                engine.drive_input(index, Callback::new(law.ok_or(Status::Null)?, user))
            })
        }
    }

    pub(crate) unsafe extern "C" fn start(
        handle: *mut Handle,
        index: usize,
        velocity: c_int,
        value: *mut f64,
        held: *mut c_int,
    ) -> Status {
        // SAFETY: the header's promise, also for `value` and `held`.
        unsafe {
            Self::enter(handle, |engine| {
                let initial = engine.start_of(index, velocity != 0)?;
                give(value, initial.value)?;
                give(held, initial.held.into())
            })
        }
    }

    pub(crate) unsafe extern "C" fn set_start(
        handle: *mut Handle,
        index: usize,
        velocity: c_int,
        value: f64,
        held: c_int,
    ) -> Status {
        let held = held != 0;
        let initial = Initial { value, held };
        // SAFETY: the header's promise.
        unsafe {
            Self::enter(handle, |engine| {
                engine.set_start(index, velocity != 0, initial)
            })
        }
    }

    pub(crate) unsafe extern "C" fn assemble(handle: *mut Handle, t: f64) -> Status {
        // SAFETY: the header's promise.
        unsafe { Self::enter(handle, |engine| engine.assemble(t)) }
    }

    pub(crate) unsafe extern "C" fn step(handle: *mut Handle, span: f64) -> Status {
        // SAFETY: the header's promise.
        unsafe { Self::enter(handle, |engine| engine.step(span)) }
    }

    pub(crate) unsafe extern "C" fn step_once(handle: *mut Handle, bound: f64) -> Status {
        // SAFETY: the header's promise.
        unsafe { Self::enter(handle, |engine| engine.step_once(bound)) }
    }
}
