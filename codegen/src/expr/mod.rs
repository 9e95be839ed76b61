//! The symbolic engine: hash-consed expressions over exact numbers.
//!
//! Knows no mechanics: what symbols stand for is told by others ([`Symbolic`]). An
//! expression is an [`ExprId`] into a [`Graph`]; equal expressions have equal ids, ids are
//! given in order of creation, and nothing depends on the order of a hash map.

mod adjoint;
mod bits;
mod diff;
mod eval;
mod function;
mod graph;
mod number;
mod print;
mod reach;
mod substitute;
mod symmetric;
mod table;
mod zero;

pub(crate) use bits::Bits;
pub use diff::Direction;
pub use function::{Comparison, Function, Function2, Side, Test};
pub use graph::{ExprId, Graph, Node, Symbolic};
pub use number::Number;
pub use print::Notation;
pub use symmetric::{Arithmetic, Symmetric};
pub use table::{Entry, Lookup, Table};
