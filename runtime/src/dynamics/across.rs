//! Closing gaps across a branch: what projections do with a tangent space.
//!
//! In:  a [`Tangent`], gaps of the position, velocity or acceleration level.
//! Out: changes that close them, in the strong directions by the rows, in the weak
//!      ones by the rows or by the branch rows, never along the branch.

use super::Tangent;
use crate::Real;
use crate::linalg::{Breakdown, add_scaled, branch_rank, dot, norm, truncation};

impl<T: Real, const N: usize, const R: usize> Tangent<T, N, R> {
    /// Decides the weak directions anew, without turning them into the free ones:
    /// by the rows where these have singular values above `floor`, else by the
    /// branch rows. Without branch rows only round-off is a floor.
    pub(crate) fn refine(&mut self, floor: T) -> Result<(), Breakdown> {
        let end = self.used;
        let floor = if self.rate() > T::zero() {
            floor
        } else {
            floor.min(truncation())
        };
        let (rows, slopes) = (self.rows, self.slopes);
        self.used = self.strong;
        self.take(&rows, self.strong, end, floor, end)?;
        self.branch = self.used;
        self.take(&slopes, self.used, end, -T::one(), end)
    }

    /// The shortest change that closes `gap` in the strong directions.
    pub(crate) fn close_strong(&self, gap: &[T; R]) -> [T; N] {
        let mut w = [T::zero(); N];
        self.advance(&mut w, &self.rows, gap, 0..self.strong);
        w
    }

    /// Whether `far(σ, size)` holds for any weak direction and its part of `gap`.
    pub(crate) fn any_weak(&self, gap: &[T; R], far: impl Fn(T, T) -> bool) -> bool {
        (self.strong..self.branch)
            .any(|j| far(self.values[j], dot(&self.left.data.0[j], gap).abs()))
    }

    /// Adds to `w` what closes `gap` in the weak directions of the rows, where
    /// `worth(σ, size)` says that a gap of this size means something.
    pub(crate) fn close_rows(&self, w: &mut [T; N], gap: &[T; R], worth: impl Fn(T, T) -> bool) {
        let mut rest = *gap;
        for (entry, row) in rest.iter_mut().zip(&self.rows.data.0) {
            *entry -= dot(row, w);
        }
        for j in self.strong..self.branch {
            let size = dot(&self.left.data.0[j], &rest);
            if self.values[j] > truncation() && worth(self.values[j], size.abs()) {
                add_scaled(w, size / self.values[j], &self.basis.data.0[j]);
            }
        }
    }

    /// Adds to `w` what closes a gap one level higher in the weak directions of the
    /// branch rows, where it is above `noise`: `share · gap / K`.
    pub(crate) fn close_slopes(&self, w: &mut [T; N], gap: &[T; R], share: T, noise: T) {
        let floor = branch_rank::<T>() * self.rate();
        for j in self.branch..self.used {
            let size = dot(&self.left.data.0[j], gap);
            if self.values[j] > floor && size.abs() > noise {
                let change = share * size / self.values[j];
                add_scaled(w, change, &self.basis.data.0[j]);
            }
        }
    }

    /// How fast the weak rows change along the motion: the largest row of `K̂`
    /// (1/s), zero where no branch rows were needed.
    pub(crate) fn rate(&self) -> T {
        let sizes = self.slopes.data.0.iter().map(norm);
        sizes.fold(T::zero(), |most, x| most.max(x))
    }
}
