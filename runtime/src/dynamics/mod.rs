//! Accelerations and reactions of constrained mechanisms.
//!
//! In:  a [`Mechanism`](crate::Mechanism) and states.
//! Out: `q̈` in one of four forms, and what observers ask about the constraints.
//!
//! The product path is the reduced form. Away from singular configurations it takes
//! the cheap path ([`schur_complement`]); a number without unit decides when to leave it.
//! Near them [`follow`] keeps the motion on its sheet of the constraint set
//! ([`crate::singular`]).
//!
//! Not here: the way back onto the constraints ([`crate::projection`]).

mod acceleration;
mod acceleration_jacobian;
mod conditions;
mod constrained;
mod coordinate_scale;
mod curvature;
mod emitted;
mod erased;
mod follow;
mod full;
mod independent;
mod locking;
mod metric;
mod multipliers;
mod partitioning;
mod public_solver;
mod rank;
mod reaction;
mod reduced;
mod refine;
mod rows;
mod schur_complement;
mod settings;
mod shares;
mod singular_values;
mod sizes;
mod sliding;
mod solver;
mod switching;
mod turns;
mod vanishing_gradient;
mod verify;
mod verify_energy;

pub use constrained::{ConstrainedSystem, ConstraintError, Rank};
pub use public_solver::Solver;
pub use settings::{Counters, Form, Settings, Stabilisation};
pub(crate) use solver::Core;

pub(crate) use coordinate_scale::CoordinateScale;
pub(crate) use emitted::MAX_ITERATIONS;
pub(crate) use erased::{Constrained, SolverView};
pub(crate) use independent::Independent;
pub(crate) use metric::Metric;
pub(crate) use rank::{RETURNING_GRADIENT, choose_rows};
pub(crate) use refine::{Held, refine_start};
pub(crate) use rows::{Rows, Which};
pub(crate) use schur_complement::SchurComplement;
pub(crate) use singular_values::{SingularValueDecomposition, second_derivatives};
pub(crate) use solver::Source;
