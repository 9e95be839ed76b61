//! The tests of the whole: one binary, a module for each kind of claim.

mod allocation;
mod balance;
mod closed_forms;
mod command;
mod compiled;
mod dense;
mod derivation;
mod double_double;
mod dual;
mod golden;
mod identities;
mod landing;
mod layering;
mod library;
mod licences;
mod linearised;
mod motion;
mod order;
mod random;
mod readme;
mod reduction;
mod reference;
mod resume;
mod source;
mod stiff;
mod translation;
