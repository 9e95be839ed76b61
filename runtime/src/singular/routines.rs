//! What is compiled once for each scalar: what works on a [`Sheet`], and what finds one.
//!
//! Out: [`Routines`], which are part of the table of a scalar.

use super::meant::{singular_tangent, span_free};
use super::obstacle::Obstacle;
use super::passage::Found;
use super::place::Placement;
use super::sheet::{PointView, Sheet};
use crate::dynamics::Constrained;
use crate::equations::At;
use crate::linalg::Workspace;
use crate::{DynamicsError, Real};

type Place<T> = fn(
    &mut Sheet<'_, T>,
    At<'_, T>,
    &mut PointView<'_, T>,
    &Workspace<'_, T>,
) -> Result<Placement<T>, Obstacle>;
type MeasureHere<T> =
    fn(&mut Sheet<'_, T>, At<'_, T>, &mut PointView<'_, T>) -> Result<(), Obstacle>;
type Passages<T> =
    fn(&mut Sheet<'_, T>, At<'_, T>, T, &dyn Fn(T, &mut [T]), &Workspace<'_, T>) -> Found<T>;
type Crossed<T> =
    fn(&mut Sheet<'_, T>, (At<'_, T>, At<'_, T>), bool, &Workspace<'_, T>) -> (Option<usize>, T);
type Stays<T> = fn(&mut Sheet<'_, T>, (At<'_, T>, At<'_, T>), &Workspace<'_, T>) -> bool;
type SpanFree<T> = fn(&[T], &mut [T], usize, &dyn Fn(&mut [T]), &Workspace<'_, T>);
type Tangent<T> = fn(
    &mut dyn Constrained<T>,
    At<'_, T>,
    &mut [T],
    &Workspace<'_, T>,
) -> Result<bool, DynamicsError<T>>;

/// The routines of a scalar.
#[derive(Debug)]
pub(crate) struct Routines<T> {
    place: Place<T>,
    measure_here: MeasureHere<T>,
    passages: Passages<T>,
    crossed: Crossed<T>,
    stays: Stays<T>,
    pub(super) span_free: SpanFree<T>,
    pub(super) tangent: Tangent<T>,
}

impl<T: Real> Routines<T> {
    pub(crate) const fn new() -> Self {
        Self {
            place: |sheet, state, point, workspace| sheet.place(state, point, workspace),
            measure_here: |sheet, state, point| sheet.measure_here(state, point),
            passages: |sheet, start, length, at, workspace| {
                sheet.passages(start, length, at, workspace)
            },
            crossed: |sheet, ends, seeks, workspace| sheet.crossed(ends, seeks, workspace),
            stays: |sheet, ends, workspace| sheet.stays(ends, workspace),
            span_free: |factor, free, n, remove, workspace| {
                span_free(factor, free, n, remove, workspace);
            },
            tangent: |solver, state, tangent, workspace| {
                singular_tangent(solver, state, tangent, workspace)
            },
        }
    }
}

/// The routines of the scalar, as methods.
impl<T: Real> Sheet<'_, T> {
    /// Puts a state onto its sheet.
    pub(crate) fn put(
        &mut self,
        state: At<'_, T>,
        point: &mut PointView<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<Placement<T>, Obstacle> {
        (T::routines().sheet.place)(self, state, point, workspace)
    }

    /// The geometry at a state as it is.
    pub(crate) fn look_at(
        &mut self,
        state: At<'_, T>,
        point: &mut PointView<'_, T>,
    ) -> Result<(), Obstacle> {
        (T::routines().sheet.measure_here)(self, state, point)
    }

    /// The passages of a step of this length whose positions are `at`.
    pub(crate) fn find_passages(
        &mut self,
        start: At<'_, T>,
        length: T,
        at: &dyn Fn(T, &mut [T]),
        workspace: &Workspace<'_, T>,
    ) -> Found<T> {
        (T::routines().sheet.passages)(self, start, length, at, workspace)
    }

    /// How many sheets are crossed between two states, `None` where that can't be told, and
    /// after which part of the way if that is sought.
    pub(crate) fn count_crossed(
        &mut self,
        ends: (At<'_, T>, At<'_, T>),
        seeks: bool,
        workspace: &Workspace<'_, T>,
    ) -> (Option<usize>, T) {
        (T::routines().sheet.crossed)(self, ends, seeks, workspace)
    }

    /// Whether no sheet is seen to be crossed between two states.
    pub(crate) fn stays_between(
        &mut self,
        ends: (At<'_, T>, At<'_, T>),
        workspace: &Workspace<'_, T>,
    ) -> bool {
        (T::routines().sheet.stays)(self, ends, workspace)
    }
}
