//! Cholesky factor of a symmetric positive definite matrix.
//!
//! In:  `M`, `N × N`.
//! Out: `U` with `M = U Uᵀ`, or the pivot that is not safely positive; products
//!      with `U⁻¹`, `U⁻ᵀ` and `Uᵀ`; whether `M` is safely definite at all.
//!
//! The factor is upper and begins with the last row, since coordinates are mostly
//! written from the ground outwards: bodies on different branches of a tree have no
//! entry in common then, and get none. Source: Featherstone, *Efficient factorization
//! of the joint-space inertia matrix for branched kinematic trees*, Int. J. Robotics
//! Research 24 (2005).
//!
//! Not here: what to do with a matrix that is only semi-definite.

use super::{Workspace, add_scaled, dot, scale};
use crate::Real;
use crate::tolerance::definite;
use nalgebra::SMatrix;

/// Whether a symmetric matrix is safely positive definite, whatever the units and
/// the order of its rows.
///
/// [`Cholesky::factorise`] takes the rows as they come. Of a semi-definite matrix with
/// a tiny diagonal entry it divides round-off by that entry, and sees no pivot vanish.
/// Here the largest pivot, relative to its diagonal entry, goes first.
pub(crate) fn is_definite<T: Real>(matrix: &[T], n: usize, workspace: &Workspace<'_, T>) -> bool {
    workspace.scope(|workspace| {
        let rest = workspace.numbers(n * n);
        rest.copy_from_slice(matrix);
        eliminate_definite(matrix, rest, n, workspace.indices(n))
    })
}

/// Eliminates what is to be the `rest` of a matrix; whether all its pivots are positive.
fn eliminate_definite<T: Real>(matrix: &[T], rest: &mut [T], n: usize, open: &mut [usize]) -> bool {
    for (j, index) in open.iter_mut().enumerate() {
        *index = j;
    }
    for left in (1..=n).rev() {
        let ratio = |j: usize| rest[j * (n + 1)] / matrix[j * (n + 1)];
        let mut best = 0;
        for place in 1..left {
            // A comparison with NaN is false, so that a ratio that is NaN gives way.
            let stays = ratio(open[best]) >= ratio(open[place]);
            if !stays {
                best = place;
            }
        }
        let next = open[best];
        // In their order, so that of equal ones the first is taken.
        open[best..left].rotate_left(1);
        let pivot = rest[next * (n + 1)];
        // A comparison with NaN is false, so that a pivot that is NaN is not definite.
        let is_large = pivot > definite::<T>() * matrix[next * (n + 1)];
        if !is_large {
            return false;
        }
        for &j in &open[..left - 1] {
            let share = rest[j * n + next] / pivot;
            if share != T::zero() {
                for &i in &open[..left - 1] {
                    let change = share * rest[i * n + next];
                    rest[j * n + i] -= change;
                }
            }
        }
    }
    true
}

/// Size from which on it pays to look for zeros.
const LONG: usize = 16;

/// The upper factor `U`; entries below the diagonal are not used.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cholesky<T, const N: usize> {
    upper: SMatrix<T, N, N>,
}

/// The row whose pivot is not safely positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NotDefinite {
    pub(crate) row: usize,
}

impl<T: Real, const N: usize> Default for Cholesky<T, N> {
    fn default() -> Self {
        Self {
            upper: SMatrix::zeros(),
        }
    }
}

/// Whether what is multiplied by an entry can be left out.
#[inline(always)]
fn is_skipped<T: Real, const N: usize>(entry: T) -> bool {
    N >= LONG && entry == T::zero()
}

/// `x := U⁻¹ x`, for a factor of any size, column by column.
pub(crate) fn solve_upper<T: Real>(upper: &[T], x: &mut [T]) {
    let n = x.len();
    for (j, column) in upper.chunks_exact(n).enumerate().rev() {
        let value = x[j] / column[j];
        x[j] = value;
        if value != T::zero() {
            add_scaled(&mut x[..j], -value, &column[..j]);
        }
    }
}

/// `x := U⁻ᵀ x`, likewise.
pub(crate) fn solve_upper_transposed<T: Real>(upper: &[T], x: &mut [T]) {
    let n = x.len();
    for (j, column) in upper.chunks_exact(n).enumerate() {
        x[j] = (x[j] - dot(&column[..j], &x[..j])) / column[j];
    }
}

/// `x := U x`, likewise.
pub(crate) fn multiply_upper<T: Real>(upper: &[T], x: &mut [T]) {
    let n = x.len();
    for (j, column) in upper.chunks_exact(n).enumerate() {
        let value = x[j];
        x[j] = T::zero();
        add_scaled(&mut x[..=j], value, &column[..=j]);
    }
}

