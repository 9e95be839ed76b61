//! The tests of the whole: one binary, a module for each kind of claim.

mod derivation;
mod dual;
mod library;
mod random;
