//! The C interface of mechanisms that bricard has compiled.
//!
//! In:  a generated mechanism.
//! Out: a table of functions ([`Interface`]), which a library of the mechanism hands out
//!      under the one name that it exports.
//!
//! ```text
//! C program ── bricard.h ──> Interface ── boundary ──> Engine ──> the runtime
//! ```
//!
//! [`Engine`] is safe Rust: a mechanism, where it is, and how it is integrated. What is
//! `unsafe` stands in `pointer`, `boundary`, `states` and `run`, where pointers are read and
//! written, in `handle`, which lends the engine out, and in `callback`, where functions of
//! the program are called.
//!
//! Not here: the name that a library exports, which is in the generated code of its mechanism.

mod abi;
mod boundary;
mod callback;
mod engine;
mod evaluate;
mod handle;
mod input_functions;
mod motion;
mod names;
mod pointer;
mod run;
mod saved;
mod slopes;
mod states;
mod status;
mod table;
mod text;
mod watch;

pub use abi::{ABI, Choices, HEADER, Handle, Interface, Point, Summary, Watch};
pub use engine::Engine;
pub use evaluate::Quantity;
pub use names::List;
pub use status::Status;
pub use table::interface;

/// What a mechanism has to be.
pub trait Embedded<const N: usize, const R: usize>:
    bricard_runtime::Mechanism<f64, N, R>
    + bricard_runtime::Interface<f64, N>
    + bricard_runtime::Differentiated<f64, N>
    + Clone
    + Default
    + Send
    + 'static
{
}

impl<M, const N: usize, const R: usize> Embedded<N, R> for M where
    M: bricard_runtime::Mechanism<f64, N, R>
        + bricard_runtime::Interface<f64, N>
        + bricard_runtime::Differentiated<f64, N>
        + Clone
        + Default
        + Send
        + 'static
{
}
