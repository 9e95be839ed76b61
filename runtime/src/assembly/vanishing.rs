//! Constraints that lose their gradient where they hold, and can't be crossed there.
//!
//! In:  an assembled position, the scales of the guess that led to it.
//! Out: such a constraint, if there is one.
//!
//! A sum of squares that is zero is of this kind. It holds at a point, or along a line
//! of fewer dimensions than one equation leaves, and what is found is the point up to
//! the root of round-off: a run would go on in steps as small as that.

use super::scales::Scales;
use crate::tolerance::regular;
use crate::{Mechanism, Position, Real, State};

/// How far around a position the sign of a constraint is looked at, in sizes of the
/// coordinates.
const AROUND: f64 = 1e-2;

/// A constraint equation whose gradient is as good as none at a position, compared with
/// what it was around the guess, and whose error has one sign wherever it is looked at
/// around the position; `at` is that position, and used up, `round_off` what errors of one
/// unit of [`Scales::reach`] have.
pub(super) fn vanishing_row<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    state: &State<T, N>,
    at: &mut Position<T, N, R>,
    scales: &Scales<T, N, R>,
    round_off: T,
) -> Option<usize> {
    let lost: [bool; R] = core::array::from_fn(|row| {
        let entries = at.jacobian.row(row);
        let lengths = entries.iter().zip(scales.columns.iter());
        let square = lengths.fold(T::zero(), |sum, (a, c)| sum + *a * *a * *c * *c);
        let size = square.sqrt() * scales.rows[row];
        scales.rows[row] > T::zero() && size <= regular()
    });
    (0..R).filter(|row| lost[*row]).find(|row| {
        let noise = round_off * scales.reach[*row];
        has_one_sign(mechanism, (state, at), scales, *row, noise)
    })
}

/// Whether the error of a constraint is nowhere positive or nowhere negative around a
/// position, along each coordinate and between each two; `at` is a buffer.
fn has_one_sign<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    (state, at): (&State<T, N>, &mut Position<T, N, R>),
    scales: &Scales<T, N, R>,
    row: usize,
    noise: T,
) -> bool {
    let (mut above, mut below) = (false, false);
    let mut look = |moved: &State<T, N>| {
        mechanism.position(moved, at);
        above |= at.residual[row] > noise;
        below |= at.residual[row] < -noise;
    };
    let distance = |i: usize, sign: f64| scales.sizes[i] * T::from_f64(AROUND * sign);
    for i in 0..N {
        for sign in [1.0, -1.0] {
            let mut moved = *state;
            moved.q[i] += distance(i, sign);
            look(&moved);
            for j in 0..i {
                for other in [1.0, -1.0] {
                    let mut both = moved;
                    both.q[j] += distance(j, other);
                    look(&both);
                }
            }
        }
    }
    above != below
}
