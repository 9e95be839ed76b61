//! Text to syntax tree, every node with its place.
//!
//! In:  the text of a description.
//! Out: [`Model`]: what is written, nothing resolved.
//!
//! Four steps: `scan` looks at the characters (so that the lexer cannot fail and
//! no nesting is too deep for a recursive reader), `token` has proc-macro2 lex
//! them, `item`, `equation`, `start` and `unit` read statements, `expression` reads formulas.
//! `stray`, `beside` and `foreign` say what was meant by what belongs to other notations.
//! A mistake inside a statement is reported and reading goes on behind it; the names
//! that such a statement may have declared are remembered, so that nobody complains of
//! them.
//!
//! Not here: the meaning of names, shapes and units.

pub mod ast;
mod beside;
mod blocks;
mod build;
mod choice;
mod cursor;
mod equation;
mod error;
mod expression;
mod foreign;
mod formula;
mod function;
mod item;
mod keyword;
mod literal;
pub(crate) mod messages;
mod model;
mod print;
mod read;
mod ruler;
mod scan;
mod start;
mod stray;
mod token;
mod unit;

pub(crate) use beside::place_of;
pub use error::ModelError;
pub use formula::Formula;
pub(crate) use keyword::{CONNECTIVES, DIRECTIONS, SHAPES, STATEMENTS};
pub use model::Model;
pub(crate) use print::formula as written;
pub(crate) use read::{Read, library, read};
pub use read::{formula, parse};
pub use scan::NESTING;
