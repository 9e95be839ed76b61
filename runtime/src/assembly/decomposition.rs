//! The constraint Jacobian decomposed for solutions of least change.
//!
//! In:  a Jacobian, the scales of its rows and columns.
//! Out: least-change solutions of `J x = y`, damped or truncated.
//!
//! Rows that are safely independent are solved by their products ([`RowProducts`]). The
//! others, with all that they share coordinates with, are decomposed by singular values.

use super::scales::Scales;
use crate::Real;
use crate::linalg::{Breakdown, RowProducts, Workspace, add_scaled, dot, orthogonalise};

/// `Ĵ = rows · J · columns`, of which some rows are `U Σ Vᵀ`.
#[derive(Debug)]
pub(super) struct Decomposition<'a, T> {
    /// The number of coordinates.
    n: usize,
    /// `σ_i v_i` of the unsafe rows, largest first; then the safe rows as they are.
    rows: &'a mut [T],
    /// The rows of `Ĵ` in this order: first the unsafe ones.
    order: &'a mut [usize],
    /// How many rows are not safe.
    n_unsafe: usize,
    /// `u_i`.
    left: &'a mut [T],
    /// `σ_i²`.
    squares: &'a mut [T],
    safe: RowProducts<'a, T>,
    /// The multipliers of the safe rows in a solution.
    multipliers: &'a mut [T],
    /// What is added to the squares of singular values.
    shift: T,
}

impl<'a, T: Real> Decomposition<'a, T> {
    /// The decomposition of a matrix of zeros. It takes a matrix of `n_rows` by `n`, two square
    /// ones of all rows, six vectors and three lists.
    pub(super) fn new(n: usize, n_rows: usize, workspace: &Workspace<'a, T>) -> Self {
        Self {
            n,
            rows: workspace.numbers(n * n_rows),
            order: workspace.indices(n_rows),
            n_unsafe: 0,
            left: workspace.numbers(n_rows * n_rows),
            squares: workspace.numbers(n_rows),
            safe: RowProducts::new(n_rows, workspace),
            multipliers: workspace.numbers(n_rows),
            shift: T::zero(),
        }
    }

    /// Decomposes a Jacobian in these scales.
    pub(super) fn decompose(
        &mut self,
        jacobian: &[T],
        scales: &Scales<'_, T>,
    ) -> Result<(), Breakdown> {
        let n_rows = self.order.len();
        self.decompose_scaled(&|k, j| scales.rows[k] * jacobian[j * n_rows + k] * scales.columns[j])
    }

    /// Decomposes a matrix with these entries, which is scaled already.
    pub(super) fn decompose_scaled(
        &mut self,
        entry: &dyn Fn(usize, usize) -> T,
    ) -> Result<(), Breakdown> {
        self.shift = T::zero();
        self.safe.compute(self.n, &mut |j, column| {
            for (k, target) in column.iter_mut().enumerate() {
                *target = entry(k, j);
            }
        })?;
        self.fill(entry);
        self.orthogonalise()
    }

    /// Lists the rows, those that are not safe first.
    fn fill(&mut self, entry: &dyn Fn(usize, usize) -> T) {
        let (n, n_rows) = (self.n, self.order.len());
        self.n_unsafe = 0;
        let mut place = 0;
        for safe in [false, true] {
            for row in (0..n_rows).filter(|row| self.safe.is_safe(*row) == safe) {
                self.order[place] = row;
                let target = &mut self.rows[place * n..(place + 1) * n];
                for (j, target) in target.iter_mut().enumerate() {
                    *target = entry(row, j);
                }
                place += 1;
                self.n_unsafe += usize::from(!safe);
            }
        }
    }

