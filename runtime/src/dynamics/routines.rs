//! What is compiled once for each scalar: what is learned of the constraint rows.
//!
//! Out: [`RowRoutines`], of which each scalar has one table.
//!
//! Generic functions are compiled where they are called, in the crate of every mechanism.
//! The tables of `f64` and `f32` are part of this crate, and so is the code behind them.

use super::combined::Combined;
use super::lent::{Constrained, Known};
use super::rank::{choose_rows, learn_rank};
use super::rows::Which;
use super::sizes::sample_sizes;
use crate::equations::At;
use crate::linalg::{Breakdown, Workspace};
use crate::{DynamicsError, Real};

type Combine<T> =
    for<'b> fn(&[T], Known<'_, T>, &Workspace<'b, T>) -> Result<Combined<'b, T>, Breakdown>;
type LearnRank<T> =
    fn(&mut dyn Constrained<T>, At<'_, T>, &Workspace<'_, T>) -> Result<(), DynamicsError<T>>;
type ChooseRows<T> = fn(&mut dyn Constrained<T>, &Workspace<'_, T>);
type SampleSizes<T> = fn(&mut dyn Constrained<T>, At<'_, T>, bool, &Workspace<'_, T>);

/// The routines of a scalar.
#[derive(Debug)]
pub(crate) struct RowRoutines<T> {
    /// Combines the rows of a Jacobian.
    pub(crate) combine: Combine<T>,
    /// Learns how many rows are independent.
    pub(crate) learn_rank: LearnRank<T>,
    /// Chooses an independent subset of the rows.
    pub(crate) choose_rows: ChooseRows<T>,
    /// Takes note of the mean sizes of the rows.
    pub(crate) sample_sizes: SampleSizes<T>,
}

impl<T: Real> RowRoutines<T> {
    /// Those of any scalar.
    pub(crate) const fn new() -> Self {
        Self {
            combine: |jacobian, known, workspace| {
                Combined::new(jacobian, known, Which::All, workspace)
            },
            learn_rank: |solver, state, workspace| learn_rank(solver, state, workspace),
            choose_rows: |solver, workspace| choose_rows(solver, workspace),
            sample_sizes: |solver, state, by_form, workspace| {
                sample_sizes(solver, state, by_form, workspace);
            },
        }
    }
}
