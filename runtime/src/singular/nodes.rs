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
use super::kept::{NODES, SIDE};
use super::obstacle::Obstacle;
use super::sheet::{Point, Sheet};
use crate::linalg::{Block, Frame, add_scaled, column, dot};
use crate::tolerance::clearance;
use crate::{Real, State};
use nalgebra::{SMatrix, SVector};

/// How many earlier nodes predict the next.
const PREDICTORS: usize = 5;
/// The interpolations that are compared leave out this many pairs of nodes.
pub(super) const SETS: usize = 3;

/// What is interpolated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sum<T, const N: usize> {
    /// From the state that is asked for to the sheet, along the chart's complement.
    pub(super) offset: SVector<T, N>,
    pub(super) tangent: SMatrix<T, N, N>,
    pub(super) drift: SVector<T, N>,
    pub(super) particular: SVector<T, N>,
}

impl<T: Real, const N: usize> Sum<T, N> {
    fn zeros() -> Self {
        Self {
            offset: SVector::zeros(),
            tangent: SMatrix::zeros(),
            drift: SVector::zeros(),
            particular: SVector::zeros(),
        }
    }

    pub(super) fn add(
        &mut self,
        weight: T,
        offset: &SVector<T, N>,
        point: &Point<T, N>,
        columns: usize,
    ) {
        let (particular, tangent) = (&mut self.particular, &mut self.tangent.data.0);
        add_scaled(self.offset.as_mut_slice(), weight, offset.as_slice());
        add_scaled(self.drift.as_mut_slice(), weight, point.drift.as_slice());
        add_scaled(
            particular.as_mut_slice(),
            weight,
            point.particular.as_slice(),
        );
        let tangents = tangent.iter_mut().zip(&point.tangent.data.0);
        for (sum, column) in tangents.take(columns) {
            add_scaled(sum, weight, column);
        }
    }
}

/// A sheet bends away from its tangent space with the square of the distance from the
/// accepted state, where the tangent space touches it.
#[derive(Clone, Debug)]
struct Bend<T, const N: usize> {
    /// How far it has bent away at the state that is asked for.
    whole: SVector<T, N>,
    /// The change of the distance from the accepted state, relative to what it is at the
    /// state that is asked for, from one place of the line to the next.
    share: T,
}

impl<T: Real, const N: usize> Bend<T, N> {
    /// The offset at a place so far from the state that is asked for.
    fn at(&self, place: T) -> SVector<T, N> {
        let distance = T::one() + self.share * place;
        self.whole * (distance * distance - T::one())
    }
}

/// What was found between nodes of one spacing.
#[derive(Clone, Debug)]
pub(super) struct Interpolated<T, const N: usize> {
    /// By all nodes, and by one and two pairs fewer.
    pub(super) sums: [Sum<T, N>; SETS],
    /// The offsets of the nodes, and their places in units of the spacing.
    pub(super) offsets: [SVector<T, N>; NODES],
    pub(super) places: [T; NODES],
    /// The tangents of the nodes, of the first coordinate of the chart, and the accelerations
    /// that the constraints demand there.
    pub(super) geometry: [[SVector<T, N>; 2]; NODES],
    /// How the round-off of each node is magnified by what is solved there.
    pub(super) noises: [T; NODES],
    /// How the sheet bends, as far as it is known.
    bend: Bend<T, N>,
    /// By how much round-off is magnified.
    pub(super) noise: T,
    /// How the first entry of the block changes from one node to the next.
    pub(super) slope: T,
}

impl<T: Real, const N: usize> Interpolated<T, N> {
    pub(super) fn new() -> Self {
        Self {
            sums: [Sum::zeros(); SETS],
            offsets: [SVector::zeros(); NODES],
            places: [T::zero(); NODES],
            geometry: [[SVector::zeros(); 2]; NODES],
            noises: [T::zero(); NODES],
            bend: Bend {
                whole: SVector::zeros(),
                share: T::zero(),
            },
            noise: T::zero(),
            slope: T::zero(),
        }
    }

    /// The offset of the sheet at another place of the line.
    pub(super) fn offset_at(&self, place: T) -> SVector<T, N> {
        let weights = weights(&self.places, &[true; NODES], place);
        let mut offset: SVector<T, N> = SVector::zeros();
        for (node, weight) in self.offsets.iter().zip(weights) {
            add_scaled(offset.as_mut_slice(), weight, node.as_slice());
        }
        offset
    }
}

/// The order in which nodes are found, for a state ahead of the singular configuration:
/// from the state outwards and across, so that those before predict the next.
pub(super) const ORDER: [f64; NODES] = [1.0, 2.0, 3.0, -1.0, 4.0, -2.0, 5.0, -3.0, -4.0, -5.0];
/// The one next to the singular configuration beyond it.
pub(super) const BEYOND: usize = 3;

/// Lagrange's weights, at a place, of the places that are wanted; the others are zero.
fn weights<T: Real, const K: usize>(places: &[T; K], wanted: &[bool; K], at: T) -> [T; K] {
    let mut weights = [T::zero(); K];
    weigh(places, wanted, at, &mut weights);
    weights
}

/// The same for any number of places.
#[inline(never)]
fn weigh<T: Real>(places: &[T], wanted: &[bool], at: T, weights: &mut [T]) {
    for (i, own) in places.iter().enumerate() {
        if !wanted[i] {
            continue;
        }
        let mut weight = T::one();
        for (j, (place, wanted)) in places.iter().zip(wanted).enumerate() {
            if *wanted && j != i {
                weight *= (at - *place) / (*own - *place);
            }
        }
        weights[i] = weight;
    }
}

