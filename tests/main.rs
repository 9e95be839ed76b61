//! The tests of the whole: one binary, a module for each kind of claim.

mod derivation;
mod dual;
mod layering;
mod library;
mod random;
mod source;
