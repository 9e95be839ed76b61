//! The tests of the runtime: one binary, a module per concept.

mod allocation;
mod assembly;
mod conserve;
mod curves;
mod deadline;
mod dynamics;
mod finite;
mod fixtures;
mod hits;
mod integrator;
mod large;
mod mechanisms;
mod messages;
mod no_gradient;
mod node_reuse;
mod placement;
mod scan;
mod segments;
mod simulate;
mod spans;
mod stiff;
mod vanishing_gradient;
mod words;
