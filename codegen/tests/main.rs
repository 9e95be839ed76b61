//! The tests of the compiler, one binary.

#[path = "../../tests/dual.rs"]
mod dual;
mod front;
mod random;
mod symbolic;
