//! Across a singular configuration on regular states of the same sheet.
//!
//! In:  a state near a singular configuration, a chart.
//! Out: the state on its sheet and the sheet's geometry there, interpolated between
//!      regular states on both sides.
//!
//! Where a combination of constraints loses its gradient, two sheets of the constraint
//! set cross. Each of them is smooth; only the equations degenerate. So the sheet is
//! known to full accuracy at regular states of its own on both sides, along any
//! direction that leaves the singular set, whatever the velocity is. What belongs to the
//! sheet is interpolated: position, tangent space, the acceleration that curvature
//! demands. Masses and forces are taken at the state itself.

use super::direction::Direction;
use super::obstacle::Obstacle;
use super::product::ChartView;
use super::sheet::{PointView, Sheet};
use super::stored_nodes::NODES;
use crate::Real;
use crate::equations::At;
use crate::linalg::{Block, Eliminated, Workspace, add_scaled, column, dot};
use crate::tolerance::clearance;

/// How many earlier nodes predict the next.
const PREDICTORS: usize = 5;
/// Numbers of nodes that are summed up side by side.
const LANES: usize = 4;
/// The interpolations that are compared leave out this many pairs of nodes.
pub(super) const SETS: usize = 3;

/// What is interpolated: vectors one after the other, of one node or summed up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Geometry<'a, T> {
    /// From the state that is asked for to the sheet, along the chart's complement.
    pub(super) offset: &'a [T],
    pub(super) drift: &'a [T],
    pub(super) particular: &'a [T],
    pub(super) tangent: &'a [T],
}

impl<'a, T> Geometry<'a, T> {
    /// The geometry of `n` coordinates, out of vectors one after the other.
    fn of(vectors: &'a [T], n: usize) -> Self {
        let (offset, rest) = vectors.split_at(n);
        let (drift, rest) = rest.split_at(n);
        let (particular, tangent) = rest.split_at(n);
        Self {
            offset,
            drift,
            particular,
            tangent,
        }
    }
}

/// What was found between nodes of one spacing.
#[derive(Debug)]
pub(super) struct Interpolated<'a, T> {
    n: usize,
    /// Interpolations by all nodes, and by one and two pairs of nodes fewer.
    sums: &'a mut [T],
    /// What is known of the nodes, one after the other, and their places in units of the
    /// spacing.
    nodes: &'a mut [T],
    pub(super) places: [T; NODES],
    /// How the round-off of each node is magnified by what is solved there.
    pub(super) noises: [T; NODES],
    bend: Bend<'a, T>,
    /// By how much round-off is magnified.
    pub(super) noise: T,
    /// How the first entry of the block changes from one node to the next.
    pub(super) slope: T,
    /// The error relative to what is interpolated; the score counts round-off, too.
    pub(super) error: T,
    pub(super) score: T,
    pub(super) spacing: T,
}

/// How the sheet bends, as far as it is known: away from its tangent space with the square of
/// the distance from the accepted state, where the tangent space touches it.
#[derive(Debug)]
struct Bend<'a, T> {
    /// How far it has bent away at the state that is asked for.
    whole: &'a mut [T],
    /// By how much the distance from the accepted state changes from one place of the line to the
    /// next, relative to the distance of the state that is asked for.
    share: T,
}

impl<T: Real> Bend<'_, T> {
    /// How much more it has bent away at a place so far from the state that is asked for.
    fn at(&self, place: T) -> T {
        let distance = T::one() + self.share * place;
        distance * distance - T::one()
    }
}

impl<'a, T: Real> Interpolated<'a, T> {
    pub(super) fn new(chart: &ChartView<'_, T>, workspace: &Workspace<'a, T>) -> Self {
        let n = chart.n();
        Self {
            n,
            sums: workspace.any((3 + chart.freedoms) * n * SETS),
            nodes: workspace.any((3 + chart.freedoms) * n * NODES),
            places: [T::zero(); NODES],
            noises: [T::zero(); NODES],
            bend: Bend {
                whole: workspace.any(n),
                share: T::zero(),
            },
            noise: T::zero(),
            slope: T::zero(),
            error: T::zero(),
            score: T::zero(),
            spacing: T::zero(),
        }
    }

