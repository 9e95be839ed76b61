//! Levenberg–Marquardt for small dense problems.
//!
//! Source: J. Nocedal and S. Wright, Numerical Optimization (2006), section 10.3.

use super::basis::norm;

/// Iterations. Ordinary solutions take ten; at a double zero the error halves in
/// each.
const ITERATIONS: usize = 120;
/// The damping at the beginning, relative to the largest diagonal element.
const DAMPING: f64 = 1e-3;
/// Damping stays above this, so that dependent equations leave a matrix that can be
/// factorised.
const LEAST_DAMPING: f64 = 1e-13;
/// With this damping no step is worth taking.
const MOST_DAMPING: f64 = 1e12;
/// A step of this length, relative to the point, is round-off: if it does not help, no
/// shorter one does.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// Values of functions, and their derivatives row by row.
pub type ValuesAndJacobian = (Vec<f64>, Vec<Vec<f64>>);

/// The point near a guess where the sum of squares has a minimum; `None` if the
/// functions are not finite at the guess.
pub fn minimise(
    guess: &[f64],
    functions: &dyn Fn(&[f64]) -> ValuesAndJacobian,
) -> Option<Vec<f64>> {
    let mut x = guess.to_vec();
    let (mut values, mut slopes) = functions(&x);
    let mut size = finite(&values, &slopes)?;
    let mut damping = DAMPING;
    for _ in 0..ITERATIONS {
        if size == 0.0 || damping > MOST_DAMPING {
            break;
        }
        let Some(step) = step(&values, &slopes, damping) else {
            damping *= 10.0;
            continue;
        };
        let next: Vec<f64> = x.iter().zip(&step).map(|(x, step)| x + step).collect();
        let there = functions(&next);
        match finite(&there.0, &there.1) {
            Some(smaller) if smaller < size => {
                (x, size) = (next, smaller);
                (values, slopes) = there;
                damping = (damping / 10.0).max(LEAST_DAMPING);
            }
            _ if norm(&step) <= ROUND_OFF * norm(&x) => break,
            _ => damping *= 10.0,
        }
    }
    Some(x)
}

/// The length of the values, if they and the derivatives are finite.
fn finite(values: &[f64], slopes: &[Vec<f64>]) -> Option<f64> {
    let all = slopes.iter().flatten().all(|slope| slope.is_finite());
    Some(norm(values)).filter(|size| all && size.is_finite())
}

/// Solves `(AᵀA + λ max diag) Δ = −Aᵀ f`.
fn step(values: &[f64], slopes: &[Vec<f64>], damping: f64) -> Option<Vec<f64>> {
    let n = slopes.first().map_or(0, Vec::len);
    let mut matrix = vec![vec![0.0; n]; n];
    let mut right = vec![0.0; n];
    for (value, row) in values.iter().zip(slopes) {
        for i in 0..n {
            right[i] -= value * row[i];
            for j in 0..=i {
                matrix[i][j] += row[i] * row[j];
            }
        }
    }
    let largest = (0..n).map(|i| matrix[i][i]).fold(0.0, f64::max);
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] += damping * largest;
    }
    factorise(&mut matrix)?;
    Some(solve(&matrix, right))
}

/// Cholesky's factor in place, in the lower triangle.
fn factorise(matrix: &mut [Vec<f64>]) -> Option<()> {
    for i in 0..matrix.len() {
        for j in 0..=i {
            let done: f64 = (0..j).map(|k| matrix[i][k] * matrix[j][k]).sum();
            let rest = matrix[i][j] - done;
            matrix[i][j] = if i == j {
                Some(rest.sqrt()).filter(|root| *root > 0.0)?
            } else {
                rest / matrix[j][j]
            };
        }
    }
    Some(())
}

fn solve(factor: &[Vec<f64>], mut x: Vec<f64>) -> Vec<f64> {
    let n = x.len();
    for i in 0..n {
        let done: f64 = (0..i).map(|k| factor[i][k] * x[k]).sum();
        x[i] = (x[i] - done) / factor[i][i];
    }
    for i in (0..n).rev() {
        let done: f64 = (i + 1..n).map(|k| factor[k][i] * x[k]).sum();
        x[i] = (x[i] - done) / factor[i][i];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::minimise;

    #[test]
    fn a_circle_and_a_line_meet_and_a_double_zero_is_reached() {
        let both = |x: &[f64]| {
            let values = vec![x[0] * x[0] + x[1] * x[1] - 1.0, x[0] - x[1]];
            (values, vec![vec![2.0 * x[0], 2.0 * x[1]], vec![1.0, -1.0]])
        };
        let found = minimise(&[2.0, 0.1], &both).expect("a finite problem");
        assert!((found[0] - 0.5_f64.sqrt()).abs() < 1e-14);
        let double = |x: &[f64]| (vec![1.0 - x[0].cos()], vec![vec![x[0].sin()]]);
        let found = minimise(&[1.0], &double).expect("a finite problem");
        assert!(found[0].abs() < 1e-6);
    }
}
