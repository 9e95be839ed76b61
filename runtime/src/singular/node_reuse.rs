//! Reuse of nodes.
//!
//! In:  the nodes between which one state of a passage was interpolated.
//! Out: the sheet at the other states of the passage, between the same nodes.
//!
//! With one degree of freedom and constraints that do not depend on time the sheet is a
//! curve that stays where it is. A node is a point of it, whichever state it was found
//! for, so it is right for all stages of a step and for the steps after it. In another chart only
//! the conditions on its tangent and its acceleration change: `D* D̃ = 1`, and `D* aₚ = 0`.

use super::direction::Direction;
use super::nodes::{BEYOND, Interpolated, weights_of_sets};
use super::sheet::Sheet;
use super::stored_nodes::{NODES, SIDE};
use crate::Real;
use crate::equations::At;
use crate::linalg::small::with_size;
use crate::linalg::{Workspace, add_scaled, dot};
use crate::tolerance::hull;

impl<T: Real> Sheet<'_, T> {
    /// The first coordinate of a vector in the chart.
    fn along(&self, x: &[T]) -> T {
        dot(&self.chart.dual[..x.len()], x)
    }

    /// The first coordinate, in the chart, of the displacement from one position to another.
    fn ahead(&self, from: &[T], to: &[T]) -> T {
        let n = to.len();
        let (dual, from) = (&self.chart.dual[..n], &from[..n]);
        (0..n).fold(T::zero(), |sum, i| sum + dual[i] * (to[i] - from[i]))
    }

    /// Keeps the nodes between which a state was interpolated.
    pub(super) fn store_nodes(
        &mut self,
        state: At<'_, T>,
        direction: &Direction<'_, T>,
        best: &Interpolated<'_, T>,
    ) {
        self.nodes.quality.known = false;
        self.nodes.quality.spacing = best.spacing;
        self.nodes.quality.score = best.score;
        // Only a curve has the one coordinate that nodes are kept by.
        if !self.kind.is_curve {
            return;
        }
        let speed = self.along(state.v);
        let square = speed * speed;
        // A comparison with NaN is false, so that no nodes are kept where the speed is NaN.
        let moves = square > T::zero();
        if !moves {
            return;
        }
        let n = self.chart.n();
        let step = best.spacing / direction.rate;
        for (node, point) in self.nodes.points.chunks_exact_mut(3 * n).enumerate() {
            let (position, rest) = point.split_at_mut(n);
            let (tangent, demanded) = rest.split_at_mut(n);
            let place = direction.centre + step * best.places[node];
            direction.moved(state, place, position);
            let known = best.node(node);
            add_scaled(position, T::one(), known.offset);
            tangent.copy_from_slice(known.tangent);
            for (target, entry) in demanded.iter_mut().zip(known.particular) {
                *target = *entry / square;
            }
        }
        let quality = &mut *self.nodes.quality;
        quality.noise = best.noises;
        quality.rate = direction.rate;
        self.nodes.set_known();
    }

    /// Interpolates between the nodes that are kept, if the state is well between them, and they
    /// resolve the sheet there as well as where they were found.
    #[inline(never)]
    pub(super) fn reuse_nodes<'b>(
        &self,
        state: At<'_, T>,
        workspace: &Workspace<'b, T>,
    ) -> Option<Interpolated<'b, T>> {
        let quality = &*self.nodes.quality;
        if !quality.known || !self.kind.is_curve {
            return None;
        }
        let n = self.chart.n();
        let mut places = [T::zero(); NODES];
        for (place, point) in places.iter_mut().zip(self.nodes.points.chunks_exact(3 * n)) {
            *place = self.ahead(state.q, &point[..n]);
        }
        let half = T::from_f64(0.5);
        let (ahead, behind) = (places[0], places[BEYOND]);
        let centre = (ahead + behind) * half;
        // A comparison with NaN is false, so that a centre that is NaN is not inside.
        let inside = centre.abs() <= hull::<T>(SIDE) * ((ahead - behind) * half).abs();
        if !inside {
            return None;
        }
        let sets = weights_of_sets(&places, T::zero());
        let speed = self.along(state.v);
        let mut found = Interpolated::new(&self.chart, workspace);
        let chart = [self.chart.tangent, self.chart.dual];
        for (node, kept) in self.nodes.points.chunks_exact(3 * n).enumerate() {
            let from = (state.q, places[node], speed);
            let known = found.node_mut(node);
            with_size!(
                n,
                |N| bring(N, kept, from, chart, known),
                bring(n, kept, from, chart, known)
            );
            found.noise += sets[0][node].abs() * quality.noise[node];
        }
        found.sum_up(&sets);
        // At another passage, the curve may lead by elsewhere at the same distance along this
        // tangent.
        let off = self.chart.length(found.sum(0).offset);
        let is_here = off <= ((ahead - behind) * half).abs();
        if !is_here {
            return None;
        }
        found.spacing = quality.spacing;
        self.judge(state, quality.rate, &mut found);
        let as_before = found.score <= quality.score;
        (as_before || self.serves(&found)).then_some(found)
    }
}

/// Brings what is kept of a node to a state from which it is so far along a chart's tangent,
/// and to the speed along it: the offset, the drift, the particular acceleration, the tangent.
#[inline(always)]
fn bring<T: Real>(
    n: usize,
    kept: &[T],
    (here, place, speed): (&[T], T, T),
    [chart, dual]: [&[T]; 2],
    known: &mut [T],
) {
    let (here, chart, dual) = (&here[..n], &chart[..n], &dual[..n]);
    let kept = &kept[..3 * n];
    let known = &mut known[..4 * n];
    let (mut length, mut turned) = (T::zero(), T::zero());
    for i in 0..n {
        length += dual[i] * kept[n + i];
        turned += dual[i] * kept[2 * n + i];
    }
    let (share, turned) = (speed / length, turned / length);
    let square = share * share;
    for i in 0..n {
        let (tangent, demanded) = (kept[n + i], kept[2 * n + i]);
        known[i] = kept[i] - here[i] - place * chart[i];
        known[n + i] = T::zero();
        known[2 * n + i] = (demanded - tangent * turned) * square;
        known[3 * n + i] = tangent / length;
    }
}
