//! Least squares in `2N` unknowns, one row at a time.
//!
//! In:  rows `[a b | c]`, each standing for `aᵀx + bᵀy = c`.
//! Out: the `x`, `y` (`N` each) of least squares.
//!
//! Every row is turned into a triangular factor by Givens rotations and then
//! forgotten, so the number of rows needs no name and no product `BᵀB` squares
//! the condition number. The factor is held in blocks because stable Rust cannot
//! name a `2N × 2N` matrix.

use super::dot;
use crate::Real;
use nalgebra::{SMatrix, SVector};

/// The triangular factor `[P Q; 0 S]` and the right-hand sides. Rows of the
/// factor are columns here, so that they are contiguous.
#[derive(Clone, Debug)]
pub(crate) struct Triangle<T, const N: usize> {
    p: SMatrix<T, N, N>,
    q: SMatrix<T, N, N>,
    s: SMatrix<T, N, N>,
    upper: SVector<T, N>,
    lower: SVector<T, N>,
}

impl<T: Real, const N: usize> Default for Triangle<T, N> {
    fn default() -> Self {
        let (p, q, s) = (SMatrix::zeros(), SMatrix::zeros(), SMatrix::zeros());
        let (upper, lower) = (SVector::zeros(), SVector::zeros());
        Self {
            p,
            q,
            s,
            upper,
            lower,
        }
    }
}

impl<T: Real, const N: usize> Triangle<T, N> {
    /// Adds the equation `aᵀx + bᵀy = c`.
    pub(crate) fn insert(&mut self, mut a: [T; N], mut b: [T; N], mut c: T) {
        for j in 0..N {
            let row = &mut self.p.data.0[j];
            if let Some((cos, sin)) = eliminate(row[j], a[j]) {
                rotate(row, &mut a, cos, sin);
                rotate(&mut self.q.data.0[j], &mut b, cos, sin);
                rotate_pair(&mut self.upper[j], &mut c, cos, sin);
            }
        }
        for j in 0..N {
            let row = &mut self.s.data.0[j];
            if let Some((cos, sin)) = eliminate(row[j], b[j]) {
                rotate(row, &mut b, cos, sin);
                rotate_pair(&mut self.lower[j], &mut c, cos, sin);
            }
        }
    }

    /// The unknowns `x`, `y`; not finite where the rows do not determine them.
    pub(crate) fn solve(&self) -> (SVector<T, N>, SVector<T, N>) {
        let y = back_substitute(&self.s.data.0, self.lower);
        let mut upper = self.upper;
        for j in 0..N {
            upper[j] -= dot(&self.q.data.0[j], &y.data.0[0]);
        }
        (back_substitute(&self.p.data.0, upper), y)
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

fn rotate<T: Real, const N: usize>(row: &mut [T; N], other: &mut [T; N], cos: T, sin: T) {
    for i in 0..N {
        rotate_pair(&mut row[i], &mut other[i], cos, sin);
    }
}

#[inline(always)]
fn rotate_pair<T: Real>(x: &mut T, y: &mut T, cos: T, sin: T) {
    (*x, *y) = (cos * *x + sin * *y, cos * *y - sin * *x);
}

/// Solves with an upper triangular matrix given by rows.
fn back_substitute<T: Real, const N: usize>(
    rows: &[[T; N]; N],
    mut x: SVector<T, N>,
) -> SVector<T, N> {
    let mut solved = SVector::zeros();
    for j in (0..N).rev() {
        x[j] -= dot(&rows[j], &solved.data.0[0]);
        solved[j] = x[j] / rows[j][j];
    }
    solved
}
