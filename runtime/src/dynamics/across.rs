//! Closing gaps across a branch: what projections do with a tangent space.
//!
//! In:  a [`Tangent`], gaps of the position, velocity or acceleration level.
//! Out: changes that close them, in the strong directions by the rows, in the weak
//!      ones by the rows or by the branch rows, never along the branch.

use super::Tangent;
use super::tangent::Level;
use crate::Real;
use crate::linalg::{Breakdown, add_scaled, branch_rank, dot, truncation};

impl<T: Real, const N: usize, const R: usize> Tangent<T, N, R> {
    /// Decides the weak directions anew, without turning them into the free ones:
    /// by the rows where these have singular values above `floor`, else by the
    /// branch rows. Without branch rows only round-off is a floor.
    #[inline(never)]
    pub(crate) fn refine(&mut self, floor: T) -> Result<(), Breakdown> {
        let end = self.used;
        let floor = if self.rate() > T::zero() {
            floor
        } else {
            floor.min(truncation())
        };
        let directions = self.directions;
        let weak = Some(&directions.data.0[self.strong..end]);
        self.used = self.strong;
        self.take(Level::Rows, weak, floor, end)?;
        self.branch = self.used;
        self.take(Level::Slopes, weak, -T::one(), end)
    }

    /// Whether `far(σ, size)` holds for any weak direction and its part of `gap`.
    pub(crate) fn any_weak(&self, gap: &[T; R], far: impl Fn(T, T) -> bool) -> bool {
        let gap = self.part_of_others(gap);
        (self.strong..self.branch)
            .any(|j| far(self.values[j], dot(&self.left.data.0[j], &gap).abs()))
    }

    /// Adds to `w` what closes `gap` in the weak directions of the rows, where
    /// `worth(σ, size)` says that a gap of this size means something.
    pub(crate) fn close_rows(&self, w: &mut [T; N], gap: &[T; R], worth: impl Fn(T, T) -> bool) {
        let rest = self.gap(Level::Rows, gap, w);
        for j in self.strong..self.branch {
            let size = dot(&self.left.data.0[j], &rest);
            if self.values[j] > truncation() && worth(self.values[j], size.abs()) {
                add_scaled(w, size / self.values[j], &self.directions.data.0[j]);
            }
        }
    }

    /// Adds to `w` what closes a gap one level higher in the weak directions of the
    /// branch rows, where it is above `noise`: `share · gap / K`.
    pub(crate) fn close_slopes(&self, w: &mut [T; N], gap: &[T; R], share: T, noise: T) {
        let floor = branch_rank::<T>() * self.rate();
        let gap = self.part_of_others(gap);
        for j in self.branch..self.used {
            let size = dot(&self.left.data.0[j], &gap);
            if self.values[j] > floor && size.abs() > noise {
                let change = share * size / self.values[j];
                add_scaled(w, change, &self.directions.data.0[j]);
            }
        }
    }

    /// What a gap has to do with the other rows, once the solid ones are closed.
    fn part_of_others(&self, gap: &[T; R]) -> [T; R] {
        self.gap(Level::Rows, gap, &self.close_solid(gap))
    }
}
