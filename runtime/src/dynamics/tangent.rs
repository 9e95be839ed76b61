//! The robust path: which directions the constraints leave free, at any position.
//!
//! In:  rows `Â` of the constraints in the metric and scaled to size one, and
//!      branch rows `K̂`, scaled likewise.
//! Out: what is decided in the metric space: by the solid rows, which are plainly
//!      independent ([`Solid`]); and by combinations of the others, with an orthonormal
//!      direction each: strong directions, which the rows decide; branch directions,
//!      which the rows differentiated once more decide where the rows themselves
//!      vanish; what the vanishing rows still decide. What is at right angles to all
//!      that is free, the tangent space of the motion.
//!
//! Rows that are redundant everywhere decide nothing in either and drop out. At
//! rest in a singular position there are no branch rows (they are linear in the
//! velocities), and the tangent space is the whole null space of `A`, as in
//! Phong & Hoang (2012).

use super::solid::Solid;
use super::{Metric, Rows, Which};
use crate::Real;
use crate::linalg::{add_scaled, dot, independent, independent_rows, norm, scaled};
use core::ops::Range;
use nalgebra::{SMatrix, SVector};

/// What was decided, and by what.
///
/// Of the decisions, `0..solid` are those of the solid rows. `solid..strong` are strong
/// directions, `strong..branch` branch directions, `branch..used` what else is decided:
/// each has a direction, a left vector and a singular value. The left vectors from
/// `used` to `end` complete an orthonormal basis of the combinations of other rows.
pub(crate) struct Tangent<T, const N: usize, const R: usize> {
    /// `Â` and `K̂`, a row in each column. What solid rows contribute to the others is
    /// subtracted from the latter, as it is from what left vectors combine.
    pub(super) rows: SMatrix<T, N, R>,
    pub(super) slopes: SMatrix<T, N, R>,
    pub(super) slope_bias: [T; R],
    pub(super) rate: T,
    pub(super) solid: Solid<T, R>,
    /// The rows that are not solid.
    pub(super) others: [usize; R],
    pub(super) directions: SMatrix<T, N, R>,
    pub(super) left: SMatrix<T, R, R>,
    pub(super) values: SVector<T, R>,
    pub(super) which: Which,
    pub(super) end: usize,
    pub(crate) strong: usize,
    /// How many of the decisions, the strong ones among them, the rows alone point to.
    pub(crate) aimed: usize,
    pub(crate) branch: usize,
    pub(crate) used: usize,
}

impl<T: Real, const N: usize, const R: usize> Default for Tangent<T, N, R> {
    fn default() -> Self {
        Self {
            rows: SMatrix::zeros(),
            slopes: SMatrix::zeros(),
            slope_bias: [T::zero(); R],
            rate: T::zero(),
            solid: Solid::default(),
            others: [0; R],
            directions: SMatrix::zeros(),
            left: SMatrix::zeros(),
            values: SVector::zeros(),
            which: Which::All,
            end: 0,
            strong: 0,
            aimed: 0,
            branch: 0,
            used: 0,
        }
    }
}

/// What left vectors combine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Level {
    /// `Â`.
    Rows,
    /// `K̂`.
    Slopes,
}

impl<T: Real, const N: usize, const R: usize> Tangent<T, N, R> {
    /// Lifts and scales the rows and takes those that are solid, at most `limit`.
    pub(crate) fn begin(
        &mut self,
        metric: &Metric<T, N>,
        rows: &mut Rows<T, R>,
        jacobian: &SMatrix<T, R, N>,
        which: Which,
        limit: usize,
    ) {
        self.lift_rows(metric, rows, jacobian, which);
        self.choose_solid(rows, limit);
        self.forget();
    }

    /// As at a state nearby: the same rows are solid, and the others are combined
    /// likewise at first.
    pub(crate) fn begin_like(
        &mut self,
        like: &Self,
        metric: &Metric<T, N>,
        rows: &mut Rows<T, R>,
        jacobian: &SMatrix<T, R, N>,
        limit: usize,
    ) {
        self.lift_rows(metric, rows, jacobian, like.which);
        if self.solid.take_again(&self.rows, like.solid.list()) {
            (self.others, self.end) = (like.others, like.end);
            self.left = like.left;
        } else {
            self.choose_solid(rows, limit);
        }
        self.forget();
    }

