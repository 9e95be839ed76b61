//! A state onto its sheet, at regular states and across singular configurations.
//!
//! In:  a state within a step, the chart of the last accepted state.
//! Out: a [`Point`] on the sheet, and how it was found.
//!
//! Near a singular configuration nodes of several spacings are tried, each half the one
//! before. Wide ones have less round-off, narrow ones less error of interpolation, and
//! more room where the sheet turns or other singular configurations are near.

use super::direction::Direction;
use super::kept::SIDE;
use super::nodes::Interpolated;
use super::obstacle::Obstacle;
use super::sheet::{Point, Sheet};
use crate::linalg::{Frame, column, norm};
use crate::tolerance::{critical, hull, negligible, noisy, resolved, round_off, spacing, window};
use crate::{Real, State};

/// How much larger than the round-off of one node, magnified by the weights, the
/// difference of two interpolations may be for that reason.
const NOISE: f64 = 48.0;
/// Evaluations that lead to the critical configuration.
const CENTRINGS: usize = 4;
/// Spacings that are tried.
const LEVELS: usize = 12;

/// How a state was put onto its sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Placement<T> {
    /// Where the constraints are regular.
    Regular,
    /// Between nodes of this spacing, across a configuration where sheets cross.
    Crossing { spacing: T },
    /// Where the constraints are regular, next to a configuration where they are nearly
    /// singular: a gap keeps the sheets apart.
    Gap,
}

/// The best interpolation so far.
pub(super) struct Best<T, const N: usize> {
    pub(super) found: Interpolated<T, N>,
    pub(super) score: T,
    pub(super) error: T,
    pub(super) spacing: T,
}

