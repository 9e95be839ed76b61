//! The critical configuration next to a state: do sheets cross there?
//!
//! In:  nodes on a sheet, on both sides of a configuration where a constraint is weak.
//! Out: whether another sheet crosses it, or a gap keeps them apart.
//!
//! Near a crossing the near-dependent constraint, when the others are eliminated, is a
//! product: of how far a position is along the sheet, and across it. In the critical
//! configuration both rates vanish, and what is left of the constraint is zero or the gap.

use super::direction::Direction;
use super::nodes::{BEYOND, Interpolated};
use super::obstacle::Obstacle;
use super::sheet::{Sheet, Shift};
use crate::Real;
use crate::equations::At;
use crate::linalg::{Eliminated, Workspace, add_scaled, norm, solve_upper};
use crate::tolerance::{critical, near_dependent, resolved, round_off};

/// Evaluations that lead to the critical configuration.
const CENTRINGS: usize = 8;
/// A constraint error that is no larger than this many times what may be round-off tells
/// neither a crossing nor a gap.
const CLEAR: f64 = 4.0;
/// A sheet next to a gap passes the critical configuration no farther off than its interpolation
/// may be off, times this.
const ASIDE: f64 = 1e3;

/// Directions at a singular configuration.
struct Cross<'a, T> {
    /// Along the sheet, from one node to the next, and the time that it takes (s).
    along: &'a mut [T],
    time: T,
    /// Off the sheet, where the near-dependent constraint changes alone.
    across: &'a mut [T],
    /// The round-off of constraints.
    round_off: T,
}

/// What a search for the critical configuration has come to.
struct Search<T> {
    /// How far it is from where it was expected, along the sheet and across it.
    distance: T,
    aside: T,
    /// What may still be left of the near-dependent constraint.
    unsure: T,
    /// Whether both of its rates vanish there.
    found: bool,
}

