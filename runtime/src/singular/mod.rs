//! Motion through singular configurations of the constraints.
//!
//! In:  states of a step, the [`Chart`] of the last accepted one.
//! Out: states on the sheet of the constraint set on which the motion lives, its tangent
//!      space there, the accelerations that constraints demand.
//!
//! Where a combination of constraints loses its gradient, the constraint set is two
//! smooth sheets that cross, and the motion stays on one of them. The sheet's tangent
//! space and curvature are smooth along it; they are known at regular states on both
//! sides and interpolated between.
//!
//! Not here: forces and masses ([`crate::dynamics`]), and how far a step goes
//! ([`crate::integrator`]).

mod between;
mod chart;
mod critical;
mod cubic;
mod determinant_signs;
mod differences;
mod direction;
mod evaluate;
mod found;
mod memory;
mod node_reuse;
mod nodes;
mod obstacle;
mod part;
mod passage;
mod place;
mod point;
mod product;
mod redundancy;
mod samples;
mod session;
mod sheet;
mod sheet_selection;
mod sheets;
mod start;
mod stored_nodes;

pub(crate) use chart::Chart;
pub use found::Passage;
pub(crate) use found::{Found, Searched};
pub(crate) use memory::Memory;
pub(crate) use obstacle::Obstacle;
pub(crate) use place::Placement;
pub(crate) use point::{Point, smallest_sine};
pub(crate) use product::solving_along;
pub(crate) use session::{Placed, Session};
pub(crate) use sheets::{choosing_poorly, counting, finding, staying};
pub(crate) use stored_nodes::Nodes;
