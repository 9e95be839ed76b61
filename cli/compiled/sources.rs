//! The sources that the command carries.

/// What changes with the sources and with what makes a program of them, and the paths and
/// texts of the sources.
type Sources = (u64, &'static [(&'static str, &'static str)]);
pub const SOURCES: Sources = include!(concat!(env!("OUT_DIR"), "/sources.rs"));
