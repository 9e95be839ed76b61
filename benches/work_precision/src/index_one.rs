//! diffsol on the index-1 equations, written by hand.
//!
//! `[M Aᵀ; A 0] [q̈; λ] = [p₁; p₂ − 2α ġ − α² g]`, solved by elimination with partial
//! pivoting; the gain α keeps the constraints. Nothing else treats the singular
//! positions.

use crate::problem::{End, Failed, Problem};
use beside::tsit45;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{State, Terms};
use instructions::hand::{ByHand, DoubleFourBar, SliderCrank};

/// Runs a problem from a start angle at rest.
///
/// # Errors
///
/// A solver that stops.
pub fn run(problem: Problem, start: f64, gain: f64, tolerance: f64) -> Result<End, Failed> {
    let q = problem.coordinates(start);
    let until = problem.end();
    match problem {
        Problem::Free => solve::<3>(&q, until, tolerance, |q, v| {
            acceleration::<_, 3, 2, 5>(&SliderCrank, q, v, gain, 0.0)
        }),
        Problem::Driven => solve::<3>(&q, until, tolerance, |q, v| {
            acceleration::<_, 3, 2, 5>(&SliderCrank, q, v, gain, 10.0 - 2.0 * v[0])
        }),
        Problem::FourBar => solve::<5>(&q, until, tolerance, |q, v| {
            acceleration::<_, 5, 4, 9>(&DoubleFourBar, q, v, gain, 0.0)
        }),
    }
}

fn solve<const N: usize>(
    start: &[f64],
    until: f64,
    tolerance: f64,
    acceleration: impl Fn(SVector<f64, N>, SVector<f64, N>) -> [f64; N],
) -> Result<End, Failed> {
    tsit45(start, until, tolerance, |q, v, a| {
        let [q, v] = [q, v].map(SVector::from_column_slice);
        a.copy_from_slice(&acceleration(q, v));
    })
}

/// `q̈`; `K = N + R`.
fn acceleration<H, const N: usize, const R: usize, const K: usize>(
    mechanism: &H,
    q: SVector<f64, N>,
    v: SVector<f64, N>,
    gain: f64,
    moment: f64,
) -> [f64; N]
where
    H: ByHand<N, R>,
{
    let state = State { t: 0.0, q, v };
    let mut terms = Terms::<f64, N, R>::default();
    mechanism.terms(&state, &mut terms);
    let open = mechanism.residual(&state);
    let rate = terms.jacobian * v;
    let mut matrix = [[0.0; K]; K];
    let mut right = [0.0; K];
    for i in 0..N {
        for j in 0..N {
            matrix[i][j] = terms.mass[(i, j)];
        }
        right[i] = terms.force[i];
    }
    right[0] += moment;
    for i in 0..R {
        for j in 0..N {
            matrix[N + i][j] = terms.jacobian[(i, j)];
            matrix[j][N + i] = terms.jacobian[(i, j)];
        }
        right[N + i] = terms.bias[i] - 2.0 * gain * rate[i] - gain * gain * open[i];
    }
    eliminate(&mut matrix, &mut right);
    core::array::from_fn(|i| right[i])
}

/// Gaussian elimination with partial pivoting.
fn eliminate<const K: usize>(a: &mut [[f64; K]; K], b: &mut [f64; K]) {
    for j in 0..K {
        let mut pivot = j;
        for i in j + 1..K {
            if a[i][j].abs() > a[pivot][j].abs() {
                pivot = i;
            }
        }
        a.swap(j, pivot);
        b.swap(j, pivot);
        let inverse = 1.0 / a[j][j];
        for i in j + 1..K {
            let factor = a[i][j] * inverse;
            for k in j + 1..K {
                a[i][k] -= factor * a[j][k];
            }
            b[i] -= factor * b[j];
        }
    }
    for i in (0..K).rev() {
        for k in i + 1..K {
            b[i] -= a[i][k] * b[k];
        }
        b[i] /= a[i][i];
    }
}
