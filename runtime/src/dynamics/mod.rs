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
mod combined;
mod conditions;
mod constrained;
mod emitted;
mod follow;
mod full;
mod held;
mod independent;
mod lent;
mod locking;
mod metric;
mod multipliers;
mod partitioning;
mod rank;
mod reaction;
mod reduced;
mod rows;
mod schur_complement;
mod settings;
mod sizes;
mod sliding;
mod solver;
mod square;
mod switching;
mod verify;

pub use constrained::{ConstrainedSystem, ConstraintError, Rank};
pub use held::Solver;
pub use settings::{Counters, Form, Settings, Stabilisation};
pub(crate) use solver::Core;

pub(crate) use combined::{Combined, second_derivatives};
pub(crate) use emitted::MAX_ITERATIONS;
pub(crate) use independent::Independent;
pub(crate) use lent::{Constrained, Lent};
pub(crate) use metric::Metric;
pub(crate) use rank::choose_rows;
pub(crate) use rows::{Rows, Which};
pub(crate) use schur_complement::SchurComplement;
pub(crate) use solver::Source;