impl<T: Real, const N: usize, const R: usize> Sheet<'_, T, N, R> {
    /// Puts a state onto its sheet.
    pub(crate) fn place(
        &mut self,
        state: &State<T, N>,
        point: &mut Point<T, N>,
    ) -> Result<Placement<T>, Obstacle> {
        if !state.is_finite() {
            return Err(Obstacle::NotFinite);
        }
        self.eliminate(state, None)?;
        let sine = self.frame.smallest();
        let mut why = Some(Obstacle::Unresolved);
        let mut placement = Placement::Regular;
        if sine < window() && !self.chart.gap {
            let like = self.frame.clone();
            match self.place_between(state, &like, point) {
                Ok(Placement::Regular) => why = None,
                Ok(Placement::Gap) => placement = Placement::Gap,
                Ok(crossing) => return Ok(crossing),
                Err(obstacle) => why = Some(obstacle),
            }
            self.eliminate(state, None)?;
        }
        let noise = match self.chart.gap {
            true => noisy(),
            false => self.chart.accepted * T::from_f64(10.0),
        };
        if let Some(why) = why.filter(|_| sine < window() && T::EPSILON > noise * sine * sine) {
            return Err(why);
        }
        self.place_regular(state, point)?;
        Ok(placement)
    }

    /// Interpolates; `Regular` where the equations at the state itself are better.
    #[inline(never)]
    fn place_between(
        &mut self,
        state: &State<T, N>,
        like: &Frame<T, N, R>,
        point: &mut Point<T, N>,
    ) -> Result<Placement<T>, Obstacle> {
        let best = match self.recall(state) {
            Some(best) => best,
            None => match self.find_nodes(state, like)? {
                Ok(best) => best,
                Err(placement) => return Ok(placement),
            },
        };
        let [sum, ..] = &best.found.sums;
        point.tangent = sum.tangent;
        point.drift = sum.drift;
        point.particular = sum.particular;
        point.state = State::new(state.t, state.q + sum.offset, state.v);
        let along = self.chart.coordinates(&state.v);
        point.move_along(&along, self.chart.freedoms);
        point.sine = like.smallest();
        self.polish(point, like)?;
        Ok(Placement::Crossing {
            spacing: best.spacing,
        })
    }

    /// Finds nodes for a state, or that it is better placed without any.
    #[inline(never)]
    fn find_nodes(
        &mut self,
        state: &State<T, N>,
        like: &Frame<T, N, R>,
    ) -> Result<Result<Best<T, N>, Placement<T>>, Obstacle> {
        let direction = self.direction(state, like)?;
        let Some(best) = self.search(state, like, &direction)? else {
            return Err(Obstacle::Unresolved);
        };
        if !self.is_crossing(state, like, &direction, &best) {
            return Ok(Err(Placement::Gap));
        }
        // Rows are no more exact than the coordinates, whose round-off grows with their size.
        let magnified = best.found.noise * (direction.rate * self.chart.reach).max(T::one());
        let noise = T::from_f64(NOISE) * T::EPSILON * magnified;
        if best.error > self.chart.accepted.max(noise) {
            return Err(Obstacle::Unresolved);
        }
        // Where neither is as good as wanted, the better one.
        let sine = like.smallest();
        if best.error > self.chart.accepted && best.error * sine * sine > T::EPSILON {
            return Ok(Err(Placement::Regular));
        }
        self.remember(state, &direction, &best);
        Ok(Ok(best))
    }

    /// Tries spacings; `None` if the state is outside the nodes of all that are narrow
    /// enough.
    fn search(
        &mut self,
        state: &State<T, N>,
        like: &Frame<T, N, R>,
        direction: &Direction<T, N>,
    ) -> Result<Option<Best<T, N>>, Obstacle> {
        let known = self.chart.spacing;
        let mut width = (spacing::<T>() * self.chart.reach * direction.rate).min(spacing());
        let mut tried = None;
        if known > T::zero() {
            // Mostly the last spacing serves again.
            let last = self.between_nodes(state, like, direction, known);
            if matches!(&last, Ok(Some(last)) if last.score <= resolved()) {
                return last;
            }
            tried = Some(last);
            width = width.min(known * T::from_f64(4.0));
        }
        let mut best: Option<Best<T, N>> = None;
        let mut why = None;
        for _ in 0..LEVELS {
            let found = match tried.take_if(|_| width == known) {
                Some(found) => found,
                None => self.between_nodes(state, like, direction, width),
            };
            match found {
                Ok(None) => break,
                Ok(Some(found)) => {
                    let least = best.as_ref().map(|best| best.score);
                    let resolves = found.error <= resolved();
                    let worse = least.is_some_and(|least| found.score > least * T::from_f64(4.0));
                    if least.is_none_or(|least| found.score < least) {
                        best = Some(found);
                    }
                    if resolves || worse {
                        break;
                    }
                }
                Err(obstacle) => why = Some(obstacle),
            }
            width *= T::from_f64(0.5);
        }
        match (best, why) {
            (None, Some(why)) => Err(why),
            (best, _) => Ok(best),
        }
    }

    /// Interpolates between nodes of a spacing; `None` if the state is outside.
    #[inline(never)]
    fn between_nodes(
        &mut self,
        state: &State<T, N>,
        like: &Frame<T, N, R>,
        direction: &Direction<T, N>,
        width: T,
    ) -> Result<Option<Best<T, N>>, Obstacle> {
        if direction.centre.abs() * direction.rate > hull::<T>(SIDE) * width {
            return Ok(None);
        }
        let mut found = Interpolated::new();
        self.interpolate(state, direction, width, like, &mut found)?;
        let error = self.error(state, direction.rate, &found);
        let score = error + found.noise * T::EPSILON;
        Ok(Some(Best {
            found,
            score,
            error,
            spacing: width,
        }))
    }

    /// By how much the interpolation is off, relative to what is interpolated: the
    /// difference that one pair of nodes makes, made smaller by as much as it is smaller
    /// than that of the pair before.
    #[inline(never)]
    pub(super) fn error(&self, state: &State<T, N>, rate: T, found: &Interpolated<T, N>) -> T {
        let [all, fewer, fewest] = &found.sums;
        let speed = self.chart.length(&state.v);
        let bend = self.chart.length(&all.particular) + speed * speed * rate;
        let mut differences = [T::zero(); 2];
        for (difference, (a, b)) in differences.iter_mut().zip([(all, fewer), (fewer, fewest)]) {
            let offset = self.chart.length(&(a.offset - b.offset)) / self.chart.reach;
            let particular = match bend > T::zero() {
                true => self.chart.length(&(a.particular - b.particular)) / bend,
                false => T::zero(),
            };
            let drift = match self.chart.speed > T::zero() {
                true => self.chart.length(&(a.drift - b.drift)) / self.chart.speed.max(speed),
                false => T::zero(),
            };
            let mut turn = T::zero();
            for i in 0..self.chart.freedoms {
                turn += self.chart.apart(&a.tangent, &b.tangent, i);
            }
            *difference = offset + drift + particular + turn;
        }
        let [last, before] = differences;
        let ratio = last / before;
        let least = T::from_f64(1e-3);
        // NaN where both are zero.
        if ratio < T::one() {
            last * ratio.max(least)
        } else {
            last
        }
    }

    /// Whether the constraints vanish, to round-off, where the sheet meets the singular
    /// set: two sheets then cross there. Otherwise a gap keeps them apart.
    #[inline(never)]
    fn is_crossing(
        &mut self,
        state: &State<T, N>,
        like: &Frame<T, N, R>,
        direction: &Direction<T, N>,
        best: &Best<T, N>,
    ) -> bool {
        if !self.holonomic {
            return true;
        }
        let step = best.spacing / direction.rate;
        let reach = self.reach_of_rows(state, direction, best);
        let mut place = T::zero();
        for _ in 0..CENTRINGS {
            let mut at = direction.moved(state, direction.centre + step * place);
            at.q += best.found.offset_at(place);
            if self.eliminate(&at, Some(like)).is_err() {
                return false;
            }
            let block = self.frame.block();
            let moved = block.entries[0][0] / best.found.slope;
            // Several loops have no one place where all of them are singular.
            let refines = block.size == 1 && moved.abs() < T::one();
            if !refines || moved.abs() < negligible() {
                break;
            }
            place -= moved;
        }
        let right = self.scaled(&self.position.residual, &[T::zero(); N]);
        let rest = self.frame.reduced(&right);
        let most = rest.iter().fold(T::zero(), |most: T, x| most.max(x.abs()));
        // Beside the crossing an error of interpolation is seen as far as rows are not zero.
        let doubt = T::from_f64(4.0) * best.error * self.frame.smallest();
        most <= (critical::<T>() * round_off() + doubt) * reach
    }

    /// How far the coordinates reach along the rows: what their round-off adds up to in a row.
    /// Where masses are unlike each other, that is far less than they reach along the heaviest.
    fn reach_of_rows(
        &mut self,
        state: &State<T, N>,
        direction: &Direction<T, N>,
        best: &Best<T, N>,
    ) -> T {
        let place = direction.centre + best.spacing / direction.rate * best.found.places[0];
        let mut node = direction.moved(state, place);
        node.q += best.found.offsets[0];
        self.mechanism.position(&node, self.position);
        let chart = self.chart;
        let mut most = T::zero();
        for &row in &chart.rows[..self.constraints()] {
            let jacobian = &self.position.jacobian;
            let levers = chart.sizes.iter().enumerate();
            // A state that is integrated has no size, and no lever.
            let reach = levers
                .map(|(j, size)| (jacobian[(row, j)].abs(), *size))
                .filter(|(lever, _)| *lever > T::zero())
                .fold(T::zero(), |sum, (lever, size)| sum + lever * size);
            let mut lifted: [T; N] = column(|j| jacobian[(row, j)]);
            chart.factor.forward(&mut lifted);
            let length = norm(&lifted);
            if length > T::zero() {
                most = most.max(reach / length);
            }
        }
        most.min(chart.reach)
    }
}
