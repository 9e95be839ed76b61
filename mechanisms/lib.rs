//! The library of mechanisms: one module for each description in this folder, and
//! a catalogue that finds them by name.
//!
//! Dropping a new `.mech` file in here is all it takes to have it compiled, listed
//! and runnable by name.

use bricard_driver::{AnyMechanism, EraseType};

pub use bricard_runtime as runtime;

include!(concat!(env!("OUT_DIR"), "/mechanisms.rs"));

/// What the build script made of the descriptions, as text.
#[doc(hidden)]
pub const COMPILED: &str = include_str!(concat!(env!("OUT_DIR"), "/mechanisms.rs"));

/// A mechanism of the library, or a benchmark problem, by its name, with its type and sizes
/// forgotten.
///
/// Whoever runs mechanisms through this shares one compiled simulation for each pair of
/// sizes.
pub fn any(name: &str) -> Option<Box<dyn AnyMechanism>> {
    visit(name, EraseType).or_else(|| bricard_benchmarks::visit(name, EraseType))
}
