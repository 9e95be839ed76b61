//! What is compiled once for each scalar, whatever the sizes of mechanisms are.
//!
//! Out: [`Routines`], of which each scalar has one table.
//!
//! Generic functions are compiled where they are called, in the crate of every mechanism.
//! The tables of `f64` and `f32` are part of this crate, and so is the code behind them.

use crate::dynamics::{Accelerate, Motion, RowRoutines, Shares, Slid, Squares, partition};
use crate::equations::At;
use crate::integrator::{Collocation, Digits, Flow, Newton, set_through};
use crate::linalg::Workspace;
use crate::simulate::{Along, Events, Happened};
use crate::{DynamicsError, IntegrateError, Real, Switching, assembly, singular};

type TakeFirst<T> = fn(&mut Events<T>, &mut Along<'_, T>) -> Done<T, Option<Happened<T>>>;
type Slide<T> = fn(&Slid, usize, &mut [T], Accelerate<'_, T>) -> Done<T, Shares<T>>;
type Partition<T> = for<'a> fn(
    (&[T], &[T]),
    (&'a mut [T], &'a mut [T]),
    &Workspace<'a, T>,
    &mut [T],
) -> Result<(), usize>;
type Attempt<T> = fn(
    &mut Newton<'_, T>,
    &mut dyn Flow<T>,
    At<'_, T>,
    (T, bool),
    &Workspace<'_, T>,
) -> Result<(), IntegrateError<T>>;
type SetThrough<T> = fn(&mut [T], (&[T], &[T]), &[T], &mut [T]);
type Done<T, V> = Result<V, DynamicsError<T>>;

/// The routines of a scalar.
#[derive(Debug)]
pub struct Routines<T> {
    /// What works on sheets of the constraint set.
    pub(crate) sheet: singular::Routines<T>,
    /// What is learned of the constraint rows.
    pub(crate) rows: RowRoutines<T>,
    /// What assembles consistent states.
    pub(crate) assembly: assembly::Routines<T>,
    pub(crate) find_first: fn(&mut Events<T>, &mut Along<'_, T>) -> Done<T, ()>,
    pub(crate) take_first: TakeFirst<T>,
    pub(crate) switch: fn(&mut (dyn Motion<T> + '_)) -> Done<T, Switching<T>>,
    pub(crate) slide: Slide<T>,
    pub(crate) least_squares: fn(&Squares<'_, T>, &Workspace<'_, T>, &mut [T]),
    pub(crate) partition: Partition<T>,
    pub(crate) collocation: fn(&Digits) -> Collocation<T>,
    pub(crate) attempt: Attempt<T>,
    pub(crate) set_through: SetThrough<T>,
}

impl<T: Real> Routines<T> {
    /// Those of any scalar.
    pub const fn new() -> Self {
        Self {
            sheet: singular::Routines::new(),
            rows: RowRoutines::new(),
            assembly: assembly::Routines::new(),
            find_first: |events, along| events.find_first(along),
            take_first: |events, along| events.take_first(along),
            switch: |motion| motion.switch(),
            slide: |slid, n, vectors, accelerate| slid.slide(n, vectors, accelerate),
            least_squares: |squares, workspace, out| squares.solve(workspace, out),
            partition: |inertia, rows, workspace, out| partition(inertia, rows, workspace, out),
            collocation: |digits| Collocation::new(digits),
            attempt: |newton, flow, start, end, workspace| {
                newton.attempt(flow, start, end, workspace)
            },
            set_through: |out, ends, nodes, values| set_through(out, ends, nodes, values),
        }
    }
}
