//! Singular values and right singular vectors by one-sided Jacobi rotations.
//!
//! In:  columns of `G`, and columns of an orthogonal basis `V`.
//! Out: `G J` with orthogonal columns in order of size, and `V J`, where `J` is
//!      orthogonal: the norms are the singular values of `G`, and the columns of
//!      `V J` under zero columns span its null space.
//!
//! Small singular values keep their digits as far as the entries of `G` do, which
//! is why this method is used here. Source: Demmel & Veselić, *Jacobi's method is
//! more accurate than QR*, SIAM J. Matrix Anal. Appl. 13 (1992).

use super::column::pair;
use super::dot;
use crate::Real;

/// Sweeps after which rotations stop. Convergence is quadratic: even a hundred
/// columns need about ten.
const MAX_SWEEPS: usize = 40;

/// The columns were not finite, so no sweep could end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Breakdown;

/// Rotates the columns of `g` until they are orthogonal, and those of `v` with
/// them; then sorts both by falling norm. Columns, of the lengths that are given, lie one
/// after the other, as many as there are `squares`, which become those of the columns of `g`.
/// There are no more columns than `v` has rows.
///
/// Columns below the round-off of the largest are left as they are: they are
/// zero but for noise.
pub(crate) fn orthogonalise<T: Real>(
    (g, of_g): (&mut [T], usize),
    (v, of_v): (&mut [T], usize),
    squares: &mut [T],
) -> Result<(), Breakdown> {
    let count = squares.len();
    let mut pair = Pair {
        g,
        v,
        squares,
        lengths: (of_g, of_v),
        count,
    };
    pair.orthogonalise()
}

/// The columns of both, one after the other.
struct Pair<'a, T> {
    g: &'a mut [T],
    v: &'a mut [T],
    /// Of the columns of `G`, since the first sweep.
    squares: &'a mut [T],
    /// How long a column of each is.
    lengths: (usize, usize),
    count: usize,
}

impl<T: Real> Pair<'_, T> {
    fn orthogonalise(&mut self) -> Result<(), Breakdown> {
        let mut largest = T::zero();
        for i in 0..self.count {
            largest += self.square(i);
        }
        if !largest.is_finite() {
            return Err(Breakdown);
        }
        let floor = largest * T::EPSILON * T::EPSILON;
        for _ in 0..MAX_SWEEPS {
            if !self.sweep(floor) {
                self.sort();
                return Ok(());
            }
        }
        Err(Breakdown)
    }

    /// A column of `G`.
    fn column(&self, i: usize) -> &[T] {
        let length = self.lengths.0;
        &self.g[i * length..(i + 1) * length]
    }

    /// Its square.
    fn square(&self, i: usize) -> T {
        dot(self.column(i), self.column(i))
    }

    /// One rotation of every pair that needs it; whether there was one.
    #[inline(never)]
    fn sweep(&mut self, floor: T) -> bool {
        let threshold = T::EPSILON * T::from_f64(self.lengths.0 as f64);
        let mut rotated = false;
        for i in 0..self.count {
            self.squares[i] = self.square(i);
        }
        for i in 0..self.count {
            for j in i + 1..self.count {
                let (aa, bb) = (self.squares[i], self.squares[j]);
                let ab = dot(self.column(i), self.column(j));
                if ab.abs() <= threshold * aa.sqrt() * bb.sqrt() || aa.max(bb) <= floor {
                    continue;
                }
                let (c, s) = rotation(aa, bb, ab);
                turn_columns(self.g, self.lengths.0, (i, j), (c, s));
                turn_columns(self.v, self.lengths.1, (i, j), (c, s));
                // A column of noise beside a large one can keep a product above the
                // threshold for ever; turning it is right, waiting for it is not.
                rotated |= aa.min(bb) > floor;
                self.squares[i] = self.square(i);
                self.squares[j] = self.square(j);
            }
        }
        rotated
    }

    /// Largest columns of `G` first, `V` in the same order.
    #[inline(never)]
    fn sort(&mut self) {
        for i in 0..self.count {
            let mut first = i;
            for j in i + 1..self.count {
                if self.squares[j] > self.squares[first] {
                    first = j;
                }
            }
            if first != i {
                self.squares.swap(i, first);
                let (k, n) = self.lengths;
                let [here, there] = pair(self.g, k, i, first);
                here.swap_with_slice(there);
                let [here, there] = pair(self.v, n, i, first);
                here.swap_with_slice(there);
            }
        }
    }
}

/// Turns two columns of so many entries about each other.
pub(super) fn turn_columns<T: Real>(
    columns: &mut [T],
    length: usize,
    (i, j): (usize, usize),
    (c, s): (T, T),
) {
    let [a, b] = pair(columns, length, i, j);
    for (a, b) in a.iter_mut().zip(b) {
        (*a, *b) = (c * *a - s * *b, s * *a + c * *b);
    }
}

/// Cosine and sine of the angle that makes two columns orthogonal, from their products;
/// also that which makes the entry between two axes of a symmetric matrix vanish.
pub(super) fn rotation<T: Real>(aa: T, bb: T, ab: T) -> (T, T) {
    let zeta = (bb - aa) / (ab + ab);
    let size = zeta.abs() + (T::one() + zeta * zeta).sqrt();
    let tangent = if zeta < T::zero() {
        -T::one() / size
    } else {
        T::one() / size
    };
    let c = T::one() / (T::one() + tangent * tangent).sqrt();
    (c, c * tangent)
}