impl<T: Real> Sheet<'_, T> {
    /// Whether the constraints vanish, to round-off, in the critical configuration: two sheets
    /// then cross there. If they clearly don't, a gap keeps them apart; between, nothing tells.
    #[inline(never)]
    pub(super) fn is_crossing(
        &mut self,
        state: At<'_, T>,
        like: &Eliminated<'_, T>,
        direction: &Direction<'_, T>,
        best: &Interpolated<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<bool, Obstacle> {
        if !self.kind.holonomic {
            return Ok(true);
        }
        // No search where several loops need not become singular at one place, where a law of time
        // may lead there and back, or where rows are shifted: the search takes rows as they are.
        if like.block().size() != 1 || direction.is_of_time || direction.is_shifted {
            return self.vanishes_at_centre(state, like, direction, best, workspace);
        }
        let cross = self.cross(state, like, direction, best, workspace)?;
        let search = self.search_critical((state, like), direction, best, &cross, workspace)?;
        // Another loop, which the state is farther from, becomes singular there, too.
        if self.frame.smallest_independent() < near_dependent() {
            return self.vanishes_at_centre(state, like, direction, best, workspace);
        }
        let Search { aside, unsure, .. } = search;
        let most = self.largest_residual(Shift::NONE);
        let bound = critical::<T>() * cross.round_off;
        let off =
            (best.error + resolved()) * self.chart.coordinate_scale.range * T::from_f64(ASIDE);
        // The directions are those at the nodes; this is how much they may turn on the way.
        let turned = search.distance * search.distance / self.chart.coordinate_scale.range;
        let settles = unsure <= cross.round_off || aside <= off + turned;
        if unsure > bound || !settles {
            return Err(Obstacle::Unresolved);
        }
        match most <= bound + unsure {
            true => Ok(true),
            false if search.found && aside <= off && most > bound * T::from_f64(CLEAR) => Ok(false),
            false => Err(Obstacle::Unresolved),
        }
    }

    /// Whether the constraints vanish, to round-off and what interpolation may be off by, where
    /// the singular configuration is expected; if not, nothing tells.
    fn vanishes_at_centre(
        &mut self,
        state: At<'_, T>,
        like: &Eliminated<'_, T>,
        direction: &Direction<'_, T>,
        best: &Interpolated<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<bool, Obstacle> {
        let q = workspace.numbers(self.chart.n());
        let t = node_at(0, state, direction, best, q);
        self.equations.locate(t, q);
        let round_off = round_off::<T>() * self.reach_of_rows(q);
        let t = direction.moved(state, direction.centre, q);
        best.add_offset_at(T::zero(), q);
        self.eliminate((t, q), Some(like))?;
        let unsure = T::from_f64(4.0) * best.error * self.frame.smallest();
        let bound = critical::<T>() * round_off + unsure * self.chart.coordinate_scale.range;
        let most = self.largest_residual(direction.shifted(direction.centre));
        match most <= bound {
            true => Ok(true),
            false => Err(Obstacle::Unresolved),
        }
    }

    /// Looks for the critical configuration by Newton's iteration on the rates of the
    /// near-dependent constraint along the sheet and across it; leaves the frame there.
    fn search_critical(
        &mut self,
        (state, like): (At<'_, T>, &Eliminated<'_, T>),
        direction: &Direction<'_, T>,
        best: &Interpolated<'_, T>,
        cross: &Cross<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<Search<T>, Obstacle> {
        let [q, onto] = [(); 2].map(|()| workspace.numbers(self.chart.n()));
        let step = best.spacing / direction.rate;
        let length = self.chart.length(cross.across);
        let (mut place, mut aside) = (T::zero(), T::zero());
        let (mut unsure, mut found) = (T::zero(), false);
        for _ in 0..CENTRINGS {
            let t = direction.moved(state, direction.centre + step * place, q);
            best.add_offset_at(place, q);
            add_scaled(q, aside, cross.across);
            add_scaled(q, T::one(), onto);
            self.eliminate((t, q), Some(like))?;
            let ahead = self.frame.block().first() / best.slope;
            let off = self.reduced_change(cross.along, cross.time) / best.slope;
            unsure = (ahead * off * best.slope).abs();
            // Where interpolation is not exact the other constraints do not hold, either.
            self.correct(onto);
            let corrected = self.chart.length(self.solution);
            // Directions are not exact, so that the squares of what is left count, too.
            let left = (ahead * step).abs() + off.abs() * length + corrected;
            found = left * left * (best.slope / step).abs() <= cross.round_off;
            if found {
                break;
            }
            (place, aside) = (place - ahead, aside - off);
            // A comparison with NaN is false, so that a place that is NaN is not inside.
            let inside = place.abs() < T::one();
            if !inside {
                return Err(Obstacle::Unresolved);
            }
        }
        Ok(Search {
            distance: (place * step).abs(),
            aside: aside.abs() * length,
            unsure,
            found,
        })
    }

    /// The directions, from the nodes next to the configuration, where rows are regular.
    fn cross<'b>(
        &mut self,
        state: At<'_, T>,
        like: &Eliminated<'_, T>,
        direction: &Direction<'_, T>,
        best: &Interpolated<'_, T>,
        workspace: &Workspace<'b, T>,
    ) -> Result<Cross<'b, T>, Obstacle> {
        let [along, across] = [(); 2].map(|()| workspace.numbers(self.chart.n()));
        let before = node_at(BEYOND, state, direction, best, along);
        let t = node_at(0, state, direction, best, across);
        let span = best.places[0] - best.places[BEYOND];
        for (along, q) in along.iter_mut().zip(&*across) {
            *along = (*q - *along) / span;
        }
        self.eliminate((t, across), Some(like))?;
        let round_off = round_off::<T>() * self.reach_of_rows(across);
        self.solve_weakest(across);
        Ok(Cross {
            along,
            time: (t - before) / span,
            across,
            round_off,
        })
    }

    /// The largest length of the coordinates along one of the rows at hand, whose round-off is that
    /// of the row; needs room for a vector. Where masses are very unlike each other, it is far less
    /// than the length of the coordinates along the heaviest.
    fn reach_of_rows(&self, lifted: &mut [T]) -> T {
        let chart = &self.chart;
        let jacobian = self.equations.constraints().jacobian;
        let mut most = T::zero();
        for &row in chart.rows {
            let mut coordinate_scale = T::zero();
            let entries = jacobian.iter().skip(row).step_by(chart.row_scale.len());
            for ((target, entry), size) in lifted.iter_mut().zip(entries).zip(chart.sizes) {
                *target = *entry;
                // A state that is integrated has no size, and no lever.
                if *entry != T::zero() {
                    coordinate_scale += entry.abs() * *size;
                }
            }
            solve_upper(chart.metric, lifted);
            let length = norm(lifted);
            if length > T::zero() {
                most = most.max(coordinate_scale / length);
            }
        }
        most.min(chart.coordinate_scale.size)
    }
}

/// The time and position of a node.
fn node_at<T: Real>(
    node: usize,
    state: At<'_, T>,
    direction: &Direction<'_, T>,
    best: &Interpolated<'_, T>,
    q: &mut [T],
) -> T {
    let step = best.spacing / direction.rate;
    let t = direction.moved(state, direction.centre + step * best.places[node], q);
    add_scaled(q, T::one(), best.node(node).offset);
    t
}
