//! Nodes that serve again.
//!
//! In:  the nodes between which one state of a passage was interpolated.
//! Out: the sheet at the other states of the passage, between the same nodes.
//!
//! With one degree of freedom and constraints that do not depend on time the sheet is a
//! curve that stays where it is. A node is a point of it, whichever state it was found
//! for, so it is right for all stages of a step and for the steps after it. In another
//! chart only what its tangent and its acceleration are measured by changes:
//! `D* D̃ = 1`, and `D* aₚ = 0`.

use super::direction::Direction;
use super::kept::SIDE;
use super::nodes::{BEYOND, Interpolated, weights_of_sets};
use super::place::Best;
use super::sheet::{Point, Sheet};
use crate::linalg::column;
use crate::tolerance::{hull, resolved};
use crate::{Real, State};
use nalgebra::SVector;

impl<T: Real, const N: usize, const R: usize> Sheet<'_, T, N, R> {
    /// Whether the sheet is a curve that stays where it is.
    fn is_curve(&self) -> bool {
        self.chart.freedoms == 1 && self.mechanism.structure().scleronomic
    }

    /// The first coordinate in the chart.
    fn along(&self, x: &SVector<T, N>) -> T {
        self.chart.dual.column(0).dot(x)
    }

    /// Keeps the nodes between which a state was interpolated.
    #[inline(never)]
    pub(super) fn remember(
        &mut self,
        state: &State<T, N>,
        direction: &Direction<T, N>,
        best: &Best<T, N>,
    ) {
        self.nodes.known = false;
        let speed = self.along(&state.v);
        let square = speed * speed;
        // False for NaN, too.
        let moves = square > T::zero();
        if !self.is_curve() || !moves {
            return;
        }
        let step = best.spacing / direction.rate;
        for (node, point) in self.nodes.points.iter_mut().enumerate() {
            let place = direction.centre + step * best.found.places[node];
            let position = direction.moved(state, place).q + best.found.offsets[node];
            let [tangent, demanded] = best.found.geometry[node];
            *point = [position, tangent, demanded / square];
        }
        self.nodes.noise = best.found.noises;
        self.nodes.spacing = best.spacing;
        self.nodes.rate = direction.rate;
        self.nodes.score = best.score;
        self.nodes.known = true;
    }

    /// Interpolates between the nodes that are kept, if the state is well between them and
    /// they resolve the sheet there as well as where they were found.
    #[inline(never)]
    pub(super) fn recall(&self, state: &State<T, N>) -> Option<Best<T, N>> {
        if !self.nodes.known || !self.is_curve() {
            return None;
        }
        let nodes = &*self.nodes;
        let mut found = Interpolated::new();
        let chart = SVector::from(self.chart.tangent.data.0[0]);
        let places = column(|node| self.along(&(nodes.points[node][0] - state.q)));
        let half = T::from_f64(0.5);
        let (ahead, behind) = (places[0], places[BEYOND]);
        let mut direction = self.along_chart();
        direction.centre = (ahead + behind) * half;
        direction.rate = nodes.rate;
        // False for NaN, too.
        let inside = direction.centre.abs() <= hull::<T>(SIDE) * ((ahead - behind) * half).abs();
        if !inside {
            return None;
        }
        let sets = weights_of_sets(&places, T::zero());
        let speed = self.along(&state.v);
        let mut point = Point::zeros();
        for (node, [q, tangent, demanded]) in nodes.points.iter().enumerate() {
            let length = self.along(tangent);
            let tangent: SVector<T, N> = tangent / length;
            let share: T = speed / length;
            point.tangent.data.0[0] = tangent.data.0[0];
            point.particular = (demanded - tangent * self.along(demanded)) * (share * share);
            let offset = q - (state.q + chart * places[node]);
            for (sum, weights) in found.sums.iter_mut().zip(&sets) {
                sum.add(weights[node], &offset, &point, 1);
            }
            found.noise += sets[0][node].abs() * nodes.noise[node];
        }
        let error = self.error(state, direction.rate, &found);
        let score = error + found.noise * T::EPSILON;
        let resolves = score <= nodes.score.max(resolved());
        resolves.then_some(Best {
            found,
            score,
            error,
            spacing: nodes.spacing,
        })
    }
}