    /// The rows that take part, in the metric and scaled to size one.
    fn lift_rows(
        &mut self,
        metric: &Metric<T, N>,
        rows: &mut Rows<T, R>,
        jacobian: &SMatrix<T, R, N>,
        which: Which,
    ) {
        self.which = which;
        for row in 0..R {
            let mut vector = [T::zero(); N];
            if rows.takes_part(row, which) {
                vector = metric.lift(jacobian, row);
                rows.observe(row, dot(&vector, &vector));
                vector = scaled(rows.scale(row), &vector);
            }
            self.rows.data.0[row] = vector;
        }
    }

    /// Takes solid rows, and the others one by one for combinations of them.
    fn choose_solid(&mut self, rows: &Rows<T, R>, limit: usize) {
        let which = self.which;
        let known = || (0..R).filter(|&row| rows.takes_part(row, which));
        self.solid.choose(&self.rows, known(), limit);
        self.end = self.first();
        for row in known() {
            if !self.solid.list().contains(&row) {
                self.others[self.end] = row;
                let left = &mut self.left.data.0[self.end];
                *left = [T::zero(); R];
                left[row] = T::one();
                self.end += 1;
            }
        }
    }

    /// Forgets what was decided but by the solid rows.
    fn forget(&mut self) {
        let count = self.first();
        for k in 0..count {
            self.values[k] = self.solid.sine(k);
        }
        (self.strong, self.aimed) = (count, count);
        (self.branch, self.used) = (count, count);
        self.slopes.fill(T::zero());
        self.rate = T::zero();
    }

    /// How many decisions are those of solid rows.
    pub(super) fn first(&self) -> usize {
        self.solid.list().len()
    }

    /// Subtracts from a vector its part along all that is decided. Twice: the first
    /// time leaves round-off of what it takes away.
    pub(super) fn remove_decided(&self, x: &mut [T; N]) {
        for _ in 0..2 {
            self.solid.satisfy(&self.rows, x, &[T::zero(); R]);
            for direction in &self.directions.data.0[self.first()..self.used] {
                add_scaled(x, -dot(direction, x), direction);
            }
        }
    }

    pub(super) fn matrix(&self, level: Level) -> &SMatrix<T, N, R> {
        match level {
            Level::Rows => &self.rows,
            Level::Slopes => &self.slopes,
        }
    }

    /// The rows that are not solid.
    pub(super) fn others(&self) -> &[usize] {
        &self.others[self.first()..self.end]
    }

    /// The `w` nearest to `free` that satisfies what was decided: `Â w = right` in
    /// the strong directions, `K̂ w = κ̂` in the branch directions. The latter lacks
    /// `Â` times the jerk, see [`across`](Self::across).
    pub(crate) fn solve(&self, right: &[T; R], free: &[T; N]) -> [T; N] {
        let mut w = *free;
        self.remove_decided(&mut w);
        self.solid.satisfy(&self.rows, &mut w, right);
        self.advance(&mut w, Level::Rows, right, self.first()..self.strong);
        let bias = &self.slope_bias;
        self.advance(&mut w, Level::Slopes, bias, self.strong..self.branch);
        self.advance(&mut w, Level::Rows, right, self.branch..self.used);
        w
    }

    /// How a branch direction answers to the jerk: for the left vector returned
    /// first, the solution moves by minus the second, times the product of the left
    /// vector with `Â` times the jerk.
    pub(crate) fn across(&self, j: usize) -> ([T; R], [T; N]) {
        let mut w = scaled(T::one() / self.values[j], &self.directions.data.0[j]);
        let rest = self.branch..self.used;
        self.advance(&mut w, Level::Rows, &[T::zero(); R], rest);
        let mut left = self.left.data.0[j];
        let mut whole = [T::zero(); N];
        for &row in self.others() {
            add_scaled(&mut whole, left[row], &self.rows.data.0[row]);
        }
        let shares = self.solid.shares(&self.rows, &whole);
        for (share, &row) in shares.iter().zip(self.solid.list()) {
            left[row] = -*share;
        }
        (left, w)
    }

