//! The constraint Jacobian decomposed for solutions of least change.
//!
//! In:  a Jacobian, the scales of its rows and columns.
//! Out: least-change solutions of `J x = y`, damped or truncated.
//!
//! Rows that are safely independent are solved by their products ([`Products`]). The
//! others, with all that they share coordinates with, are decomposed by singular values.

use super::scales::Scales;
use crate::Real;
use crate::linalg::{Breakdown, Products, add_scaled, dot, orthogonalise};
use nalgebra::{SMatrix, SVector};

/// `Ĵ = rows · J · columns`, of which some rows are `U Σ Vᵀ`.
#[derive(Clone, Debug)]
pub(super) struct Decomposition<T, const N: usize, const R: usize> {
    /// `σ_i v_i` of the unsafe rows, largest first; then the safe rows as they are.
    rows: SMatrix<T, N, R>,
    /// Which rows these are: first the unsafe ones.
    order: [usize; R],
    /// How many rows are not safe.
    n_unsafe: usize,
    /// `u_i`.
    left: SMatrix<T, R, R>,
    /// `σ_i²`.
    squares: SVector<T, R>,
    safe: Products<T, R>,
    /// What is added to the squares of singular values.
    shift: T,
}

impl<T: Real, const N: usize, const R: usize> Default for Decomposition<T, N, R> {
    fn default() -> Self {
        Self {
            rows: SMatrix::zeros(),
            order: [0; R],
            n_unsafe: 0,
            left: SMatrix::zeros(),
            squares: SVector::zeros(),
            safe: Products::default(),
            shift: T::zero(),
        }
    }
}

impl<T: Real, const N: usize, const R: usize> Decomposition<T, N, R> {
    /// Decomposes a Jacobian in these scales.
    ///
    /// In place, as everything here is: of a large mechanism it takes a good part of a
    /// stack.
    pub(super) fn decompose(
        &mut self,
        jacobian: &SMatrix<T, R, N>,
        scales: &Scales<T, N, R>,
    ) -> Result<(), Breakdown> {
        self.decompose_scaled(|k, j| scales.rows[k] * jacobian[(k, j)] * scales.columns[j])
    }

    /// Decomposes a matrix with these entries, which is scaled already.
    #[inline(never)]
    pub(super) fn decompose_scaled(
        &mut self,
        entry: impl Fn(usize, usize) -> T,
    ) -> Result<(), Breakdown> {
        self.shift = T::zero();
        self.safe.compute(N, |j, column| {
            for (k, target) in column.iter_mut().enumerate() {
                *target = entry(k, j);
            }
        })?;
        self.fill(entry);
        self.orthogonalise()
    }

    /// Lists the rows, those that are not safe first.
    fn fill(&mut self, entry: impl Fn(usize, usize) -> T) {
        (self.n_unsafe, self.squares) = (0, SVector::zeros());
        let mut place = 0;
        for safe in [false, true] {
            for row in (0..R).filter(|row| self.safe.is_safe(*row) == safe) {
                self.order[place] = row;
                let target = self.rows.data.0[place].iter_mut().enumerate();
                target.for_each(|(j, target)| *target = entry(row, j));
                place += 1;
                self.n_unsafe += usize::from(!safe);
            }
        }
    }

    /// Decomposes the rows that are not safe by singular values.
    fn orthogonalise(&mut self) -> Result<(), Breakdown> {
        let n = self.n_unsafe;
        for (column, row) in self.left.data.0.iter_mut().zip(&self.order[..n]) {
            *column = [T::zero(); R];
            column[*row] = T::one();
        }
        let rows = &mut self.rows.data.0[..n];
        orthogonalise(rows, &mut self.left.data.0[..n])?;
        for (square, row) in self.squares.iter_mut().zip(rows) {
            *square = dot(row, row);
        }
        Ok(())
    }

    /// Damps solutions, relative to the square of the largest singular value.
    pub(super) fn damp(&mut self, damping: T) {
        let largest = self.largest();
        let shift = damping * largest * largest;
        if shift != self.shift {
            self.shift = shift;
            self.safe.factorise(shift);
        }
    }

