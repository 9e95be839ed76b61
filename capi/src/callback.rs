//! Functions of the program around.
//!
//! In:  pointers to functions, and what the program wants to be given back.
//! Out: calls.
//!
//! A function pointer is called on the promise of whoever gave it: that it is one of the
//! type in the header, that it may be called with the `user` pointer that came with it, and
//! that it neither throws nor jumps.

use core::ffi::{c_int, c_void};

/// Gives an input its value at a state; zero if it could.
pub type LawFunction = unsafe extern "C" fn(
    user: *mut c_void,
    t: f64,
    q: *const f64,
    v: *const f64,
    value: *mut f64,
) -> c_int;

/// Takes rows; zero to go on.
pub type TakeFunction =
    unsafe extern "C" fn(user: *mut c_void, rows: *const f64, count: usize) -> c_int;

/// Is told of an event; zero to go on.
pub type EventFunction = unsafe extern "C" fn(
    user: *mut c_void,
    index: usize,
    rising: c_int,
    t: f64,
    q: *const f64,
    v: *const f64,
) -> c_int;

/// Is told of a passage through a singular position; zero to go on.
pub type PassageFunction = unsafe extern "C" fn(
    user: *mut c_void,
    t: f64,
    sine: f64,
    rank: usize,
    regular: usize,
) -> c_int;

/// Is asked now and then whether to go on; zero to do so.
pub type GoOnFunction = unsafe extern "C" fn(user: *mut c_void, t: f64, steps: u64) -> c_int;

/// A function with what it wants to be given back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Callback<F> {
    function: F,
    user: *mut c_void,
}

impl<F> Callback<F> {
    /// # Safety
    ///
    /// The function may be called with `user` for as long as this is in use.
    pub(crate) unsafe fn new(function: F, user: *mut c_void) -> Self {
        Self { function, user }
    }
}

impl Callback<LawFunction> {
    /// The value of an input; `None` if the function failed.
    pub(crate) fn value(&self, t: f64, q: &[f64], v: &[f64]) -> Option<f64> {
        let mut value = 0.0;
        // SAFETY: as promised in `new`; the arrays and the place of the value outlive the
        // call.
        let status =
            unsafe { (self.function)(self.user, t, q.as_ptr(), v.as_ptr(), &raw mut value) };
        (status == 0).then_some(value)
    }
}

impl Callback<TakeFunction> {
    /// Hands rows over; whether to go on.
    pub(crate) fn take(&self, rows: &[f64], count: usize) -> bool {
        // SAFETY: as promised in `new`; the rows outlive the call.
        unsafe { (self.function)(self.user, rows.as_ptr(), count) == 0 }
    }
}

impl Callback<EventFunction> {
    /// Tells of an event; whether to go on.
    pub(crate) fn tell(&self, event: (usize, bool), t: f64, q: &[f64], v: &[f64]) -> bool {
        let (index, rising) = event;
        // SAFETY: as promised in `new`; the arrays outlive the call.
        let status =
            unsafe { (self.function)(self.user, index, rising.into(), t, q.as_ptr(), v.as_ptr()) };
        status == 0
    }
}

impl Callback<PassageFunction> {
    /// Tells of a passage; whether to go on.
    pub(crate) fn tell(&self, t: f64, sine: f64, ranks: (usize, usize)) -> bool {
        let (rank, regular) = ranks;
        // SAFETY: as promised in `new`.
        unsafe { (self.function)(self.user, t, sine, rank, regular) == 0 }
    }
}

impl Callback<GoOnFunction> {
    /// Whether to go on.
    pub(crate) fn ask(&self, t: f64, steps: u64) -> bool {
        // SAFETY: as promised in `new`.
        unsafe { (self.function)(self.user, t, steps) == 0 }
    }
}
