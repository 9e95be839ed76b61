//! The tests of the whole: one binary, a module for each kind of claim.

mod compiled;
mod dense;
mod derivation;
mod dual;
mod golden;
mod layering;
mod library;
mod random;
mod source;
mod translation;
