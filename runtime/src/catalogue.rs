//! Finding a mechanism by name, and pulling generated code in.

use crate::{Interface, Mechanism, Real};

/// Is shown a mechanism whose sizes are known only where it was generated.
///
/// A generated catalogue has a function `visit(name, visitor)` that calls this
/// with the mechanism of that name.
pub trait Visitor<T: Real> {
    /// What the visit comes to.
    type Output;

    /// Is called with the mechanism, its parameters at their defaults.
    fn visit<M, const N: usize, const R: usize>(self, mechanism: M) -> Self::Output
    where
        M: Mechanism<T, N, R> + Interface<T, N> + Clone + 'static;
}

/// Includes the module that the build script generated from a description:
/// `include_mechanism!("four_bar")` gives `pub mod four_bar`.
#[macro_export]
macro_rules! include_mechanism {
    ($name:literal) => {
        include!(concat!(env!("OUT_DIR"), "/", $name, ".rs"));
    };
}
