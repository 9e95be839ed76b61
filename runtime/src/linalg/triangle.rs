//! Least squares in `2N` unknowns, one row at a time.
//!
//! In:  rows `[a b | c]`, each standing for `aᵀx + bᵀy = c`.
//! Out: the `x`, `y` (`N` each) of least squares.
//!
//! Every row is turned into a triangular factor by Givens rotations and then
//! forgotten, so the number of rows needs no name and no product `BᵀB` squares
//! the condition number.

use super::{Workspace, dot};
use crate::Real;

/// The triangular factor `[P Q; 0 S]` and the right-hand sides, row by row.
#[derive(Debug)]
pub(crate) struct Triangle<'a, T> {
    p: &'a mut [T],
    q: &'a mut [T],
    s: &'a mut [T],
    upper: &'a mut [T],
    lower: &'a mut [T],
    /// The row that comes next.
    a: &'a mut [T],
    b: &'a mut [T],
}

impl<'a, T: Real> Triangle<'a, T> {
    /// One of no equation.
    pub(crate) fn zeros(n: usize, workspace: &Workspace<'a, T>) -> Self {
        Self {
            p: workspace.numbers(n * n),
            q: workspace.numbers(n * n),
            s: workspace.numbers(n * n),
            upper: workspace.numbers(n),
            lower: workspace.numbers(n),
            a: workspace.numbers(n),
            b: workspace.numbers(n),
        }
    }

    /// The entries of `a` and `b` that come next, to be written: all zeros.
    pub(crate) fn row(&mut self) -> impl Iterator<Item = (&mut T, &mut T)> {
        self.a.fill(T::zero());
        self.b.fill(T::zero());
        self.a.iter_mut().zip(self.b.iter_mut())
    }

    /// Adds the equation `aᵀx + bᵀy = c`.
    pub(crate) fn insert(&mut self, mut c: T) {
        let n = self.a.len();
        for j in 0..n {
            let row = &mut self.p[j * n..][..n];
            if let Some(turn) = eliminate(row[j], self.a[j]) {
                rotate(row, self.a, turn);
                rotate(&mut self.q[j * n..][..n], self.b, turn);
                rotate_pair(&mut self.upper[j], &mut c, turn);
            }
        }
        for j in 0..n {
            let row = &mut self.s[j * n..][..n];
            if let Some(turn) = eliminate(row[j], self.b[j]) {
                rotate(row, self.b, turn);
                rotate_pair(&mut self.lower[j], &mut c, turn);
            }
        }
    }

    /// The unknowns `x`, `y`; not finite where the rows do not determine them.
    pub(crate) fn solve(self) -> (&'a [T], &'a [T]) {
        back_substitute(self.s, self.lower, self.b);
        for (right, row) in self.upper.iter_mut().zip(self.q.chunks_exact(self.b.len())) {
            *right -= dot(row, self.b);
        }
        back_substitute(self.p, self.upper, self.a);
        (self.a, self.b)
    }
}

/// Cosine and sine of the rotation that takes `entry` into `diagonal`.
fn eliminate<T: Real>(diagonal: T, entry: T) -> Option<(T, T)> {
    if entry == T::zero() {
        return None;
    }
    let size = (diagonal * diagonal + entry * entry).sqrt();
    Some((diagonal / size, entry / size))
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
fn back_substitute<T: Real>(rows: &[T], right: &[T], x: &mut [T]) {
    let n = x.len();
    x.fill(T::zero());
    for (j, row) in rows.chunks_exact(n).enumerate().rev() {
        x[j] = (right[j] - dot(row, x)) / row[j];
    }
}
