//! Eigenvalues and eigenvectors of a small symmetric matrix.
//!
//! In:  a symmetric matrix.
//! Out: its eigenvalues and an orthonormal basis of eigenvectors.
//!
//! Source: Golub & Van Loan, *Matrix Computations* (2013), section 8.5 (Jacobi's method).

use super::jacobi::{rotation, turn_columns};
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
    let (entries, columns) = (matrix.as_flattened_mut(), vectors.as_flattened_mut());
    diagonalise(entries, columns, N, count);
    let mut values = [T::zero(); N];
    for (i, value) in values.iter_mut().enumerate() {
        *value = matrix[i][i];
    }
    (values, vectors)
}

/// Turns the first `count` axes until the entries between them vanish, in a matrix of `n`
/// rows.
fn diagonalise<T: Real>(matrix: &mut [T], vectors: &mut [T], n: usize, count: usize) {
    for _ in 0..MAX_SWEEPS {
        let mut turned = false;
        for i in 0..count {
            for j in i + 1..count {
                turned |= eliminate(matrix, vectors, n, (i, j));
            }
        }
        if !turned {
            break;
        }
    }
}

/// Turns two axes until the entry between them vanishes; whether it was worth it.
fn eliminate<T: Real>(
    matrix: &mut [T],
    vectors: &mut [T],
    n: usize,
    (i, j): (usize, usize),
) -> bool {
    let (a, b, between) = (matrix[i * n + i], matrix[j * n + j], matrix[i * n + j]);
    // False for NaN, too.
    let counts = between.abs() > T::EPSILON * (a.abs() + b.abs());
    if !counts {
        return false;
    }
    let (c, s) = rotation(a, b, between);
    turn_columns(matrix, n, (i, j), (c, s));
    for row in matrix.chunks_exact_mut(n) {
        (row[i], row[j]) = (c * row[i] - s * row[j], s * row[i] + c * row[j]);
    }
    turn_columns(vectors, n, (i, j), (c, s));
    true
}
