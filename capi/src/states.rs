//! The functions of C about states: where a mechanism is, and what is evaluated there.
//!
//! In:  pointers and numbers, on the promises that `boundary` names.
//! Out: a [`Status`].

use crate::Embedded;
use crate::abi::{Handle, Point};
use crate::engine::{Engine, Outcome, state_of};
use crate::evaluate::Quantity;
use crate::pointer::{enter, give, read, write};
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

/// Reads a state.
///
/// # Safety
///
/// As [`read`].
unsafe fn take_state<M: Embedded<N, R>, const N: usize, const R: usize>(
    engine: &mut Engine<M, N, R>,
    point: Point,
) -> Outcome<State<f64, N>> {
    engine.expect_length(point.n, N, "a state of this mechanism")?;
    // SAFETY: as promised.
    let (q, v) = unsafe { (read(point.q, engine.freedoms())?, read(point.v, N)?) };
    Ok(state_of(point.t, q, v))
}

pub(crate) unsafe extern "C" fn state<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    t: *mut f64,
    q: *mut f64,
    v: *mut f64,
    n: usize,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| {
        engine.expect_length(n, N, "a state of this mechanism")?;
        let state = engine.state()?;
        // SAFETY: the header's promise for the arrays.
        unsafe { give_state(&state, engine.freedoms(), (t, q, v)) }
    };
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

pub(crate) unsafe extern "C" fn set_state<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    t: f64,
    q: *const f64,
    v: *const f64,
    n: usize,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| {
        // SAFETY: the header's promise for the arrays.
        let state = unsafe { take_state(engine, Point { t, q, v, n })? };
        engine.set_state(state)
    };
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

/// The quantity of a number.
fn quantity<M: Embedded<N, R>, const N: usize, const R: usize>(
    engine: &mut Engine<M, N, R>,
    number: c_int,
) -> Outcome<Quantity> {
    match Quantity::of(number) {
        Some(quantity) => Ok(quantity),
        None => engine.refuse(
            Status::Argument,
            &format_args!("there is no quantity {number}"),
        ),
    }
}

pub(crate) unsafe extern "C" fn size<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    number: c_int,
    out: *mut usize,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| {
        // The size of what `save` writes is asked for by -1.
        let size = match number {
            -1 => engine.saved_size(),
            _ => {
                let quantity = quantity(engine, number)?;
                engine.size(quantity)
            }
        };
        // SAFETY: the header's promise for `out`.
        unsafe { give(out, size) }
    };
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

pub(crate) unsafe extern "C" fn evaluate<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    number: c_int,
    at: *const Point,
    out: *mut f64,
    n: usize,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| {
        let quantity = quantity(engine, number)?;
        // SAFETY: the header's promise for `at`.
        let state = unsafe { take_point(engine, at)? };
        // SAFETY: the header's promise for `out`.
        engine.evaluate(quantity, state, unsafe { write(out, n)? })
    };
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

/// Reads a state that may not be given. It is copied, so that it may lie where a result is
/// written.
///
/// # Safety
///
/// As [`read`]; the point itself is null or one.
unsafe fn take_point<M: Embedded<N, R>, const N: usize, const R: usize>(
    engine: &mut Engine<M, N, R>,
    at: *const Point,
) -> Outcome<Option<State<f64, N>>> {
    // SAFETY: as promised.
    match unsafe { at.as_ref() } {
        // SAFETY: as promised.
        Some(point) => unsafe { take_state(engine, *point) }.map(Some),
        None => Ok(None),
    }
}

pub(crate) unsafe extern "C" fn draw<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    at: *const Point,
    out: *mut f64,
    n: usize,
    count: *mut usize,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| {
        // SAFETY: the header's promise for `at`.
        let state = unsafe { take_point(engine, at)? };
        // SAFETY: the header's promise for `out`.
        let drawn = engine.draw(state, unsafe { write(out, n)? })?;
        // SAFETY: the header's promise for `count`.
        unsafe { give(count, drawn) }
    };
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

pub(crate) unsafe extern "C" fn project<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    t: f64,
    q: *mut f64,
    v: *mut f64,
    n: usize,
) -> Status {
    let act = |engine: &mut Engine<M, N, R>| {
        // SAFETY: the header's promise for the arrays.
        let state = unsafe { take_state(engine, Point { t, q, v, n })? };
        let placed = engine.project(state)?;
        // SAFETY: the header's promise for the arrays.
        unsafe { give_state(&placed, engine.freedoms(), (ptr::null_mut(), q, v)) }
    };
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

pub(crate) unsafe extern "C" fn save<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    out: *mut f64,
    n: usize,
) -> Status {
    // SAFETY: the header's promise for `out`.
    let act = |engine: &mut Engine<M, N, R>| engine.save(unsafe { write(out, n)? });
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}

pub(crate) unsafe extern "C" fn load<M: Embedded<N, R>, const N: usize, const R: usize>(
    handle: *mut Handle,
    saved: *const f64,
    n: usize,
) -> Status {
    // SAFETY: the header's promise for `saved`.
    let act = |engine: &mut Engine<M, N, R>| engine.load(unsafe { read(saved, n)? });
    // SAFETY: the header's promise.
    unsafe { enter(handle, act) }
}
