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
use crate::pointer::{enter, give};
use crate::status::Status;
use bricard_runtime::Initial;
use core::ffi::{CStr, c_char, c_int, c_void};
use core::ptr;

pub(crate) unsafe extern "C" fn assign<M: Embedded<N, R>, const N: usize, const R: usize>(
    into: *mut Handle,
    from: *mut Handle,
) -> Status {
    if ptr::eq(into, from) && !into.is_null() {
        return Status::Ok;
    }
    // SAFETY: the header's promise.
    if !unsafe { Body::<M, N, R>::is_of(from) } {
        let reason = "only a mechanism of the same kind can be taken over";
        let act = |target: &mut Engine<M, N, R>| target.refuse(Status::Argument, &reason);
        // SAFETY: the header's promise.
        return unsafe { enter(into, act) };
    }
    let act = |target: &mut Engine<M, N, R>| {
        let copy = |source: &mut Engine<M, N, R>| {
            target.assign(source);
            Ok(())
        };
        // SAFETY: the header's promise.
        match unsafe { enter(from, copy) } {
            Status::Ok => Ok(()),
            status => Err(status),
        }
    };
    // SAFETY: the header's promise.
    unsafe { enter(into, act) }
}

pub(crate) unsafe extern "C" fn free<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut *mut Handle,
) {
    // SAFETY: the header's promise: it leads to a handle, or nowhere.
    if let Some(handle) = unsafe { handle.as_mut() } {
        let freed = core::mem::replace(handle, ptr::null_mut());
        caught(|| {
            // SAFETY: the header's promise; the program's own pointer is null now.
            unsafe { Body::<M, N, R>::free(freed) };
            Status::Ok
        });
    }
}

pub(crate) unsafe extern "C" fn message<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
) -> *const c_char {
    let mut text = ptr::null();
    let act = |engine: &mut Engine<M, N, R>| {
        text = engine.text.as_c().as_ptr();
        Ok(())
    };
    // SAFETY: the header's promise.
    match unsafe { enter(handle, act) } {
        Status::Ok => text,
        status => status.words().as_ptr(),
    }
}

pub(crate) unsafe extern "C" fn failed_at<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    t: *mut f64,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| match engine.failed_at {
        // SAFETY: the header's promise for `t`.
        Some(time) => unsafe { give(t, time) },
        None => engine.refuse(Status::Order, &"no motion has failed"),
    };
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

pub(crate) unsafe extern "C" fn count<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    list: c_int,
    out: *mut usize,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| {
        let list = listed(engine, list)?;
        // SAFETY: the header's promise for `out`.
        unsafe { give(out, engine.names.list(list).len()) }
    };
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

/// The list of a number.
fn listed<M: Embedded<N, R>, const N: usize, const R: usize>(
    engine: &mut Engine<M, N, R>,
    number: c_int,
) -> Outcome<List> {
    match List::of(number) {
        Some(list) => Ok(list),
        None => engine.refuse(Status::Argument, &format_args!("there is no list {number}")),
    }
}

/// A text of an entry; null if there is none.
///
/// # Safety
///
/// As [`enter`].
unsafe fn entry_text<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    list: c_int,
    index: usize,
    pick: impl FnOnce(&Entry) -> *const c_char,
) -> *const c_char {
    let mut text = ptr::null();
    let act = |engine: &mut Engine<M, N, R>| {
        let list = listed(engine, list)?;
        if let Some(entry) = engine.names.list(list).get(index) {
            text = pick(entry);
        }
        Ok(())
    };
    // SAFETY: as promised.
    let _told_by_null = unsafe { enter(handle, act) };
    text
}

pub(crate) unsafe extern "C" fn name<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    list: c_int,
    index: usize,
) -> *const c_char {
    // SAFETY: the header's promise.
    unsafe { entry_text::<M, N, R>(handle, list, index, |entry| entry.name.as_ptr()) }
}

pub(crate) unsafe extern "C" fn unit<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    list: c_int,
    index: usize,
) -> *const c_char {
    // SAFETY: the header's promise.
    unsafe { entry_text::<M, N, R>(handle, list, index, |entry| entry.unit.as_ptr()) }
}

pub(crate) unsafe extern "C" fn docs<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    list: c_int,
    index: usize,
) -> *const c_char {
    // SAFETY: the header's promise.
    unsafe { entry_text::<M, N, R>(handle, list, index, |entry| entry.docs.as_ptr()) }
}

pub(crate) unsafe extern "C" fn find<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    list: c_int,
    name: *const c_char,
    index: *mut usize,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| {
        if name.is_null() {
            return Err(Status::Null);
        }
        // SAFETY: the header's promise for `name`: a text that ends with a zero.
        let name = unsafe { CStr::from_ptr(name) };
        let list = listed(engine, list)?;
        let place = engine.place_of(list, name)?;
        // SAFETY: the header's promise for `index`.
        unsafe { give(index, place) }
    };
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

pub(crate) unsafe extern "C" fn parameter<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    index: usize,
    value: *mut f64,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| {
        let parameter = engine.parameter(index)?;
        // SAFETY: the header's promise for `value`.
        unsafe { give(value, parameter) }
    };
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

pub(crate) unsafe extern "C" fn set_parameter<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    index: usize,
    value: f64,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| engine.set_parameter(index, value);
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

pub(crate) unsafe extern "C" fn hold_input<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    index: usize,
    value: f64,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| engine.hold_input(index, value);
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

pub(crate) unsafe extern "C" fn release_input<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    index: usize,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| engine.release_input(index);
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

pub(crate) unsafe extern "C" fn drive_input<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    index: usize,
    law: Option<LawFunction>,
    user: *mut c_void,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| {
        let law = law.ok_or(Status::Null)?;
        // SAFETY: the header's promise for the function, until the input does something
        // else.
        engine.drive_input(index, unsafe { Callback::new(law, user) })
    };
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

pub(crate) unsafe extern "C" fn start<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    index: usize,
    velocity: c_int,
    value: *mut f64,
    held: *mut c_int,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| {
        let initial = engine.start_of(index, velocity != 0)?;
        // SAFETY: the header's promise for both.
        unsafe { give(value, initial.value).and_then(|()| give(held, initial.held.into())) }
    };
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

pub(crate) unsafe extern "C" fn set_start<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    index: usize,
    velocity: c_int,
    value: f64,
    held: c_int,
) -> Status {
    let held = held != 0;
    let initial = Initial { value, held };
    let act = |engine: &mut Engine<M, N, R>| engine.set_start(index, velocity != 0, initial);
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

pub(crate) unsafe extern "C" fn assemble<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    t: f64,
) -> Status {
    // SAFETY: the header's promise.
    unsafe { enter(handle, |engine: &mut Engine<M, N, R>| engine.assemble(t)) }
}

pub(crate) unsafe extern "C" fn step<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    span: f64,
) -> Status {
    // SAFETY: the header's promise.
    unsafe { enter(handle, |engine: &mut Engine<M, N, R>| engine.step(span)) }
}

pub(crate) unsafe extern "C" fn step_once<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    bound: f64,
) -> Status {
    // SAFETY: the header's promise.
    unsafe {
        enter(handle, |engine: &mut Engine<M, N, R>| {
            engine.step_once(bound)
        })
    }
}
