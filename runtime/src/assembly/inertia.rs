//! Kinetic energy that is negative.
//!
//! In:  the mass matrix.
//! Out: the coordinate whose motion has a negative kinetic energy, if there is one.
//!
//! Cholesky's elimination, the largest pivot first, which carries the directions along:
//! of a kinetic energy that is nowhere negative nothing is left when no pivot is
//! positive any more.

use crate::Real;
use crate::linalg::Breakdown;
use nalgebra::{SMatrix, SVector};

/// What is left of a semidefinite matrix is round-off up to this multiple of its largest
/// entry.
const ROUND_OFF: f64 = 4096.0;

/// The coordinate that makes the kinetic energy negative, if it can be; unless the mass
/// matrix is not finite.
#[inline(never)]
pub(super) fn negative<T: Real, const N: usize>(
    mass: &SMatrix<T, N, N>,
) -> Result<Option<usize>, Breakdown> {
    if mass.iter().any(|x| !x.is_finite()) {
        return Err(Breakdown);
    }
    // Each coordinate in a unit of its own, in which its inertia is one.
    let mut directions = SMatrix::<T, N, N>::zeros();
    for i in 0..N {
        let inertia = mass[(i, i)].abs();
        directions[(i, i)] = match inertia > T::zero() {
            true => T::one() / inertia.sqrt(),
            false => T::one(),
        };
    }
    let mut rest = SMatrix::<T, N, N>::zeros();
    for j in 0..N {
        for i in 0..N {
            rest[(i, j)] = directions[(i, i)] * (mass[(i, j)] * directions[(j, j)]);
        }
    }
    Ok(found(mass, &mut rest, &mut directions))
}

/// The same, with the mass matrix in directions that have an inertia of one.
fn found<T: Real, const N: usize>(
    mass: &SMatrix<T, N, N>,
    rest: &mut SMatrix<T, N, N>,
    directions: &mut SMatrix<T, N, N>,
) -> Option<usize> {
    let largest = rest.iter().fold(T::zero(), |most: T, x| most.max(x.abs()));
    let floor = largest * T::EPSILON * T::from_f64(ROUND_OFF);
    let mut done = [false; N];
    for _ in 0..N {
        let left = (0..N).filter(|i| !done[*i]);
        let pivot = left.reduce(|p, i| if rest[(i, i)] > rest[(p, p)] { i } else { p })?;
        if rest[(pivot, pivot)] <= floor {
            break;
        }
        done[pivot] = true;
        eliminate(rest, directions, pivot, &done);
    }
    let (direction, least) = least(rest, directions, &done)?;
    if least >= -floor {
        return None;
    }
    let momentum = mass * direction;
    let share = |i: usize| direction[i] * momentum[i];
    (0..N).reduce(|least, i| if share(i) < share(least) { i } else { least })
}

/// Makes the other directions orthogonal to the pivot's in the kinetic metric.
fn eliminate<T: Real, const N: usize>(
    rest: &mut SMatrix<T, N, N>,
    directions: &mut SMatrix<T, N, N>,
    pivot: usize,
    done: &[bool; N],
) {
    let row = SVector::<T, N>::from_fn(|j, _| rest[(pivot, j)]);
    let along = directions.column(pivot).into_owned();
    // Most coordinates share no inertia.
    for j in (0..N).filter(|j| !done[*j] && row[*j] != T::zero()) {
        let factor = row[j] / row[pivot];
        for i in 0..N {
            directions[(i, j)] -= factor * along[i];
        }
        for i in (0..N).filter(|i| !done[*i]) {
            rest[(i, j)] -= factor * row[i];
        }
    }
}

/// The direction of least energy among what is left and the differences and sums of two,
/// and twice that energy.
fn least<T: Real, const N: usize>(
    rest: &SMatrix<T, N, N>,
    directions: &SMatrix<T, N, N>,
    done: &[bool; N],
) -> Option<(SVector<T, N>, T)> {
    let mut least: Option<(SVector<T, N>, T)> = None;
    let mut take = |direction: SVector<T, N>, energy: T| {
        if least.as_ref().is_none_or(|(_, known)| energy < *known) {
            least = Some((direction, energy));
        }
    };
    for i in (0..N).filter(|i| !done[*i]) {
        take(directions.column(i).into_owned(), rest[(i, i)]);
        for j in (0..i).filter(|j| !done[*j]) {
            let (own, mixed) = (rest[(i, i)] + rest[(j, j)], rest[(i, j)]);
            let (first, second) = (directions.column(i), directions.column(j));
            if mixed > T::zero() {
                take(first - second, own - mixed - mixed);
            } else {
                take(first + second, own + mixed + mixed);
            }
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::negative;
    use nalgebra::{Matrix2, Matrix3};

    #[test]
    fn a_negative_energy_is_found_wherever_it_hides() {
        assert_eq!(negative(&Matrix2::new(2.0, 0.0, 0.0, -3e-9)), Ok(Some(1)));
        assert!(matches!(
            negative(&Matrix2::new(1.0, 2.0, 2.0, 1.0)),
            Ok(Some(_))
        ));
        assert!(matches!(
            negative(&Matrix2::new(0.0, 1.0, 1.0, 0.0)),
            Ok(Some(_))
        ));
        let last = Matrix3::new(4.0, 2.0, 0.0, 2.0, 4.0, 3.0, 0.0, 3.0, 2.9);
        assert!(matches!(negative(&last), Ok(Some(_))));
    }

    #[test]
    fn a_motion_without_energy_is_not_one_with_negative_energy() {
        assert_eq!(negative(&Matrix2::<f64>::zeros()), Ok(None));
        let rows = Matrix3::new(0.1, 0.7, 1e5, 0.3, 2.1, 3e5, 1e-3, 7e-3, 1e3);
        assert_eq!(negative(&(rows.transpose() * rows)), Ok(None));
        let last = Matrix3::new(4.0, 2.0, 0.0, 2.0, 4.0, 3.0, 0.0, 3.0, 3.1);
        assert_eq!(negative(&last), Ok(None));
    }
}
