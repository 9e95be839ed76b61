//! Reference motions of any mechanism, where no closed form exists.
//!
//! In:  a mechanism that was generated for [`DoubleDouble`], a state, an end.
//! Out: its [`reference`](fn@reference) motion there, with an estimate of its error.
//!
//! The equations, the solver and the integrator are those of everyone else; only
//! the numbers have 106 bits instead of 53.
//!
//! Not here: arithmetic on such numbers, which a crate provides.

mod double_double;
mod function;
mod motion;
mod precise;
mod real;
mod text;

pub use double_double::DoubleDouble;
pub use motion::{Reference, ReferenceError, reference, reference_from, states_at};
pub use precise::precise;