    /// The vectors of a node or a sum, one after the other.
    fn row(&self) -> usize {
        self.sums.len() / SETS
    }

    /// What is interpolated by a set of nodes.
    pub(super) fn sum(&self, set: usize) -> Geometry<'_, T> {
        Geometry::of(&self.sums[set * self.row()..][..self.row()], self.n)
    }

    /// What is known of a node.
    pub(super) fn node(&self, node: usize) -> Geometry<'_, T> {
        Geometry::of(&self.nodes[node * self.row()..][..self.row()], self.n)
    }

    /// The vectors of a node, to be filled: the offset, the drift, the particular acceleration,
    /// the tangents.
    pub(super) fn node_mut(&mut self, node: usize) -> &mut [T] {
        let row = self.row();
        &mut self.nodes[node * row..(node + 1) * row]
    }

    /// Sums up what is known of the nodes, with the weights of each set.
    pub(super) fn sum_up(&mut self, sets: &[[T; NODES]; SETS]) {
        let row = self.row();
        let whole = row - row % LANES;
        for first in (0..whole).step_by(LANES) {
            self.sum_up_some::<LANES>(first, sets);
        }
        for first in whole..row {
            self.sum_up_some::<1>(first, sets);
        }
    }

    /// Sums up so many of the numbers that are known of each node.
    #[inline]
    fn sum_up_some<const L: usize>(&mut self, first: usize, sets: &[[T; NODES]; SETS]) {
        let row = self.row();
        let mut sums = [[T::zero(); L]; SETS];
        for (node, numbers) in self.nodes.chunks_exact(row).enumerate().take(NODES) {
            let numbers = &numbers[first..first + L];
            for (sum, weights) in sums.iter_mut().zip(sets) {
                for (entry, number) in sum.iter_mut().zip(numbers) {
                    *entry = weights[node].mul_add(*number, *entry);
                }
            }
        }
        for (target, sum) in self.sums.chunks_exact_mut(row).zip(sums) {
            target[first..first + L].copy_from_slice(&sum);
        }
    }

    /// Adds the offset of the sheet at another place of the line.
    pub(super) fn add_offset_at(&self, place: T, target: &mut [T]) {
        let mut weights = [T::zero(); NODES];
        weigh(&self.places, |_| true, place, &mut weights);
        for (node, weight) in weights.iter().enumerate() {
            add_scaled(target, *weight, self.node(node).offset);
        }
    }

    /// Keeps what was found at a node.
    fn keep(&mut self, node: usize, moved: &[T], point: &PointView<'_, T>) {
        let (offset, rest) = self.node_mut(node).split_at_mut(moved.len());
        offset.copy_from_slice(point.q);
        add_scaled(offset, -T::one(), moved);
        let (drift, rest) = rest.split_at_mut(moved.len());
        drift.copy_from_slice(point.drift);
        let (particular, tangent) = rest.split_at_mut(moved.len());
        particular.copy_from_slice(point.particular);
        tangent.copy_from_slice(point.tangent);
        self.noises[node] = T::one() / (point.sine * point.sine);
    }

    /// Whether sheets cross between the nodes next to the singular configuration.
    fn judge(
        &mut self,
        [behind, ahead]: &[Block<'_, T>; 2],
        is_of_time: bool,
        workspace: &Workspace<'_, T>,
    ) -> Result<(), Obstacle> {
        let change = ahead.first() - behind.first();
        self.slope = change / (self.places[BEYOND] - self.places[0]);
        match ahead.sign_changes_from(behind, workspace) {
            // A law of time may lead to a singular configuration and back.
            0 if !is_of_time => Err(Obstacle::Touching),
            _ => Ok(()),
        }
    }

    /// Moves a position to where a node is expected, by extrapolation from the nodes before it and
    /// from the state itself, which is on the sheet but for the error of a step.
    fn predict(&self, node: usize, place: T, here: T, q: &mut [T]) {
        let first = node.saturating_sub(PREDICTORS - 1);
        let mut places = [here; PREDICTORS];
        let count = node - first;
        places[..count].copy_from_slice(&self.places[first..node]);
        // Next to a node, the state tells nothing new.
        let far = |other: &T| (*other - here).abs() > T::from_f64(0.3);
        let state = places[..count].iter().all(far);
        let known = |k: usize| k < count || k == count && state;
        let mut weights = [T::zero(); PREDICTORS];
        weigh(&places, known, place, &mut weights);
        let mut bent = self.bend.at(place - here);
        for (k, weight) in (first..node).zip(weights) {
            add_scaled(q, weight, self.node(k).offset);
            bent -= weight * self.bend.at(self.places[k] - here);
        }
        add_scaled(q, bent, self.bend.whole);
    }
}

