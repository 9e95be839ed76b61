//! Compiles mechanism descriptions to specialised Rust, from a build script.
//!
//! A description (`.mech`) gives coordinates, energies and constraints. This crate
//! derives the equations of motion and emits a module of fixed-size Rust that
//! `bricard-runtime` integrates through singular positions.
//!
//! ```no_run
//! // build.rs
//! fn main() -> Result<(), bricard_codegen::BuildError> {
//!     bricard_codegen::compile("mechanisms/four_bar.mech")
//! }
//! ```
//!
//! and in the crate, `bricard_runtime::include_mechanism!("four_bar");`.
//!
//! The stages, each a module: [`parse`] → [`model`] → [`mod@derive`] → [`optimise`] →
//! [`emit`], on expressions of [`expr`], with messages of [`diagnostic`].

mod build;
mod compile;
pub mod derive;
pub mod diagnostic;
pub mod doubt;
pub mod emit;
pub mod expr;
pub mod model;
pub mod optimise;
pub mod parse;
pub mod words;

pub use build::{BuildError, Builder, compile, compile_dir, read_description};
pub use compile::{Compiled, Settings, analyse, compile_source, examine};
pub use diagnostic::Diagnostics;
pub use parse::ast::{Crossing, Drawing};
pub use parse::{Formula, Model, ModelError};
