//! Accelerations and reactions of constrained mechanisms.
//!
//! In:  a [`Mechanism`](crate::Mechanism) and states.
//! Out: `q̈` in one of four forms, and what observers ask about the constraints.
//!
//! The product path is the reduced form. Away from singular positions it takes
//! the cheap path ([`lifted`]); a number without unit decides when to leave it.
//! Near them the robust path ([`tangent`]) finds which directions are free.
//!
//! Not here: the way back onto the constraints ([`crate::projection`]).

mod acceleration;
mod across;
mod bridge;
mod constrained;
mod decide;
mod emitted;
mod full;
mod lifted;
mod metric;
mod multipliers;
mod partitioning;
mod reduced;
mod rows;
mod settings;
mod singular;
mod sizes;
mod slope;
mod solid;
mod solver;
mod tangent;

pub use constrained::{ConstrainedSystem, ConstraintError, Rank};
pub use settings::{Counters, Form, Settings, Stabilisation};
pub use solver::Solver;

pub(crate) use lifted::Lifted;
pub(crate) use metric::Metric;
pub(crate) use rows::{Rows, Which};
pub(crate) use solver::{Known, Source};
pub(crate) use tangent::Tangent;
