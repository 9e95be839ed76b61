//! The text of the library of parts, which places can point into.

/// The descriptions of the library of parts, which `use parts;` makes known.
pub const LIBRARY: &str = include_str!("../parts.mech");
