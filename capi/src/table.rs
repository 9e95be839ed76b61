//! The table of a mechanism's functions.
//!
//! In:  a mechanism's type.
//! Out: an [`Interface`].

use crate::Embedded;
use crate::abi::{ABI, Interface};
use crate::handle::Body;
use core::ptr;

/// The table of a mechanism; null for a program that was compiled for another version of
/// the header.
pub fn interface<M: Embedded<N, R>, const N: usize, const R: usize>(abi: u32) -> *const Interface {
    match abi {
        ABI => Body::<M, N, R>::INTERFACE,
        _ => ptr::null(),
    }
}

impl<M: Embedded<N, R>, const N: usize, const R: usize> Body<M, N, R> {
    /// The functions, in the order of the header.
    pub(crate) const INTERFACE: &'static Interface = &Interface {
        abi: ABI,
        create: Self::create,
        clone: Self::clone,
        assign: Self::assign,
        free: Self::free,
        message: Self::message,
        failed_at: Self::failed_at,
        count: Self::count,
        name: Self::name,
        unit: Self::unit,
        docs: Self::docs,
        find: Self::find,
        parameter: Self::parameter,
        set_parameter: Self::set_parameter,
        hold_input: Self::hold_input,
        release_input: Self::release_input,
        drive_input: Self::drive_input,
        start: Self::start,
        set_start: Self::set_start,
        assemble: Self::assemble,
        state: Self::state,
        set_state: Self::set_state,
        options: Self::options,
        set_options: Self::set_options,
        run: Self::run,
        stop: Self::stop,
        step: Self::step,
        step_once: Self::step_once,
        size: Self::size,
        row_size: Self::row_size,
        evaluate: Self::evaluate,
        draw: Self::draw,
        project: Self::project,
        save: Self::save,
        load: Self::load,
    };
}
