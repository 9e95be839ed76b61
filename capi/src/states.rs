//! The functions of C about states: where a mechanism is, and what is evaluated there.
//!
//! In:  pointers and numbers, on the promises that `boundary` names.
//! Out: a [`Status`].

use crate::Embedded;
use crate::abi::{Handle, Point};
use crate::engine::{Engine, Outcome, state_of};
use crate::evaluate::Quantity;
use crate::handle::Body;
use crate::pointer::{give, read, write};
use crate::status::Status;
use bricard_runtime::State;
use core::ffi::c_int;
use core::ptr;

/// Writes a state: time where it is wanted, coordinates, velocities.
///
/// # Safety
///
/// As [`write`].
unsafe fn give_state<const N: usize>(
    state: &State<f64, N>,
    freedoms: usize,
    (t, q, v): (*mut f64, *mut f64, *mut f64),
) -> Outcome {
    if !t.is_null() {
        // SAFETY: as promised.
        unsafe { give(t, state.t)? };
    }
    // SAFETY: as promised; one array is let go before the other is taken.
    unsafe { write(q, freedoms)? }.copy_from_slice(&state.q.as_slice()[..freedoms]);
    // SAFETY: as promised.
    unsafe { write(v, N)? }.copy_from_slice(state.v.as_slice());
    Ok(())
}

impl<M: Embedded<N, R>, const N: usize, const R: usize> Body<M, N, R> {
    /// Reads a state.
    ///
    /// # Safety
    ///
    /// As [`read`].
    unsafe fn take_state(engine: &mut Engine<M, N, R>, point: Point) -> Outcome<State<f64, N>> {
        engine.expect_length(point.n, N, "a state of this mechanism")?;
        // SAFETY: as promised.
        let (q, v) = unsafe { (read(point.q, engine.freedoms())?, read(point.v, N)?) };
        Ok(state_of(point.t, q, v))
    }

    /// Reads a state that may not be given. It is copied, so that it may lie where a result
    /// is written.
    ///
    /// # Safety
    ///
    /// As [`read`]; the point itself is null or one.
    unsafe fn take_point(
        engine: &mut Engine<M, N, R>,
        at: *const Point,
    ) -> Outcome<Option<State<f64, N>>> {
        // SAFETY: as promised.
        match unsafe { at.as_ref() } {
            // SAFETY: as promised.
            Some(point) => unsafe { Self::take_state(engine, *point) }.map(Some),
            None => Ok(None),
        }
    }

    pub(crate) unsafe extern "C" fn state(
        handle: *mut Handle,
        t: *mut f64,
        q: *mut f64,
        v: *mut f64,
        n: usize,
    ) -> Status {
        // SAFETY: the header's promise, also for the arrays.
        unsafe {
            Self::enter(handle, |engine| {
                engine.expect_length(n, N, "a state of this mechanism")?;
                give_state(&engine.state()?, engine.freedoms(), (t, q, v))
            })
        }
    }

    pub(crate) unsafe extern "C" fn set_state(
        handle: *mut Handle,
        t: f64,
        q: *const f64,
        v: *const f64,
        n: usize,
    ) -> Status {
        // SAFETY: the header's promise, also for the arrays.
        unsafe {
            Self::enter(handle, |engine| {
                let state = Self::take_state(engine, Point { t, q, v, n })?;
                engine.set_state(state)
            })
        }
    }

    /// The quantity of a number.
    fn quantity(engine: &mut Engine<M, N, R>, number: c_int) -> Outcome<Quantity> {
        match Quantity::of(number) {
            Some(quantity) => Ok(quantity),
            None => engine.refuse(
                Status::Argument,
                &format_args!("there is no quantity {number}"),
            ),
        }
    }

    pub(crate) unsafe extern "C" fn size(
        handle: *mut Handle,
        number: c_int,
        out: *mut usize,
    ) -> Status {
        // SAFETY: the header's promise, also for `out`.
        unsafe {
            Self::enter(handle, |engine| {
                // The size of what `save` writes is asked for by -1.
                let size = match number {
                    -1 => engine.saved_size(),
                    _ => {
                        let quantity = Self::quantity(engine, number)?;
                        engine.size(quantity)
                    }
                };
                give(out, size)
            })
        }
    }

    pub(crate) unsafe extern "C" fn evaluate(
        handle: *mut Handle,
        number: c_int,
        at: *const Point,
        out: *mut f64,
        n: usize,
    ) -> Status {
        // SAFETY: the header's promise, also for `at` and `out`.
        unsafe {
            Self::enter(handle, |engine| {
                let quantity = Self::quantity(engine, number)?;
                let state = Self::take_point(engine, at)?;
                engine.evaluate(quantity, state, write(out, n)?)
            })
        }
    }

    pub(crate) unsafe extern "C" fn draw(
        handle: *mut Handle,
        at: *const Point,
        out: *mut f64,
        n: usize,
        count: *mut usize,
    ) -> Status {
        // SAFETY: the header's promise, also for `at`, `out` and `count`.
        unsafe {
            Self::enter(handle, |engine| {
                let state = Self::take_point(engine, at)?;
                give(count, engine.draw(state, write(out, n)?)?)
            })
        }
    }

    pub(crate) unsafe extern "C" fn project(
        handle: *mut Handle,
        t: f64,
        q: *mut f64,
        v: *mut f64,
        n: usize,
    ) -> Status {
        // SAFETY: the header's promise, also for the arrays.
        unsafe {
            Self::enter(handle, |engine| {
                let state = Self::take_state(engine, Point { t, q, v, n })?;
                let placed = engine.project(state)?;
                give_state(&placed, engine.freedoms(), (ptr::null_mut(), q, v))
            })
        }
    }

    pub(crate) unsafe extern "C" fn save(handle: *mut Handle, out: *mut f64, n: usize) -> Status {
        // SAFETY: the header's promise, also for `out`.
        unsafe { Self::enter(handle, |engine| engine.save(write(out, n)?)) }
    }

    pub(crate) unsafe extern "C" fn load(
        handle: *mut Handle,
        saved: *const f64,
        n: usize,
    ) -> Status {
        // SAFETY: the header's promise, also for `saved`.
        unsafe { Self::enter(handle, |engine| engine.load(read(saved, n)?)) }
    }
}