/// The weights, at a place, of each of the interpolations that are compared.
pub(super) fn weights_of_sets<T: Real>(places: &[T; NODES], at: T) -> [[T; NODES]; SETS] {
    let mut sets = [[T::zero(); NODES]; SETS];
    for (k, set) in sets.iter_mut().enumerate() {
        let wanted = column(|node| ORDER[node].abs() <= (SIDE - k) as f64);
        *set = weights(places, &wanted, at);
    }
    sets
}

impl<T: Real, const N: usize, const R: usize> Sheet<'_, T, N, R> {
    /// Finds the nodes along a direction and what they say of the sheet at the state.
    #[inline(never)]
    pub(super) fn interpolate(
        &mut self,
        state: &State<T, N>,
        direction: &Direction<T, N>,
        spacing: T,
        like: &Frame<T, N, R>,
        found: &mut Interpolated<T, N>,
    ) -> Result<(), Obstacle> {
        let step = spacing / direction.rate;
        let here = -direction.centre / step;
        found.places = column(|node| match here < T::zero() {
            true => -T::from_f64(ORDER[node]),
            false => T::from_f64(ORDER[node]),
        });
        let sets = weights_of_sets(&found.places, here);
        found.sums = [Sum::zeros(); SETS];
        found.bend = self.bend(state, &direction.moved(&State::default(), step).q);
        found.noise = T::zero();
        let along = self.chart.coordinates(&state.v);
        let mut blocks: [Block<T, R>; 2] = [Block::zeros(0), Block::zeros(0)];
        let mut point = Point::zeros();
        for node in 0..NODES {
            let place: T = found.places[node];
            let moved = direction.moved(state, direction.centre + step * place);
            let guess = found.predict(node, place, here);
            point.state = State::new(moved.t, moved.q + guess, moved.v);
            self.project(&mut point.state, Some(like))?;
            let sine = self.frame.smallest();
            // False for NaN, too.
            let clear = sine >= clearance::<T>() * spacing;
            if !clear {
                return Err(Obstacle::Unresolved);
            }
            self.measure(Some(&along), &mut point);
            found.offsets[node] = point.state.q - moved.q;
            for (sum, weights) in found.sums.iter_mut().zip(&sets) {
                if weights[node] != T::zero() {
                    sum.add(
                        weights[node],
                        &found.offsets[node],
                        &point,
                        self.chart.freedoms,
                    );
                }
            }
            found.geometry[node] = [SVector::from(point.tangent.data.0[0]), point.particular];
            found.noises[node] = T::one() / (sine * sine);
            found.noise += sets[0][node].abs() * found.noises[node];
            if ORDER[node].abs() == 1.0 {
                blocks[usize::from(node > 0)] = self.frame.block().clone();
            }
        }
        found.judge(&blocks, direction.is_of_time)
    }
}

impl<T: Real, const N: usize, const R: usize> Sheet<'_, T, N, R> {
    /// How the sheet bends along steps of a line.
    #[inline(never)]
    fn bend(&self, state: &State<T, N>, step: &SVector<T, N>) -> Bend<T, N> {
        let base = &self.chart.base;
        let moved = state.q - base.q - self.chart.drift * (state.t - base.t);
        let along = self.chart.coordinates(&moved);
        let distance = dot(&along, &along);
        let share = dot(&along, &self.chart.coordinates(step)) / distance;
        let mut whole = moved;
        for (along, column) in along.iter().zip(&self.chart.tangent.data.0) {
            add_scaled(whole.as_mut_slice(), -*along, column);
        }
        // False for NaN, too: where the state is the accepted one.
        let known = share.abs() < T::one();
        match known {
            true => Bend { whole, share },
            false => Bend {
                whole: SVector::zeros(),
                share: T::zero(),
            },
        }
    }
}

impl<T: Real, const N: usize> Interpolated<T, N> {
    /// Whether sheets cross between the nodes next to the singular configuration.
    fn judge<const R: usize>(
        &mut self,
        [behind, ahead]: &[Block<T, R>; 2],
        is_of_time: bool,
    ) -> Result<(), Obstacle> {
        let change = ahead.entries[0][0] - behind.entries[0][0];
        self.slope = change / (self.places[BEYOND] - self.places[0]);
        match ahead.sign_changes_from(behind) {
            // A law of time may lead to a singular configuration and back.
            0 if !is_of_time => Err(Obstacle::Touching),
            _ => Ok(()),
        }
    }

    /// Where a node is to be looked for, by those before it and by the state itself, which
    /// is on the sheet but for the error of a step.
    #[inline(never)]
    fn predict(&self, node: usize, place: T, here: T) -> SVector<T, N> {
        let first = node.saturating_sub(PREDICTORS - 1);
        let mut places = [here; PREDICTORS];
        let count = node - first;
        places[..count].copy_from_slice(&self.places[first..node]);
        // A node next to the state says the same.
        let state = places[..count]
            .iter()
            .all(|other| (*other - here).abs() > T::from_f64(0.3));
        let known = column(|k| k < count || k == count && state);
        let weights = weights(&places, &known, place);
        let mut guess = self.bend.at(place - here);
        for (k, weight) in (first..node).zip(weights) {
            let rest = self.offsets[k] - self.bend.at(self.places[k] - here);
            add_scaled(guess.as_mut_slice(), weight, rest.as_slice());
        }
        guess
    }
}