    /// The unknowns `x` of least norm that solve `Ĵ x = y` as well as the singular values
    /// above `cut` can; and by how much `|y|²` falls to `|y − Ĵ x|²`.
    pub(super) fn solve(&self, y: &SVector<T, R>, cut: T) -> (SVector<T, N>, T) {
        let mut x = [T::zero(); N];
        let mut fall = T::zero();
        for i in 0..self.n_singular(cut) {
            let square = self.squares[i];
            let product = dot(&self.left.data.0[i], &y.data.0[0]);
            let kept = self.shift / (square + self.shift);
            fall += product * product * (T::one() - kept * kept);
            add_scaled(
                &mut x,
                product / (square + self.shift),
                &self.rows.data.0[i],
            );
        }
        let z = self.safe.solve(y);
        for (row, vector) in self.safe_rows() {
            let left = self.shift * z[row];
            fall += y[row] * y[row] - left * left;
            add_scaled(&mut x, z[row], vector);
        }
        (SVector::from(x), fall)
    }

    /// `y` without what the singular values above `cut` can produce.
    pub(super) fn unreachable(&self, y: &SVector<T, R>, cut: T) -> SVector<T, R> {
        let mut rest = *y;
        for (row, _) in self.safe_rows() {
            rest[row] = T::zero();
        }
        let [entries] = &mut rest.data.0;
        for left in &self.left.data.0[..self.n_singular(cut)] {
            let share = dot(left, entries);
            add_scaled(entries, -share, left);
        }
        rest
    }

    /// `x` without what changes `Ĵ x` by singular values above `cut`.
    pub(super) fn ineffective(&self, x: &SVector<T, N>, cut: T) -> SVector<T, N> {
        let [mut rest] = x.data.0;
        for i in 0..self.n_singular(cut) {
            let row = &self.rows.data.0[i];
            let share = dot(row, &rest) / self.squares[i];
            add_scaled(&mut rest, -share, row);
        }
        let mut y = SVector::zeros();
        for (row, vector) in self.safe_rows() {
            y[row] = dot(vector, &rest);
        }
        let z = self.safe.solve(&y);
        for (row, vector) in self.safe_rows() {
            add_scaled(&mut rest, -z[row], vector);
        }
        SVector::from(rest)
    }

    /// The largest singular value, or a little more.
    pub(super) fn largest(&self) -> T {
        let squares = self.squares.iter();
        let most = squares.fold(self.safe.largest_square(), |most, x| most.max(*x));
        most.sqrt()
    }

    /// How many singular values are above `cut`.
    pub(super) fn rank(&self, cut: T) -> usize {
        R - self.n_unsafe + self.n_singular(cut)
    }

    /// How many of the singular values that were computed are above `cut`.
    fn n_singular(&self, cut: T) -> usize {
        let above = |i: &usize| self.squares[*i].sqrt() > cut;
        (0..self.n_unsafe).take_while(above).count()
    }

