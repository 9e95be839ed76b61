//! The tests of the runtime: one binary, a module per concept.

mod integrator;
mod toys;
