//! The tests of the compiler, one binary.

mod front;
mod random;
mod symbolic;
