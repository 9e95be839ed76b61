//! Least squares in `2n` unknowns, one row at a time.
//!
//! In:  rows `[a b | c]`, each standing for `aᵀx + bᵀy = c`.
//! Out: the `x`, `y` (`n` each) of least squares.
//!
//! Every row is turned into a triangular factor by Givens rotations and then
//! forgotten, so the number of rows needs no name and no product `BᵀB` squares
//! the condition number.

use super::{Workspace, dot};
use crate::Real;

/// The triangular factor `[P Q; 0 S]`, its blocks by rows, and the right-hand sides.
pub(crate) struct Triangle<'a, T> {
    p: &'a mut [T],
    q: &'a mut [T],
    s: &'a mut [T],
    upper: &'a mut [T],
    lower: &'a mut [T],
}

impl<'a, T: Real> Triangle<'a, T> {
    /// No rows yet.
    pub(crate) fn new(n: usize, workspace: &Workspace<'a, T>) -> Self {
        Self {
            p: workspace.numbers(n * n),
            q: workspace.numbers(n * n),
            s: workspace.numbers(n * n),
            upper: workspace.numbers(n),
            lower: workspace.numbers(n),
        }
    }

    /// Adds the equation `aᵀx + bᵀy = c`, whose entries are used up.
    pub(crate) fn insert(&mut self, a: &mut [T], b: &mut [T], mut c: T) {
        let n = a.len();
        for j in 0..n {
            let row = &mut self.p[j * n..][..n];
            if let Some(turn) = eliminate(row[j], a[j]) {
                rotate(&mut row[j..], &mut a[j..], turn);
                rotate(&mut self.q[j * n..][..n], b, turn);
                rotate_pair(&mut self.upper[j], &mut c, turn);
            }
        }
        for j in 0..n {
            let row = &mut self.s[j * n..][..n];
            if let Some(turn) = eliminate(row[j], b[j]) {
                rotate(&mut row[j..], &mut b[j..], turn);
                rotate_pair(&mut self.lower[j], &mut c, turn);
            }
        }
    }

    /// The unknowns `x`, `y`; not finite where the rows do not determine them.
    pub(crate) fn solve(self) -> (&'a [T], &'a [T]) {
        let n = self.upper.len();
        back_substitute(self.s, self.lower);
        for (j, entry) in self.upper.iter_mut().enumerate() {
            *entry -= dot(&self.q[j * n..][..n], self.lower);
        }
        back_substitute(self.p, self.upper);
        (self.upper, self.lower)
    }
}

/// Cosine and sine of the rotation that takes `entry` into `diagonal`, also where their squares
/// are too small for a number.
fn eliminate<T: Real>(diagonal: T, entry: T) -> Option<(T, T)> {
    if entry == T::zero() {
        return None;
    }
    let largest = diagonal.abs().max(entry.abs());
    let (cos, sin) = (diagonal / largest, entry / largest);
    let size = (cos * cos + sin * sin).sqrt();
    Some((cos / size, sin / size))
}

fn rotate<T: Real>(row: &mut [T], other: &mut [T], turn: (T, T)) {
    for (x, y) in row.iter_mut().zip(other) {
        rotate_pair(x, y, turn);
    }
}

#[inline(always)]
fn rotate_pair<T: Real>(x: &mut T, y: &mut T, (cos, sin): (T, T)) {
    (*x, *y) = (cos * *x + sin * *y, cos * *y - sin * *x);
}

/// Solves with an upper triangular matrix given by rows.
fn back_substitute<T: Real>(rows: &[T], x: &mut [T]) {
    let n = x.len();
    for j in (0..n).rev() {
        let row = &rows[j * n..][..n];
        let (now, solved) = x[j..].split_at_mut(1);
        now[0] = (now[0] - dot(&row[j + 1..], solved)) / row[j];
    }
}
