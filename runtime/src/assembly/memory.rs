//! The memory in which states are assembled.
//!
//! Out: a [`Workspace`] for a mechanism of known sizes.
//!
//! Velocities at a singular position take most: three decompositions, each with a matrix of
//! `R × N`, two of `R × R`, six vectors of all rows and three lists; slopes, another `R × N`;
//! and vectors of scales and steps. With the standard library large mechanisms take it from
//! the heap; without, it has fixed size.

use crate::Real;
use crate::linalg::Workspace;

/// Matrices of all rows and coordinates.
const WIDE: usize = 4;
/// Square matrices of all rows.
const SQUARE: usize = 6;
/// Vectors of all coordinates, of which positions take most.
const COORDINATES: usize = 12;
/// Vectors of all rows.
const ROWS: usize = 29;
/// Lists of indices of all rows.
const LISTS: usize = 9;

/// Memory for a mechanism with `N` coordinates and `R` rows.
#[cfg(feature = "std")]
pub(super) struct Memory<T, const N: usize, const R: usize> {
    /// The memory of small mechanisms.
    small: [T; numbers(SMALL, SMALL)],
    /// The memory of large mechanisms.
    large: Vec<T>,
    lists: [[usize; R]; LISTS],
}

/// Coordinates and rows up to which a mechanism is small.
#[cfg(feature = "std")]
const SMALL: usize = 8;

/// How many numbers are in use at once, at most.
#[cfg(feature = "std")]
const fn numbers(n: usize, n_rows: usize) -> usize {
    n_rows * (WIDE * n + SQUARE * n_rows + ROWS) + COORDINATES * n
}

#[cfg(feature = "std")]
impl<T: Real, const N: usize, const R: usize> Memory<T, N, R> {
    pub(super) fn new() -> Self {
        let count = const { numbers(N, R) };
        let is_small = count <= numbers(SMALL, SMALL);
        Self {
            small: [T::zero(); numbers(SMALL, SMALL)],
            large: vec![T::zero(); if is_small { 0 } else { count }],
            lists: [[0; R]; LISTS],
        }
    }

    /// A workspace of the whole memory.
    pub(super) fn workspace(&mut self) -> Workspace<'_, T> {
        let numbers = match self.large.is_empty() {
            true => &mut self.small[..],
            false => &mut self.large,
        };
        Workspace::new(numbers, &mut [], self.lists.as_flattened_mut())
    }
}

/// Spare matrices: the rest of one of the four pieces of memory may be too small for the next
/// matrix, so that at most three of the largest are lost.
#[cfg(not(feature = "std"))]
const SPARE: usize = 3;

/// Memory for a mechanism with `N` coordinates and `R` rows.
#[cfg(not(feature = "std"))]
pub(super) struct Memory<T, const N: usize, const R: usize> {
    coordinates: [[T; N]; COORDINATES],
    rows: [[T; R]; ROWS],
    wide: [[[T; N]; R]; WIDE + SPARE],
    square: [[[T; R]; R]; SQUARE + SPARE],
    lists: [[usize; R]; LISTS],
}

#[cfg(not(feature = "std"))]
impl<T: Real, const N: usize, const R: usize> Memory<T, N, R> {
    pub(super) fn new() -> Self {
        Self {
            coordinates: [[T::zero(); N]; COORDINATES],
            rows: [[T::zero(); R]; ROWS],
            wide: [[[T::zero(); N]; R]; WIDE + SPARE],
            square: [[[T::zero(); R]; R]; SQUARE + SPARE],
            lists: [[0; R]; LISTS],
        }
    }

    /// A workspace of the whole memory.
    pub(super) fn workspace(&mut self) -> Workspace<'_, T> {
        let numbers = [
            self.coordinates.as_flattened_mut(),
            self.rows.as_flattened_mut(),
            self.wide.as_flattened_mut().as_flattened_mut(),
            self.square.as_flattened_mut().as_flattened_mut(),
        ];
        Workspace::of(numbers, self.lists.as_flattened_mut())
    }
}

#[cfg(test)]
mod tests {
    use super::super::AssemblyError;
    use super::super::position::positions;
    use super::super::room::Room;
    use super::super::velocity::velocities;
    use crate::{Energy, Mechanism, Position, State, Structure, Terms};
    use nalgebra::SMatrix;

    /// Rows all of which say that the first coordinate is as large as the last one: where
    /// both are zero they are singular, and dependent everywhere.
    struct Crossing;

    impl<const N: usize, const R: usize> Mechanism<f64, N, R> for Crossing {
        fn structure(&self) -> &'static Structure {
            &Structure::PLAIN
        }

        fn terms(&self, state: &State<f64, N>, out: &mut Terms<f64, N, R>) {
            out.mass = SMatrix::identity();
            let (first, last) = (state.v[0], state.v[N - 1]);
            out.bias.fill(last * last - first * first);
        }

        fn position(&self, state: &State<f64, N>, out: &mut Position<f64, N, R>) {
            out.mass = SMatrix::identity();
            let (first, last) = (state.q[0], state.q[N - 1]);
            out.residual.fill((first * first - last * last) / 2.0);
            out.jacobian.fill(0.0);
            for k in 0..R {
                out.jacobian[(k, 0)] += first;
                out.jacobian[(k, N - 1)] -= last;
            }
        }

        fn energy(&self, _: &State<f64, N>) -> Energy<f64> {
            Energy::default()
        }
    }

    fn assembles<const N: usize, const R: usize>() {
        let mut state = State::<f64, N>::default();
        state.v[N - 1] = 0.3;
        state.v[0] = 1.0;
        let mut room = Room::<f64, N, R>::new();
        for routine in [positions::<f64>(), velocities()] {
            let result = room.assemble(routine, &Crossing, &mut state, &[false; N]);
            assert_eq!(result, Ok(()), "{N} {R}");
        }
        let off = (state.v[0].abs() - state.v[N - 1].abs()).abs();
        assert!(off < 1e-9, "{N} {R}: {}", state.v);
        if N > 1 {
            let mut held = [false; N];
            (held[0], state.v[N - 1]) = (true, 0.0);
            let refused = room.assemble(velocities(), &Crossing, &mut state, &held);
            let many = matches!(refused, Err(AssemblyError::ManyBranches { .. }));
            assert!(many, "{N} {R}: {refused:?}");
        }
    }

    #[test]
    fn there_is_room_for_any_number_of_coordinates_and_rows_in_singular_configurations() {
        assembles::<1, 1>();
        assembles::<1, 9>();
        assembles::<1, 30>();
        assembles::<2, 1>();
        assembles::<2, 3>();
        assembles::<3, 20>();
        assembles::<8, 8>();
        assembles::<9, 1>();
        assembles::<9, 9>();
        assembles::<30, 4>();
        assembles::<12, 30>();
    }
}
