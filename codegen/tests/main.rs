//! The tests of the compiler, one binary.

mod symbolic;
