//! Kinetic energy that is negative.
//!
//! In:  the mass matrix.
//! Out: the coordinate whose motion has a negative kinetic energy, if there is one.
//!
//! Cholesky's elimination takes the largest pivot first and carries the directions along. If the
//! kinetic energy is nowhere negative, nothing is left once no pivot is positive any more.

use crate::Real;
use crate::linalg::{Breakdown, Workspace, add_scaled, dot, pair};
use crate::once::compiled_once;

/// Square matrices of all coordinates that the elimination takes.
pub(super) const MATRICES: usize = 2;
/// Vectors of all coordinates that the elimination takes.
pub(super) const VECTORS: usize = 2;

/// What is left of a semidefinite matrix is round-off up to this multiple of its largest
/// entry.
const ROUND_OFF: f64 = 4096.0;

/// The coordinate that makes the kinetic energy of `n` coordinates negative, if it can be negative;
/// an error if the mass matrix is not finite. Needs room for a list of the coordinates.
pub(super) fn negative<T: Real>(
    mass: &[T],
    n: usize,
    workspace: &Workspace<'_, T>,
) -> Result<Option<usize>, Breakdown> {
    if mass.iter().any(|x| !x.is_finite()) {
        return Err(Breakdown);
    }
    let mut reduced = Reduced {
        n,
        rest: workspace.numbers(n * n),
        directions: workspace.numbers(n * n),
        done: workspace.indices(n),
    };
    // Each coordinate in a unit of its own, in which its inertia is one, unless that is so small
    // that it has lost digits.
    for i in 0..n {
        let inertia = mass[i * n + i].abs();
        let last_digits = inertia * T::EPSILON * T::EPSILON;
        reduced.directions[i * n + i] = match last_digits > T::zero() {
            true => T::one() / inertia.sqrt(),
            false => T::one(),
        };
    }
    let unit = |i: usize| reduced.directions[i * n + i];
    for j in 0..n {
        for i in 0..n {
            reduced.rest[j * n + i] = unit(i) * (mass[j * n + i] * unit(j));
        }
    }
    let direction = workspace.numbers(n);
    if !reduced.find(direction, workspace.numbers(n)) {
        return Ok(None);
    }
    let share = |i: usize| direction[i] * dot(&mass[i * n..(i + 1) * n], direction);
    Ok((0..n).reduce(|least, i| if share(i) < share(least) { i } else { least }))
}

/// The mass matrix in directions that have an inertia of one.
struct Reduced<'a, T> {
    n: usize,
    /// What is left of the mass matrix, column by column.
    rest: &'a mut [T],
    directions: &'a mut [T],
    /// One for each direction that is eliminated, zero for the others.
    done: &'a mut [usize],
}

impl<T: Real> Reduced<'_, T> {
    /// Whether there is a direction of negative energy, which is written; needs room for a row.
    fn find(&mut self, direction: &mut [T], row: &mut [T]) -> bool {
        let largest = self
            .rest
            .iter()
            .fold(T::zero(), |most: T, x| most.max(x.abs()));
        let floor = largest * T::EPSILON * T::from_f64(ROUND_OFF);
        for _ in 0..self.n {
            let larger = |p: usize, i: usize| if self.at(i, i) > self.at(p, p) { i } else { p };
            let Some(pivot) = self.left().reduce(larger) else {
                break;
            };
            if self.at(pivot, pivot) <= floor {
                break;
            }
            self.done[pivot] = 1;
            self.eliminate(pivot, row);
        }
        self.least(direction).is_some_and(|least| least < -floor)
    }

    /// An entry of what is left.
    fn at(&self, i: usize, j: usize) -> T {
        self.rest[j * self.n + i]
    }

    /// Directions that are not eliminated.
    fn left(&self) -> impl Iterator<Item = usize> {
        (0..self.n).filter(|i| self.done[*i] == 0)
    }

    /// Makes the other directions orthogonal to the pivot's in the kinetic metric.
    fn eliminate(&mut self, pivot: usize, row: &mut [T]) {
        let n = self.n;
        for (j, entry) in row.iter_mut().enumerate() {
            *entry = self.at(pivot, j);
        }
        for j in 0..n {
            // Most coordinates share no inertia.
            if self.done[j] != 0 || row[j] == T::zero() {
                continue;
            }
            let factor = row[j] / row[pivot];
            let [along, direction] = pair(self.directions, n, pivot, j);
            add_scaled(direction, -factor, along);
            let rest = self.rest[j * n..].iter_mut().zip(&*row);
            for ((entry, change), done) in rest.zip(&*self.done) {
                if *done == 0 {
                    *entry -= factor * *change;
                }
            }
        }
    }

    /// The direction of least energy among those that are left and the sums and differences of two
    /// of them; returns twice that energy.
    fn least(&self, direction: &mut [T]) -> Option<T> {
        let mut least: Option<(T, [usize; 2], T)> = None;
        let mut take = |energy: T, of: [usize; 2], factor: T| {
            if least.is_none_or(|(known, ..)| energy < known) {
                least = Some((energy, of, factor));
            }
        };
        for i in self.left() {
            take(self.at(i, i), [i, i], T::zero());
            for j in self.left().take_while(|j| *j < i) {
                let (own, mixed) = (self.at(i, i) + self.at(j, j), self.at(i, j));
                let twice = mixed.abs() + mixed.abs();
                let factor = if mixed > T::zero() {
                    -T::one()
                } else {
                    T::one()
                };
                take(own - twice, [i, j], factor);
            }
        }
        let (energy, [i, j], factor) = least?;
        direction.copy_from_slice(&self.directions[i * self.n..(i + 1) * self.n]);
        add_scaled(
            direction,
            factor,
            &self.directions[j * self.n..(j + 1) * self.n],
        );
        Some(energy)
    }
}

compiled_once! {
    /// [`negative`].
    pub(super) fn negating<T>:
        fn(&[T], usize, &Workspace<'_, T>) -> Result<Option<usize>, Breakdown> = negative;
}

#[cfg(test)]
mod tests {
    use crate::linalg::{Breakdown, Workspace};
    use nalgebra::{Matrix2, Matrix3, SMatrix};

    fn negative<const N: usize>(mass: &SMatrix<f64, N, N>) -> Result<Option<usize>, Breakdown> {
        let mut matrices = [0.0; 64];
        let mut done = [0; N];
        super::negative(
            mass.as_slice(),
            N,
            &Workspace::new(&mut matrices, &mut [], &mut done),
        )
    }

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

    /// The energy of `(x ẏ − y ẋ)²` beside `y = 0`, where squares have lost digits.
    #[test]
    fn an_inertia_below_all_digits_is_none() {
        for y in [1e-150_f64, 1e-155, 1e-158, 1e-160, 1e-161, 1e-165, 1e-200] {
            let mass = Matrix2::new(y * y, -y, -y, 1.0) * 0.14;
            assert_eq!(negative(&mass), Ok(None), "{y}");
        }
    }
}