    /// The safe rows, with what they are in the scales.
    fn safe_rows(&self) -> impl Iterator<Item = (usize, &[T; N])> {
        let rows = self.order.iter().copied().zip(&self.rows.data.0);
        rows.skip(self.n_unsafe)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::norm;

    const CUT: f64 = 1e-6;

    fn decomposed<const N: usize, const R: usize>(
        entry: impl Fn(usize, usize) -> f64,
    ) -> Decomposition<f64, N, R> {
        let mut decomposition = Decomposition::default();
        assert_eq!(decomposition.decompose_scaled(entry), Ok(()));
        decomposition
    }

    /// Rows of two blocks, one of which has an entry of each coordinate twice.
    fn blocks(row: usize, column: usize) -> f64 {
        match (row, column) {
            (0..3, 0..4) => 0.7 + ((5 * row + 3 * column + row * column) % 7) as f64 / 7.0,
            (3 | 5, 4..7) => 1.0 / (column as f64 - 2.0),
            (4, 5) => 1.0,
            _ => 0.0,
        }
    }

    fn error<const N: usize, const R: usize>(
        entry: impl Fn(usize, usize) -> f64,
        x: &SVector<f64, N>,
        y: &SVector<f64, R>,
    ) -> SVector<f64, R> {
        SVector::from_fn(|k, _| y[k] - (0..N).map(|j| entry(k, j) * x[j]).sum::<f64>())
    }

    #[test]
    fn singular_values_are_of_what_is_connected_with_dependent_rows_and_of_nothing_else() {
        let decomposition = decomposed::<8, 6>(blocks);
        assert_eq!(&decomposition.order[..3], &[3, 4, 5]);
        assert_eq!(decomposition.n_unsafe, 3);
        assert_eq!(decomposition.rank(CUT), 5);
    }

    #[test]
    fn solutions_are_of_least_norm_and_leave_what_no_solution_reaches() {
        let decomposition = decomposed::<8, 6>(blocks);
        let y = SVector::from([0.3, -1.1, 0.4, 0.9, -0.2, 0.5]);
        let (x, fall) = decomposition.solve(&y, CUT);
        let left = error(blocks, &x, &y);
        // The halves of the difference of two rows that are the same.
        let unreachable = SVector::from([0.0, 0.0, 0.0, 0.2, 0.0, -0.2]);
        assert!((left - unreachable).amax() < 1e-12, "{left}");
        assert!((decomposition.unreachable(&y, CUT) - unreachable).amax() < 1e-12);
        assert!((fall - (y.norm_squared() - left.norm_squared())).abs() < 1e-12);
        assert!(decomposition.ineffective(&x, CUT).amax() < 1e-12, "{x}");
        let free = decomposition.ineffective(&SVector::from([1.0; 8]), CUT);
        assert!(
            free.amax() > 0.1 && error::<8, 6>(blocks, &free, &SVector::zeros()).amax() < 1e-12
        );
    }

    #[test]
    fn damped_solutions_balance_the_error_and_the_change() {
        let mut decomposition = decomposed::<8, 6>(blocks);
        let y = SVector::from([0.3, -1.1, 0.4, 0.9, -0.2, 0.5]);
        decomposition.damp(0.01);
        let shift = 0.01 * decomposition.largest().powi(2);
        let (x, fall) = decomposition.solve(&y, CUT);
        let left = error(blocks, &x, &y);
        // Where half of |Jx − y|² + s|x|² is least, Jᵀ(y − Jx) = s x.
        for j in 0..8 {
            let slope: f64 = (0..6).map(|k| blocks(k, j) * left[k]).sum();
            assert!((slope - shift * x[j]).abs() < 1e-12, "{slope} {}", x[j]);
        }
        assert!((fall - (y.norm_squared() - left.norm_squared())).abs() < 1e-12);
        decomposition.damp(0.0);
        let undamped = decomposed::<8, 6>(blocks).solve(&y, CUT).0;
        assert!((decomposition.solve(&y, CUT).0 - undamped).amax() < 1e-15);
    }

    #[test]
    fn rows_that_come_near_dependence_little_by_little_are_not_safe() {
        // Each has an angle of more than 25° to those before it; the smallest singular
        // value is below 1e-9.
        let entry = |k: usize, j: usize| match k as i32 - j as i32 {
            0 => 1.0,
            1 => -2.0,
            _ => 0.0,
        };
        let decomposition = decomposed::<30, 30>(entry);
        assert_eq!(decomposition.n_unsafe, 30);
        assert_eq!(decomposition.rank(CUT), 29);
    }

    #[test]
    fn rows_of_a_long_chain_are_solved_without_singular_values() {
        let entry = |k: usize, j: usize| match j as i32 - k as i32 {
            0 => 0.6,
            1 => -0.8,
            _ => 0.0,
        };
        let decomposition = decomposed::<101, 100>(entry);
        assert_eq!(decomposition.n_unsafe, 0);
        let y = SVector::from_fn(|k, _| (k as f64).sin());
        let (x, _) = decomposition.solve(&y, CUT);
        let [left] = error(entry, &x, &y).data.0;
        assert!(norm(&left) < 1e-12);
    }

    #[test]
    fn what_is_not_finite_is_no_matrix() {
        for bad in [f64::NAN, f64::INFINITY] {
            let mut decomposition = Decomposition::<f64, 2, 2>::default();
            let entry = |k: usize, j: usize| if k == 1 && j == 1 { bad } else { 1.0 };
            assert_eq!(decomposition.decompose_scaled(entry), Err(Breakdown));
        }
    }
}
