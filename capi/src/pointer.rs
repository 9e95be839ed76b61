//! Pointers of C, checked and turned into what Rust wants.
//!
//! In:  pointers, and what the header promises of them.
//! Out: numbers to read and to write.

use crate::engine::Outcome;
use crate::status::Status;
use core::slice;

/// Writes a value to where a pointer leads.
///
/// # Safety
///
/// The pointer is null or leads to a `V`, which may hold anything.
pub(crate) unsafe fn give<V>(place: *mut V, value: V) -> Outcome {
    match place.is_null() {
        true => Err(Status::Null),
        false => {
            // SAFETY: as promised.
            unsafe { place.write(value) };
            Ok(())
        }
    }
}

/// Numbers to read.
///
/// # Safety
///
/// The pointer is null or leads to `n` numbers, which nobody changes meanwhile.
pub(crate) unsafe fn read<'a>(numbers: *const f64, n: usize) -> Outcome<&'a [f64]> {
    match (numbers.is_null(), n) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(Status::Null),
        // SAFETY: as promised.
        (false, _) => Ok(unsafe { slice::from_raw_parts(numbers, n) }),
    }
}

/// Numbers to write.
///
/// # Safety
///
/// The pointer is null or leads to `n` numbers, which nobody else reads or writes as long
/// as they are in use.
pub(crate) unsafe fn write<'a>(numbers: *mut f64, n: usize) -> Outcome<&'a mut [f64]> {
    match (numbers.is_null(), n) {
        (_, 0) => Ok(&mut []),
        (true, _) => Err(Status::Null),
        // SAFETY: as promised; all numbers are initialised, because the header asks for
        // arrays that hold some.
        (false, _) => Ok(unsafe { slice::from_raw_parts_mut(numbers, n) }),
    }
}
