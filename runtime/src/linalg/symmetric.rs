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

/// Turns the axes of a matrix of `n` rows until the entries between them vanish: leaves the
/// eigenvalues on its diagonal, and the eigenvectors as columns of `vectors`.
pub(crate) fn diagonalise<T: Real>(matrix: &mut [T], vectors: &mut [T], n: usize) {
    vectors.fill(T::zero());
    for entry in vectors.iter_mut().step_by(n + 1) {
        *entry = T::one();
    }
    for _ in 0..MAX_SWEEPS {
        let mut turned = false;
        for i in 0..n {
            for j in i + 1..n {
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
    // A comparison with NaN is false, so that an entry that is NaN turns no axes.
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
