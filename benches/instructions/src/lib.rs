//! Generated and hand-written code of the same mechanisms, to be counted and timed.

pub mod hand;
pub mod mechanism;
