//! Fixed-size factorisations that know about rank.
//!
//! In:  nalgebra matrices of const sizes, over any [`Real`].
//! Out: Cholesky and pivot ratios, orthogonal bases by one-sided Jacobi
//!      rotations, least squares row by row, elimination with complete pivoting.
//!      Nothing allocates, panics or runs without a bound; what is not finite is
//!      reported.
//!
//! Code outside of the evaluations works on slices inside, so that it exists once in a crate.
//!
//! Not here: mechanics, and tolerances ([`crate::tolerance`]). No routine knows what its
//! matrix stands for.

mod block;
mod cholesky;
mod column;
mod column_ordering;
mod complement;
mod completion;
mod elimination;
mod fixed_frame;
mod frame;
mod gram;
mod jacobi;
mod near_dependent;
mod products;
pub(crate) mod small;
mod subset;
mod subspace_solution;
mod substitution;
mod sylvester;
mod symmetric;
#[cfg(test)]
mod tests;
mod triangle;
mod workspace;

pub(crate) use block::{Block, largest_of};
pub(crate) use cholesky::{
    Cholesky, NotDefinite, diagonal, is_definite, length, lift_row, lift_rows, multiply_upper,
    multiply_upper_transposed, set_units, solve_upper, solve_upper_transposed,
};
pub(crate) use column::{
    add_product, add_scaled, column, count_above, dot, is_finite, is_zero, largest, norm, pair,
    scale, scaled, sign_of,
};
pub(crate) use column_ordering::order_by_first_row;
pub(crate) use complement::{orthonormal, orthonormalise, remove};
pub(crate) use elimination::Elimination;
pub(crate) use frame::{Eliminated, Frame, Matrix};
pub(crate) use gram::Gram;
pub(crate) use jacobi::{Breakdown, orthogonalise};
pub(crate) use products::RowProducts;
pub(crate) use subset::independent_columns;
pub(crate) use subspace_solution::{add_subspace_solution, solve_in_subspace};
pub(crate) use substitution::Right;
pub(crate) use symmetric::diagonalise;
pub(crate) use triangle::Triangle;
pub(crate) use workspace::Workspace;
