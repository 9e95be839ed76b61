//! Constraints that lose their gradient where they hold, and can't be crossed there.
//!
//! In:  an assembled position, the scales of the guess that led to it.
//! Out: such a constraint, if there is one.
//!
//! A sum of squares that is zero is of this kind. It holds at a point, or on a set of fewer
//! dimensions than one equation leaves, and that set is found only up to the root of
//! round-off: a run would go on in steps as small as that.

use super::scales::Scales;
use crate::Real;
use crate::equations::Equations;
use crate::linalg::Workspace;
use crate::tolerance::regular;

/// How far around a position the sign of a constraint is looked at, in sizes of the
/// coordinates.
const AROUND: f64 = 1e-2;

/// A constraint equation whose gradient is as good as none at the position where the
/// constraints were evaluated last, compared with what it was around the guess, and whose
/// error has one sign wherever it is looked at around that position; `round_off` is what
/// errors of one unit of [`Scales::reach`] have.
pub(super) fn vanishing_row<T: Real>(
    equations: &mut dyn Equations<T>,
    (t, q): (T, &[T]),
    scales: &Scales<'_, T>,
    round_off: T,
    workspace: &Workspace<'_, T>,
) -> Option<usize> {
    let n_rows = scales.rows.len();
    let moved = workspace.numbers(q.len());
    (0..n_rows).find(|row| {
        let entries = equations.constraints().jacobian.iter();
        let lengths = entries.skip(*row).step_by(n_rows).zip(scales.columns);
        let square = lengths.fold(T::zero(), |sum, (a, c)| sum + *a * *a * *c * *c);
        let size = square.sqrt() * scales.rows[*row];
        if !(scales.rows[*row] > T::zero() && size <= regular()) {
            return false;
        }
        let noise = round_off * scales.reach[*row];
        let found = has_one_sign(equations, (t, q, &mut *moved), scales, (*row, noise));
        equations.locate(t, q);
        found
    })
}

/// Whether the error of a constraint is nowhere positive or nowhere negative around a
/// position, along each coordinate and between each two; with room for another position.
fn has_one_sign<T: Real>(
    equations: &mut dyn Equations<T>,
    (t, q, moved): (T, &[T], &mut [T]),
    scales: &Scales<'_, T>,
    (row, noise): (usize, T),
) -> bool {
    let (mut above, mut below) = (false, false);
    let mut look = |moved: &[T]| {
        equations.locate(t, moved);
        let error = equations.constraints().residual[row];
        above |= error > noise;
        below |= error < -noise;
    };
    let distance = |i: usize, sign: f64| scales.sizes[i] * T::from_f64(AROUND * sign);
    for i in 0..q.len() {
        for sign in [1.0, -1.0] {
            moved.copy_from_slice(q);
            moved[i] += distance(i, sign);
            look(moved);
            for j in 0..i {
                for other in [1.0, -1.0] {
                    moved[j] = q[j] + distance(j, other);
                    look(moved);
                }
                moved[j] = q[j];
            }
        }
    }
    above != below
}