/// The order in which nodes are found, for a state ahead of the singular configuration:
/// from the state outwards and across, so that earlier nodes predict the next.
pub(super) const ORDER: [f64; NODES] = [1.0, 2.0, 3.0, -1.0, 4.0, -2.0, 5.0, -3.0, -4.0, -5.0];
/// In this order, the node next to the singular configuration on its other side.
pub(super) const BEYOND: usize = 3;

/// Lagrange's weights, at a place, of those places that are wanted; the other weights are left
/// alone.
fn weigh<T: Real>(places: &[T], wanted: impl Fn(usize) -> bool, at: T, weights: &mut [T]) {
    for (i, own) in places.iter().enumerate().filter(|(i, _)| wanted(*i)) {
        let mut weight = T::one();
        for (j, place) in places.iter().enumerate() {
            if j != i && wanted(j) {
                weight *= (at - *place) / (*own - *place);
            }
        }
        weights[i] = weight;
    }
}

/// Nodes from the innermost to the outermost.
const OUTWARDS: [usize; NODES] = [0, 3, 1, 5, 2, 7, 4, 8, 6, 9];

/// The weights, at a place, of each of the interpolations that are compared: every node that
/// is added multiplies the weights of those before it.
pub(super) fn weights_of_sets<T: Real>(places: &[T; NODES], at: T) -> [[T; NODES]; SETS] {
    let mut sets = [[T::zero(); NODES]; SETS];
    let places: [T; NODES] = column(|k| places[OUTWARDS[k]]);
    let mut weights = [T::zero(); NODES];
    for count in 0..NODES {
        let mut own = T::one();
        for other in 0..count {
            // Where places are whole numbers, this is exact.
            let apart = places[count] - places[other];
            own *= (at - places[other]) / apart;
            weights[other] *= (places[count] - at) / apart;
        }
        weights[count] = own;
        let left_out = NODES - 1 - count;
        if left_out.is_multiple_of(2) && left_out < 2 * SETS {
            for (node, weight) in OUTWARDS.iter().zip(weights) {
                sets[left_out / 2][*node] = weight;
            }
        }
    }
    sets
}

