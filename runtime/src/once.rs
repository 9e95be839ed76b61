//! Functions that are compiled once, with this crate, and not again in the crate of every
//! mechanism.
//!
//! In:  a function over slices, for any scalar.
//! Out: the same function, by its address: for `f64` that of the one which is compiled here.
//!
//! Generic functions are compiled where they are called. What a static of this crate refers to
//! is compiled here, and what can't be reached for a scalar is not compiled for it. Other
//! scalars, `f32` among them, are compiled where they are used.

use core::any::Any;

/// Defines functions of a scalar that give the addresses of others.
macro_rules! compiled_once {
    ($($(#[$meta:meta])* $visibility:vis fn $name:ident<$T:ident>: $signature:ty = $function:expr;)+) => {$(
        $(#[$meta])*
        // The signature is all that there is to say of an address.
        #[allow(clippy::type_complexity)]
        $visibility fn $name<$T: $crate::Real>() -> $signature {
            type Signature<$T> = $signature;
            static HERE: Signature<f64> = $function;
            if const { <$T as $crate::Real>::IS_COMPILED_HERE } {
                $crate::once::same(&HERE)
            } else {
                $function
            }
        }
    )+};
}
pub(crate) use compiled_once;

/// The same value under another name of its type.
pub(crate) fn same<A: Any, B: Any + Copy>(it: &'static A) -> B {
    match (it as &dyn Any).downcast_ref() {
        Some(same) => *same,
        None => unreachable!("what is compiled here is for `f64`"),
    }
}
