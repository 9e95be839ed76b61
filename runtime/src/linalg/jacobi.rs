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

use super::column::turn;
use super::dot;
use crate::Real;

/// Sweeps after which rotations stop. Convergence is quadratic: even a hundred
/// columns need about ten.
const MAX_SWEEPS: usize = 40;

/// The columns were not finite, so no sweep could end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Breakdown;

/// Rotates the columns of `g` until they are orthogonal, and those of `v` with
/// them; then sorts both by falling norm.
///
/// Columns below the round-off of the largest are left as they are: they are
/// zero but for noise.
pub(crate) fn orthogonalise<T: Real, const K: usize, const N: usize>(
    g: &mut [[T; K]],
    v: &mut [[T; N]],
) -> Result<(), Breakdown> {
    let largest = g.iter().fold(T::zero(), |most, x| most + dot(x, x));
    if !largest.is_finite() {
        return Err(Breakdown);
    }
    let floor = largest * T::EPSILON * T::EPSILON;
    for _ in 0..MAX_SWEEPS {
        if !sweep(g, v, floor) {
            sort(g, v);
            return Ok(());
        }
    }
    Err(Breakdown)
}

/// One rotation of every pair that needs it; whether there was one.
fn sweep<T: Real, const K: usize, const N: usize>(
    g: &mut [[T; K]],
    v: &mut [[T; N]],
    floor: T,
) -> bool {
    let count = g.len().min(v.len());
    let threshold = T::EPSILON * T::from_f64(K as f64);
    let mut rotated = false;
    for i in 0..count {
        let mut aa = dot(&g[i], &g[i]);
        for j in i + 1..count {
            let (left, right) = g.split_at_mut(j);
            let (a, b) = (&mut left[i], &mut right[0]);
            let (bb, ab) = (dot(b, b), dot(a, b));
            if ab.abs() <= threshold * aa.sqrt() * bb.sqrt() || aa.max(bb) <= floor {
                continue;
            }
            let (c, s) = rotation(aa, bb, ab);
            turn(a, b, c, s);
            let (left, right) = v.split_at_mut(j);
            turn(&mut left[i], &mut right[0], c, s);
            // A column of noise beside a large one can keep a product above the
            // threshold for ever; turning it is right, waiting for it is not.
            rotated |= aa.min(bb) > floor;
            aa = dot(&g[i], &g[i]);
        }
    }
    rotated
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

/// Largest columns of `g` first, `v` in the same order.
fn sort<T: Real, const K: usize, const N: usize>(g: &mut [[T; K]], v: &mut [[T; N]]) {
    let count = g.len().min(v.len());
    for i in 0..count {
        let mut first = i;
        for j in i + 1..count {
            if dot(&g[j], &g[j]) > dot(&g[first], &g[first]) {
                first = j;
            }
        }
        g.swap(i, first);
        v.swap(i, first);
    }
}
