//! The memory in which sheets are evaluated, and ranks are decided.
//!
//! Out: a [`Workspace`] for a mechanism with `N` coordinates and `R` constraint equations.
//!
//! That of small mechanisms is part of their solver. Large ones, with the standard library,
//! take theirs from the heap, once, when it is first needed: pages that are never touched
//! cost nothing.

use crate::Real;
use crate::linalg::Workspace;

/// Square matrices of all coordinates that there is room for. A sheet takes two for its
/// frame, and others as the block of near-dependent rows is large: sixteen to interpolate,
/// and one for each look into a step, as long as there is room for more. The start of a motion
/// takes seven besides those that interpolate.
const MATRICES: usize = 32;
/// Vectors of all coordinates that there is room for, of which an interpolation takes 185:
/// with the standard library the matrices of small mechanisms among them.
const VECTORS: usize = 200
    + if cfg!(feature = "std") {
        SMALL * MATRICES
    } else {
        0
    };
/// Square matrices of all rows that there is room for where there are more rows than
/// coordinates, or many of both. A rank decision looks at two sets of decomposed rows, each a
/// matrix of all rows and one of rows and coordinates, which is the smaller one then.
const DECOMPOSED: usize = 3;
/// Lists of indices.
const LISTS: usize = 16;
/// Coordinates up to which a mechanism is small, and redundant rows.
const SMALL: usize = 8;

/// The matrices of large mechanisms.
#[cfg(feature = "std")]
type Matrices<T, const L: usize, const COUNT: usize> = Vec<T>;
#[cfg(not(feature = "std"))]
type Matrices<T, const L: usize, const COUNT: usize> = [[[T; L]; L]; COUNT];

/// Memory for a mechanism with `N` coordinates and `R` constraint equations.
#[derive(Debug)]
pub(crate) struct Memory<T, const N: usize, const R: usize> {
    vectors: [[T; N]; VECTORS],
    matrices: Matrices<T, N, MATRICES>,
    decomposed: Matrices<T, R, DECOMPOSED>,
    indices: [[usize; N]; LISTS],
}

/// The contents of the memory are of no use later: a copy begins without those on the heap.
impl<T: Clone, const N: usize, const R: usize> Clone for Memory<T, N, R> {
    fn clone(&self) -> Self {
        Self {
            vectors: self.vectors.clone(),
            #[cfg(feature = "std")]
            matrices: Vec::new(),
            #[cfg(feature = "std")]
            decomposed: Vec::new(),
            #[cfg(not(feature = "std"))]
            matrices: self.matrices.clone(),
            #[cfg(not(feature = "std"))]
            decomposed: self.decomposed.clone(),
            indices: self.indices,
        }
    }
}

impl<T: Real, const N: usize, const R: usize> Memory<T, N, R> {
    pub(crate) fn new() -> Self {
        Self {
            vectors: [[T::zero(); N]; VECTORS],
            #[cfg(feature = "std")]
            matrices: Vec::new(),
            #[cfg(feature = "std")]
            decomposed: Vec::new(),
            #[cfg(not(feature = "std"))]
            matrices: [[[T::zero(); N]; N]; MATRICES],
            #[cfg(not(feature = "std"))]
            decomposed: [[[T::zero(); R]; R]; DECOMPOSED],
            indices: [[0; N]; LISTS],
        }
    }

    /// A workspace of the whole memory.
    pub(crate) fn workspace(&mut self) -> Workspace<'_, T> {
        #[cfg(feature = "std")]
        if (N > SMALL || R > N + SMALL) && self.matrices.is_empty() {
            // The system hands out zeros without a page being touched.
            self.matrices = vec![T::zero(); MATRICES * N * N];
            self.decomposed = vec![T::zero(); DECOMPOSED * R * R];
        }
        #[cfg(feature = "std")]
        let (matrices, decomposed) = (&mut self.matrices, &mut self.decomposed);
        #[cfg(not(feature = "std"))]
        let (matrices, decomposed) = (
            self.matrices.as_flattened_mut().as_flattened_mut(),
            self.decomposed.as_flattened_mut().as_flattened_mut(),
        );
        let vectors = self.vectors.as_flattened_mut();
        Workspace::of(
            [vectors, matrices, decomposed, &mut []],
            self.indices.as_flattened_mut(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether there is room for what is taken at the same time: so many times each of some
    /// counts of numbers.
    fn check<const N: usize, const R: usize>() {
        let mut memory = Memory::<f64, N, R>::new();
        let decomposed = [(1, N * R), (1, R * R), (1, R)];
        let decision = [decomposed, decomposed, [(1, N * N + N), (6, N), (6, R)]];
        let start = [
            decomposed,
            [(7, N * N), (8, N), (1, R)],
            [(18, N * N), (185, N), (0, 0)],
        ];
        let sizes = [
            [(3, 8 * R), (1, N * R), (2, N * N)],
            [(9, R), (14, N), (0, 0)],
        ];
        let shares = [decomposed, [(4, N * R), (5, N), (0, 0)]];
        for taken in [
            shares.as_flattened(),
            decision.as_flattened(),
            start.as_flattened(),
            sizes.as_flattened(),
        ] {
            let workspace = memory.workspace();
            for (times, count) in taken {
                for _ in 0..*times {
                    assert_eq!(workspace.numbers(*count).len(), *count, "{N}, {R}");
                }
            }
        }
        let is_small = N <= SMALL && R <= N + SMALL;
        #[cfg(feature = "std")]
        assert_eq!(memory.matrices.is_empty(), is_small);
        #[cfg(not(feature = "std"))]
        let _ = is_small;
    }

    #[test]
    fn there_is_room_for_any_number_of_redundant_rows() {
        check::<1, 1>();
        check::<1, 9>();
        check::<1, 10>();
        check::<1, 40>();
        check::<2, 31>();
        check::<3, 4>();
        check::<4, 9>();
        check::<8, 16>();
        check::<8, 17>();
        check::<5, 60>();
        check::<9, 1>();
        check::<12, 30>();
        check::<20, 20>();
    }
}
