//! Coefficients of the implicit method: Radau IIA with three stages.
//!
//! In:  nothing.
//! Out: nodes, matrix, and its eigenvalues with left and right eigenvectors, in
//!      the precision of the scalar.
//!
//! Everything is an algebraic number and computed from its closed form.
//!
//! Source: Hairer & Wanner, Solving Ordinary Differential Equations II (1996),
//! table IV.5.6 and section IV.8.

use crate::Real;
use nalgebra::Complex;

/// Radau IIA with three stages, of order 5.
#[derive(Clone, Debug)]
pub(super) struct Collocation<T> {
    /// `c_i`.
    pub(super) nodes: [T; 3],
    /// `A`, as rows.
    pub(super) matrix: [[T; 3]; 3],
    /// `A²`, as rows.
    pub(super) square: [[T; 3]; 3],
    /// Weights of the error estimate for `Y_i − y₀`.
    pub(super) error: [T; 3],
    /// The real eigenvalue of `A`.
    pub(super) real: Eigen<T>,
    /// One of the two complex eigenvalues of `A`.
    pub(super) complex: Eigen<Complex<T>>,
}

/// An eigenvalue with its vectors, `left · right = 1`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eigen<F> {
    pub(super) value: F,
    pub(super) left: [F; 3],
    pub(super) right: [F; 3],
}

impl<T: Real> Collocation<T> {
    pub(super) fn new() -> Self {
        let n = T::from_f64;
        let root = n(6.0).sqrt();
        let nodes = [
            (n(4.0) - root) / n(10.0),
            (n(4.0) + root) / n(10.0),
            T::one(),
        ];
        let matrix = [
            [
                (n(88.0) - n(7.0) * root) / n(360.0),
                (n(296.0) - n(169.0) * root) / n(1800.0),
                (n(-2.0) + n(3.0) * root) / n(225.0),
            ],
            [
                (n(296.0) + n(169.0) * root) / n(1800.0),
                (n(88.0) + n(7.0) * root) / n(360.0),
                (n(-2.0) - n(3.0) * root) / n(225.0),
            ],
            [
                (n(16.0) - root) / n(36.0),
                (n(16.0) + root) / n(36.0),
                n(1.0) / n(9.0),
            ],
        ];
        let square = core::array::from_fn(|i| {
            core::array::from_fn(|j| {
                (0..3).fold(T::zero(), |sum, k| sum + matrix[i][k] * matrix[k][j])
            })
        });
        let third = T::one() / n(3.0);
        let (more, less) = (n(81.0).powf(third), n(9.0).powf(third));
        let value = (n(6.0) + more - less) / n(30.0);
        let pair = Complex::new(
            (n(12.0) - more + less) / n(60.0),
            (more + less) * n(3.0).sqrt() / n(60.0),
        );
        let weight = value / n(3.0);
        let seven = n(7.0) * root;
        Self {
            nodes,
            matrix,
            square,
            error: [
                -(n(13.0) + seven) * weight,
                (seven - n(13.0)) * weight,
                -weight,
            ],
            real: eigen(matrix, value),
            complex: eigen(
                matrix.map(|row| row.map(|x| Complex::new(x, T::zero()))),
                pair,
            ),
        }
    }
}

/// What eigenvectors can consist of.
trait Number:
    Copy
    + core::ops::Add<Output = Self>
    + core::ops::Sub<Output = Self>
    + core::ops::Mul<Output = Self>
    + core::ops::Div<Output = Self>
{
}

impl<F> Number for F where
    F: Copy
        + core::ops::Add<Output = F>
        + core::ops::Sub<Output = F>
        + core::ops::Mul<Output = F>
        + core::ops::Div<Output = F>
{
}

/// The vectors of an eigenvalue: `A − λ` has rank two, so its null vectors are
/// the cross products of two rows and of two columns.
fn eigen<F: Number>(matrix: [[F; 3]; 3], value: F) -> Eigen<F> {
    let mut rows = matrix;
    for (i, row) in rows.iter_mut().enumerate() {
        row[i] = row[i] - value;
    }
    let column = |j: usize| [rows[0][j], rows[1][j], rows[2][j]];
    let right = cross(rows[0], rows[1]);
    let left = cross(column(0), column(1));
    let scale = left[0] * right[0] + left[1] * right[1] + left[2] * right[2];
    Eigen {
        value,
        left: left.map(|x| x / scale),
        right,
    }
}

fn cross<F: Number>(a: [F; 3], b: [F; 3]) -> [F; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