    /// Moves `w`, which satisfies the solid rows, along some decided directions until
    /// their rows are satisfied.
    fn advance(&self, w: &mut [T; N], level: Level, right: &[T; R], range: Range<usize>) {
        if range.is_empty() {
            return;
        }
        let gap = self.gap(level, right, w);
        for j in range {
            let share = dot(&self.left.data.0[j], &gap) / self.values[j];
            add_scaled(w, share, &self.directions.data.0[j]);
        }
    }

    /// What `w`, which satisfies the solid rows, leaves of the right-hand sides of the
    /// other rows; zero for the solid ones.
    pub(super) fn gap(&self, level: Level, right: &[T; R], w: &[T; N]) -> [T; R] {
        let mut gap = [T::zero(); R];
        for &row in self.others() {
            gap[row] = right[row] - dot(&self.matrix(level).data.0[row], w);
        }
        gap
    }

    /// The shortest change that closes `gap` in the solid rows.
    pub(super) fn close_solid(&self, gap: &[T; R]) -> [T; N] {
        let mut w = [T::zero(); N];
        self.solid.satisfy(&self.rows, &mut w, gap);
        w
    }

    /// The shortest change that closes `gap` in the strong directions.
    pub(crate) fn close_strong(&self, gap: &[T; R]) -> [T; N] {
        let mut w = self.close_solid(gap);
        self.advance(&mut w, Level::Rows, gap, self.first()..self.strong);
        w
    }

    /// How many directions are decided with singular values above `threshold`.
    pub(crate) fn rank(&self, threshold: T) -> usize {
        let above = |value: &&T| **value > threshold;
        self.values().iter().filter(above).count()
    }

    /// Whether rows that are not zero elsewhere vanish here, and the velocity does not
    /// say how they change.
    pub(crate) fn at_rest_with_vanished_rows(&self, rows: &Rows<T, R>) -> bool {
        let vanished = |row: usize| {
            rows.takes_part(row, self.which)
                && rows.scale(row) > T::zero()
                && norm(&self.rows.data.0[row]) < independent()
                && norm(&self.slopes.data.0[row]) < independent()
        };
        (0..R).any(vanished)
    }

    /// How fast the weak rows change along the motion: the largest row of `K̂`
    /// (1/s), zero where no branch rows were needed.
    pub(crate) fn rate(&self) -> T {
        self.rate
    }

    /// The scaled rows in the metric.
    pub(crate) fn rows(&self) -> &SMatrix<T, N, R> {
        &self.rows
    }

    /// Vectors that span the decided directions.
    pub(crate) fn decided(&self) -> impl Iterator<Item = &[T; N]> {
        let solid = self.solid.list().iter();
        let rest = &self.directions.data.0[self.first()..self.used];
        solid.map(|&row| &self.rows.data.0[row]).chain(rest)
    }

    /// An orthonormal basis of the free directions, in as many columns as come first.
    pub(crate) fn free(&self) -> (SMatrix<T, N, N>, usize) {
        let mut axes: SMatrix<T, N, N> = SMatrix::identity();
        for axis in &mut axes.data.0 {
            self.remove_decided(axis);
        }
        let mut chosen = [0; N];
        let count = N - self.used;
        let found = independent_rows(&mut axes, count, |_| false, T::zero(), &mut chosen);
        let mut free = SMatrix::zeros();
        for (k, &j) in chosen[..found].iter().enumerate() {
            let axis = &axes.data.0[j];
            free.data.0[k] = scaled(T::one() / norm(axis), axis);
        }
        (free, found)
    }

    /// Sines of the solid rows, then singular values of the decided directions, in
    /// falling order within each kind.
    pub(crate) fn values(&self) -> &[T] {
        &self.values.data.0[0][..self.used]
    }
}
