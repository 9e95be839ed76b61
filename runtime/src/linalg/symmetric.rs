//! Eigenvalues and eigenvectors of a small symmetric matrix.
//!
//! In:  a symmetric matrix.
//! Out: its eigenvalues and an orthonormal basis of eigenvectors.
//!
//! Source: Golub & Van Loan, *Matrix Computations* (2013), section 8.5 (Jacobi's method).

use super::column::turn;
use super::jacobi::rotation;
use crate::Real;

/// Sweeps after which rotations stop. Convergence is quadratic.
const MAX_SWEEPS: usize = 40;

/// The eigenvalues of the first `count` rows and columns, and the eigenvectors as
/// columns of `vectors`.
pub(crate) fn eigen<T: Real, const N: usize>(
    mut matrix: [[T; N]; N],
    count: usize,
) -> ([T; N], [[T; N]; N]) {
    let mut vectors = [[T::zero(); N]; N];
    for (i, vector) in vectors.iter_mut().enumerate() {
        vector[i] = T::one();
    }
    for _ in 0..MAX_SWEEPS {
        let mut turned = false;
        for i in 0..count {
            for j in i + 1..count {
                turned |= eliminate(&mut matrix, &mut vectors, i, j);
            }
        }
        if !turned {
            break;
        }
    }
    (core::array::from_fn(|i| matrix[i][i]), vectors)
}

/// Turns two axes until the entry between them vanishes; whether it was worth it.
fn eliminate<T: Real, const N: usize>(
    matrix: &mut [[T; N]; N],
    vectors: &mut [[T; N]; N],
    i: usize,
    j: usize,
) -> bool {
    let (a, b, between) = (matrix[i][i], matrix[j][j], matrix[i][j]);
    // False for NaN, too.
    let counts = between.abs() > T::EPSILON * (a.abs() + b.abs());
    if !counts {
        return false;
    }
    let (c, s) = rotation(a, b, between);
    let (left, right) = matrix.split_at_mut(j);
    turn(&mut left[i], &mut right[0], c, s);
    for row in matrix.iter_mut() {
        (row[i], row[j]) = (c * row[i] - s * row[j], s * row[i] + c * row[j]);
    }
    let (left, right) = vectors.split_at_mut(j);
    turn(&mut left[i], &mut right[0], c, s);
    true
}
