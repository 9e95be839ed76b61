//! The table of a mechanism's functions.
//!
//! In:  a mechanism's type.
//! Out: an [`Interface`].

use crate::Embedded;
use crate::abi::{ABI, Handle, Interface};
use crate::engine::Engine;
use crate::handle::{Body, caught};
use crate::pointer::{enter, give};
use crate::status::Status;
use crate::{boundary, run, states};
use core::marker::PhantomData;
use core::ptr;

/// The table of a mechanism; null for a program that was compiled for another version of
/// the header.
pub fn interface<M: Embedded<N, R>, const N: usize, const R: usize>(abi: u32) -> *const Interface {
    match abi {
        ABI => Table::<M, N, R>::INTERFACE,
        _ => ptr::null(),
    }
}

/// Holds the table of a mechanism.
pub(crate) struct Table<M, const N: usize, const R: usize>(PhantomData<M>);

impl<M: Embedded<N, R>, const N: usize, const R: usize> Table<M, N, R> {
    /// The functions, in the order of the header.
    pub(crate) const INTERFACE: &'static Interface = &Interface {
        abi: ABI,
        create: create::<M, N, R>,
        clone: clone::<M, N, R>,
        assign: boundary::assign::<M, N, R>,
        free: boundary::free::<M, N, R>,
        message: boundary::message::<M, N, R>,
        failed_at: boundary::failed_at::<M, N, R>,
        count: boundary::count::<M, N, R>,
        name: boundary::name::<M, N, R>,
        unit: boundary::unit::<M, N, R>,
        docs: boundary::docs::<M, N, R>,
        find: boundary::find::<M, N, R>,
        parameter: boundary::parameter::<M, N, R>,
        set_parameter: boundary::set_parameter::<M, N, R>,
        hold_input: boundary::hold_input::<M, N, R>,
        release_input: boundary::release_input::<M, N, R>,
        drive_input: boundary::drive_input::<M, N, R>,
        start: boundary::start::<M, N, R>,
        set_start: boundary::set_start::<M, N, R>,
        assemble: boundary::assemble::<M, N, R>,
        state: states::state::<M, N, R>,
        set_state: states::set_state::<M, N, R>,
        options: run::options::<M, N, R>,
        set_options: run::set_options::<M, N, R>,
        run: run::run::<M, N, R>,
        stop: run::stop::<M, N, R>,
        step: boundary::step::<M, N, R>,
        step_once: boundary::step_once::<M, N, R>,
        size: states::size::<M, N, R>,
        row_size: run::row_size::<M, N, R>,
        evaluate: states::evaluate::<M, N, R>,
        draw: states::draw::<M, N, R>,
        project: states::project::<M, N, R>,
        save: states::save::<M, N, R>,
        load: states::load::<M, N, R>,
    };
}

unsafe extern "C" fn create<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut *mut Handle,
) -> Status {
    caught(|| {
        if handle.is_null() {
            return Status::Null;
        }
        let made = match Engine::<M, N, R>::new() {
            Ok(engine) => Body::boxed(Table::<M, N, R>::INTERFACE, engine),
            Err(_) => return Status::Panic,
        };
        // SAFETY: the header's promise for `handle`.
        match unsafe { give(handle, made) } {
            Ok(()) => Status::Ok,
            Err(status) => status,
        }
    })
}

unsafe extern "C" fn clone<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    copy: *mut *mut Handle,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| {
        if copy.is_null() {
            return Err(Status::Null);
        }
        let made = Body::boxed(Table::<M, N, R>::INTERFACE, engine.copy());
        // SAFETY: the header's promise for `copy`.
        unsafe { give(copy, made) }
    };
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}
