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
//! What stands here is for users; [`Builder`] has the settings. A program that compiles
//! descriptions itself calls [`compile_source`]; one that makes them has [`Model`].

mod build;
mod compile;
mod derive;
mod diagnostic;
mod emit;
mod expr;
mod keywords;
mod lint;
mod model;
mod optimise;
mod read;
mod syntax;

pub use build::{BuildError, Builder, compile, compile_dir};
pub use compile::{CompileSettings, Compiled, compile_source};
pub use diagnostic::Diagnostics;
pub use emit::EmitOptions;
pub use syntax::ast::{Crossing, Drawing};
pub use syntax::{Formula, Model, ModelError};

/// The stages of the compiler, for the other packages of its workspace and for tests. There
/// is no promise about anything in here: it may change with any version.
///
/// `syntax` → `model` → `derive` → `optimise` → `emit`, on expressions of `expr`, with
/// messages of `diagnostic` and the warnings of `lint`.
#[doc(hidden)]
pub mod internals {
    pub use crate::compile::{analyse, equations_of_motion, examine};
    pub use crate::read::{NotUtf8, read_text};
    pub mod derive {
        pub use crate::derive::*;
    }
    pub mod diagnostic {
        pub use crate::diagnostic::*;
    }
    pub mod emit {
        pub use crate::emit::*;
    }
    pub mod expr {
        pub use crate::expr::*;
        pub use crate::model::{Graph, Node, Symbol};
    }
    pub mod keywords {
        pub use crate::keywords::*;
    }
    pub mod lint {
        pub use crate::lint::*;
    }
    pub mod model {
        pub use crate::model::*;
    }
    pub mod optimise {
        pub use crate::optimise::*;
    }
    pub mod syntax {
        pub use crate::syntax::*;
    }
}