impl<T: Real> Sheet<'_, T> {
    /// Finds the nodes along a direction and what they say of the sheet at the state.
    #[inline(never)]
    pub(super) fn interpolate(
        &mut self,
        state: At<'_, T>,
        direction: &Direction<'_, T>,
        like: &Eliminated<'_, T>,
        found: &mut Interpolated<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<(), Obstacle> {
        let step = found.spacing / direction.rate;
        let here = -direction.centre / step;
        let sign = if here < T::zero() {
            -T::one()
        } else {
            T::one()
        };
        found.places = column(|node| sign * T::from_f64(ORDER[node]));
        let sets = weights_of_sets(&found.places, here);
        self.bend(state, direction, step, &mut found.bend, workspace);
        let along = workspace.numbers(self.chart.freedoms);
        self.chart.coordinates(state.v, along);
        let size = like.block().size();
        let mut blocks = core::array::from_fn(|_| Block::with_capacity(size, workspace));
        let mut point = PointView::new(&self.chart, workspace);
        let moved = workspace.numbers(self.chart.n());
        for node in 0..NODES {
            let place: T = found.places[node];
            let distance = direction.centre + step * place;
            let t = direction.moved(state, distance, moved);
            point.set(At {
                t,
                q: moved,
                v: state.v,
            });
            found.predict(node, place, here, point.q);
            let shift = direction.shifted(distance);
            self.project_from(moved, (t, point.q), like, shift, workspace)?;
            // A comparison with NaN is false, so that a node with a pivot that is NaN is not clear.
            let clear = self.frame.smallest() >= clearance::<T>() * found.spacing;
            if !clear {
                return Err(Obstacle::Unresolved);
            }
            let block = self.frame.block();
            // Where sheets cross at a small angle, Newton's iteration may lead to the other one
            // without a sign of trouble. Beyond, signs that don't change tell.
            if node == 0 && !direction.leads_to(block, (like.block(), distance), workspace) {
                return Err(Obstacle::LeftSheet);
            }
            if ORDER[node].abs() == 1.0 {
                blocks[usize::from(node > 0)].set(block);
            }
            self.measure(Some(along), &mut point);
            found.keep(node, moved, &point);
        }
        found.sum_up(&sets);
        let noises = found.noises.iter().zip(&sets[0]);
        found.noise = noises.fold(T::zero(), |sum, (noise, weight)| {
            sum + weight.abs() * *noise
        });
        found.judge(&blocks, direction.is_of_time, workspace)
    }

    /// How the sheet bends along a line, in steps of this length.
    fn bend(
        &self,
        state: At<'_, T>,
        direction: &Direction<'_, T>,
        step: T,
        bend: &mut Bend<'_, T>,
        workspace: &Workspace<'_, T>,
    ) {
        let (along, change) = (
            workspace.numbers(self.chart.freedoms),
            workspace.numbers(self.chart.freedoms),
        );
        bend.whole.copy_from_slice(state.q);
        add_scaled(bend.whole, -T::one(), self.chart.q);
        add_scaled(bend.whole, self.chart.t - state.t, self.chart.drift);
        self.chart.coordinates(bend.whole, along);
        self.chart.coordinates(direction.q, change);
        bend.share = step * dot(along, change) / dot(along, along);
        for (along, column) in along.iter().zip(self.chart.tangents()) {
            add_scaled(bend.whole, -*along, column);
        }
        // False where the state is the accepted one: the share is then NaN, a quotient of zeros.
        let known = bend.share.abs() < T::one();
        if !known {
            bend.whole.fill(T::zero());
            bend.share = T::zero();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bricard_testkit::Random;

    #[test]
    fn each_set_of_weights_leaves_out_the_outermost_nodes_and_is_exact_for_polynomials() {
        let mut random = Random::seeded(0x0DE5);
        for round in 0..50 {
            let places = ORDER.map(|place| place + random.within(0.2));
            let at = random.within(2.5);
            for (k, weights) in weights_of_sets(&places, at).iter().enumerate() {
                let inside = |node: usize| ORDER[node].abs() <= (NODES / 2 - k) as f64;
                for (node, weight) in weights.iter().enumerate() {
                    assert_eq!(
                        *weight != 0.0,
                        inside(node),
                        "{round}: set {k}, node {node}"
                    );
                }
                for power in 0..(NODES - 2 * k) as i32 {
                    let terms = weights.iter().zip(places);
                    let sum: f64 = terms.map(|(w, x)| w * x.powi(power)).sum();
                    let error = (sum - at.powi(power)).abs() / 5.0_f64.powi(power);
                    assert!(error < 1e-12, "{round}: set {k}, power {power}: {error}");
                }
            }
        }
    }
}