    /// Decomposes the rows that are not safe by singular values.
    fn orthogonalise(&mut self) -> Result<(), Breakdown> {
        let (count, n_rows) = (self.n_unsafe, self.order.len());
        self.left.fill(T::zero());
        for (i, row) in self.order[..count].iter().enumerate() {
            self.left[i * n_rows + row] = T::one();
        }
        let squares = &mut self.squares[..count];
        orthogonalise((self.rows, self.n), (self.left, n_rows), squares)
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
    /// above `cut` can; returns by how much `|y|²` falls to `|y − Ĵ x|²`.
    pub(super) fn solve(&mut self, y: &[T], cut: T, x: &mut [T]) -> T {
        x.fill(T::zero());
        let mut fall = T::zero();
        for i in 0..self.n_singular(cut) {
            let square = self.squares[i];
            let product = dot(self.left(i), y);
            let kept = self.shift / (square + self.shift);
            fall += product * product * (T::one() - kept * kept);
            add_scaled(x, product / (square + self.shift), self.row(i));
        }
        self.multipliers.copy_from_slice(y);
        self.safe.solve(self.multipliers);
        for i in self.n_unsafe..self.order.len() {
            let row = self.order[i];
            let z = self.multipliers[row];
            let left = self.shift * z;
            fall += y[row] * y[row] - left * left;
            add_scaled(x, z, self.row(i));
        }
        fall
    }

    /// Subtracts from `y` what the singular values above `cut` can produce.
    pub(super) fn leave_unreachable(&self, y: &mut [T], cut: T) {
        for row in &self.order[self.n_unsafe..] {
            y[*row] = T::zero();
        }
        for i in 0..self.n_singular(cut) {
            let share = dot(self.left(i), y);
            add_scaled(y, -share, self.left(i));
        }
    }

    /// Subtracts from `x` what changes `Ĵ x` by singular values above `cut`.
    pub(super) fn leave_ineffective(&mut self, x: &mut [T], cut: T) {
        for i in 0..self.n_singular(cut) {
            let share = dot(self.row(i), x) / self.squares[i];
            add_scaled(x, -share, self.row(i));
        }
        self.multipliers.fill(T::zero());
        for i in self.n_unsafe..self.order.len() {
            self.multipliers[self.order[i]] = dot(self.row(i), x);
        }
        self.safe.solve(self.multipliers);
        for i in self.n_unsafe..self.order.len() {
            add_scaled(x, -self.multipliers[self.order[i]], self.row(i));
        }
    }

    /// The largest singular value, or a little more.
    pub(super) fn largest(&self) -> T {
        let squares = self.squares[..self.n_unsafe].iter();
        let most = squares.fold(self.safe.largest_square(), |most, x| most.max(*x));
        most.sqrt()
    }

    /// How many singular values are above `cut`.
    pub(super) fn rank(&self, cut: T) -> usize {
        self.order.len() - self.n_unsafe + self.n_singular(cut)
    }

    /// Whether there may be a singular value between two bounds.
    pub(super) fn has_between(&self, low: T, high: T) -> bool {
        self.n_singular(low) > self.n_singular(high) || !self.safe.are_above(high)
    }

    /// How many of the singular values that were computed are above `cut`.
    fn n_singular(&self, cut: T) -> usize {
        let above = |i: &usize| self.squares[*i].sqrt() > cut;
        (0..self.n_unsafe).take_while(above).count()
    }

    /// A row of the decomposition.
    fn row(&self, i: usize) -> &[T] {
        &self.rows[i * self.n..(i + 1) * self.n]
    }

    /// `u_i`: the combination of rows, of length one, to which the singular value `σ_i` belongs.
    fn left(&self, i: usize) -> &[T] {
        let n_rows = self.order.len();
        &self.left[i * n_rows..(i + 1) * n_rows]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::norm;
    use nalgebra::SVector;

    const CUT: f64 = 1e-6;

    /// Room for the decompositions of a test.
    fn workspace() -> Workspace<'static, f64> {
        let numbers = vec![0.0; 100_000].leak();
        Workspace::new(numbers, &mut [], vec![0; 1_000].leak())
    }

    fn decomposed<const N: usize, const R: usize>(
        entry: impl Fn(usize, usize) -> f64,
    ) -> Decomposition<'static, f64> {
        let mut decomposition = Decomposition::new(N, R, &workspace());
        assert_eq!(decomposition.decompose_scaled(&entry), Ok(()));
        decomposition
    }

    impl Decomposition<'_, f64> {
        fn solution<const N: usize>(&mut self, y: &[f64]) -> (SVector<f64, N>, f64) {
            let mut x = SVector::<f64, N>::zeros();
            let fall = self.solve(y, CUT, x.as_mut_slice());
            (x, fall)
        }

        fn unreachable<const R: usize>(&self, mut y: SVector<f64, R>) -> SVector<f64, R> {
            self.leave_unreachable(y.as_mut_slice(), CUT);
            y
        }

        fn ineffective<const N: usize>(&mut self, mut x: SVector<f64, N>) -> SVector<f64, N> {
            self.leave_ineffective(x.as_mut_slice(), CUT);
            x
        }
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
        let mut decomposition = decomposed::<8, 6>(blocks);
        let y = SVector::from([0.3, -1.1, 0.4, 0.9, -0.2, 0.5]);
        let (x, fall) = decomposition.solution::<8>(y.as_slice());
        let left = error(blocks, &x, &y);
        // The halves of the difference of two rows that are the same.
        let unreachable = SVector::from([0.0, 0.0, 0.0, 0.2, 0.0, -0.2]);
        assert!((left - unreachable).amax() < 1e-12, "{left}");
        assert!((decomposition.unreachable(y) - unreachable).amax() < 1e-12);
        assert!((fall - (y.norm_squared() - left.norm_squared())).abs() < 1e-12);
        assert!(decomposition.ineffective(x).amax() < 1e-12, "{x}");
        let free = decomposition.ineffective(SVector::from([1.0; 8]));
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
        let (x, fall) = decomposition.solution::<8>(y.as_slice());
        let left = error(blocks, &x, &y);
        // Where half of |Jx − y|² + s|x|² is least, Jᵀ(y − Jx) = s x.
        for j in 0..8 {
            let slope: f64 = (0..6).map(|k| blocks(k, j) * left[k]).sum();
            assert!((slope - shift * x[j]).abs() < 1e-12, "{slope} {}", x[j]);
        }
        assert!((fall - (y.norm_squared() - left.norm_squared())).abs() < 1e-12);
        decomposition.damp(0.0);
        let undamped = decomposed::<8, 6>(blocks).solution::<8>(y.as_slice()).0;
        assert!((decomposition.solution(y.as_slice()).0 - undamped).amax() < 1e-15);
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
        let mut decomposition = decomposed::<101, 100>(entry);
        assert_eq!(decomposition.n_unsafe, 0);
        let y = SVector::<f64, 100>::from_fn(|k, _| (k as f64).sin());
        let (x, _) = decomposition.solution::<101>(y.as_slice());
        let [left] = error(entry, &x, &y).data.0;
        assert!(norm(&left) < 1e-12);
    }

    #[test]
    fn what_is_not_finite_is_no_matrix() {
        for bad in [f64::NAN, f64::INFINITY] {
            let mut decomposition = Decomposition::new(2, 2, &workspace());
            let entry = |k: usize, j: usize| if k == 1 && j == 1 { bad } else { 1.0 };
            assert_eq!(decomposition.decompose_scaled(&entry), Err(Breakdown));
        }
    }
}
