//! Compiles mechanism descriptions to specialised Rust, from a build script.

mod diagnostic;
mod expr;
mod model;
mod parse;