/// `Uᵀ x`, likewise.
pub(crate) fn multiply_upper_transposed<T: Real>(upper: &[T], x: &[T], product: &mut [T]) {
    let columns = upper.chunks_exact(x.len());
    for (j, (target, column)) in product.iter_mut().zip(columns).enumerate() {
        *target = dot(&column[..=j], &x[..=j]);
    }
}

/// `U⁻¹aᵀ` for one row `a` of a Jacobian of so many rows, which stands column by column.
pub(crate) fn lift_row<T: Real>(
    upper: &[T],
    jacobian: &[T],
    (row, rows): (usize, usize),
    lifted: &mut [T],
) {
    for (entry, levers) in lifted.iter_mut().zip(jacobian.chunks_exact(rows)) {
        *entry = levers[row];
    }
    solve_upper(upper, lifted);
}

/// `U⁻¹aᵀ` for some rows `a` of a Jacobian, one after the other, each multiplied by its scale.
pub(crate) fn lift_rows<T: Real>(
    upper: &[T],
    jacobian: &[T],
    scales: &[T],
    chosen: impl Iterator<Item = usize>,
    lifted: &mut [T],
) {
    let n = jacobian.len() / scales.len();
    for (row, vector) in chosen.zip(lifted.chunks_exact_mut(n)) {
        lift_row(upper, jacobian, (row, scales.len()), vector);
        scale(vector, scales[row]);
    }
}

/// The diagonal of `U Uᵀ`, of `n` rows.
pub(crate) fn diagonal<T: Real>(upper: &[T], n: usize) -> impl Iterator<Item = T> {
    (0..n).map(move |i| {
        let row = upper[i * n..].iter().skip(i).step_by(n);
        row.fold(T::zero(), |sum, entry| sum + *entry * *entry)
    })
}

/// What coordinates are multiplied by to have size one in the metric of a factor of any size:
/// one over the roots of its diagonal.
pub(crate) fn set_units<T: Real>(upper: &[T], units: &mut [T]) {
    let n = units.len();
    for (unit, square) in units.iter_mut().zip(diagonal(upper, n)) {
        *unit = T::one() / square.sqrt();
    }
}

/// `√(xᵀ U Uᵀ x)`, the length of `x` in the metric of a factor of any size.
pub(crate) fn length<T: Real>(upper: &[T], x: &[T]) -> T {
    let mut sum = T::zero();
    for (j, column) in upper.chunks_exact(x.len()).enumerate() {
        let part = dot(&column[..=j], &x[..=j]);
        sum += part * part;
    }
    sum.sqrt()
}

impl<T: Real, const N: usize> Cholesky<T, N> {
    /// Factorises `matrix`, of which the upper triangle is read.
    ///
    /// A pivot is compared with its diagonal entry, so the decision does not
    /// depend on the units of the rows. NaN and infinity are not definite.
    pub(crate) fn factorise(&mut self, matrix: &SMatrix<T, N, N>) -> Result<(), NotDefinite> {
        let upper = &mut self.upper.data.0;
        let source = &matrix.data.0;
        for j in (0..N).rev() {
            let (rest, done) = upper.split_at_mut(j + 1);
            let column = &mut rest[j];
            column[..=j].copy_from_slice(&source[j][..=j]);
            for later in done.iter() {
                let factor = later[j];
                if is_skipped::<T, N>(factor) {
                    continue;
                }
                for i in 0..=j {
                    column[i] -= factor * later[i];
                }
            }
            let pivot = column[j];
            if !(pivot > definite::<T>() * source[j][j] && pivot.is_finite()) {
                return Err(NotDefinite { row: j });
            }
            let root = pivot.sqrt();
            let inverse = T::one() / root;
            column[j] = root;
            for entry in &mut column[..j] {
                *entry *= inverse;
            }
        }
        Ok(())
    }

    /// `x := U⁻¹ x`.
    #[inline]
    pub(crate) fn forward(&self, x: &mut [T; N]) {
        let upper = &self.upper.data.0;
        for j in (0..N).rev() {
            if is_skipped::<T, N>(x[j]) {
                continue;
            }
            let value = x[j] / upper[j][j];
            x[j] = value;
            for i in 0..j {
                x[i] -= value * upper[j][i];
            }
        }
    }

    /// The factor as it is stored, column by column, of which the upper triangle counts.
    pub(crate) fn as_slice(&self) -> &[T] {
        self.upper.as_slice()
    }

    /// `x := U⁻ᵀ x`.
    #[inline]
    pub(crate) fn backward(&self, x: &mut [T; N]) {
        let upper = &self.upper.data.0;
        for j in 0..N {
            let mut value = x[j];
            for i in 0..j {
                value -= upper[j][i] * x[i];
            }
            x[j] = value / upper[j][j];
        }
    }

    /// `√(xᵀ M x)`, the length of `x` in the metric of the matrix.
    pub(crate) fn length(&self, x: &[T; N]) -> T {
        length(self.upper.as_slice(), x)
    }
}
