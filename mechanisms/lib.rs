//! The library of mechanisms: one module for each description in this folder, and
//! a catalogue that finds them by name.
//!
//! Dropping a new `.mech` file in here is all it takes to have it compiled, listed
//! and runnable by name.

pub use bricard_runtime as runtime;

include!(concat!(env!("OUT_DIR"), "/mechanisms.rs"));
