//! A state onto its sheet, at regular states and across singular configurations.
//!
//! In:  a state within a step, the chart of the last accepted state.
//! Out: a [`PointView`] on the sheet, and how it was found.
//!
//! Near a singular configuration nodes of several spacings are tried, each half the one
//! before. Wide ones have less round-off, narrow ones less error of interpolation, and
//! more room where the sheet turns or other singular configurations are near.

use super::direction::{Direction, LineParameter};
use super::nodes::Interpolated;
use super::obstacle::Obstacle;
use super::sheet::{PointView, Sheet};
use super::stored_nodes::SIDE;
use crate::Real;
use crate::dynamics::CoordinateScale;
use crate::equations::At;
use crate::linalg::{Eliminated, Workspace, add_scaled};
use crate::tolerance::{excusable, hull, resolvable, resolved, spacing, window};

/// The difference of two interpolations may, by round-off alone, be this many times the round-off
/// of one node, magnified by the weights.
const NOISE: f64 = 48.0;
/// Spacings that are tried.
const LEVELS: usize = 12;
/// A move onto the sheet in which signs change came from another sheet if it is longer than this
/// many errors: of the interpolation, or those that are accepted, by which a step may be off.
const STRAYS: f64 = 10.0;
/// No other spacings are tried if an interpolation is worse than the best of all spacings was by no
/// more than this factor.
const NEARLY: f64 = 4.0;

/// Where no interpolation serves, the equations at the state do, unless their round-off is more than
/// this many errors that are accepted. By experiment: with less, loops that become singular at once
/// are given up where they are too far from it for narrow nodes.
const MAGNIFIED: f64 = 300.0;

/// Interpolations: the best one, and room for others.
type Tried<'a, T> = [Interpolated<'a, T>; 3];
const BEST: usize = 0;

/// Whether a state is placed between nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Serves {
    /// Between the best nodes that were found.
    Well,
    /// It is better placed without nodes.
    Not(Placement),
}

/// How a state was put onto its sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Placement {
    /// Where the constraints are regular.
    Regular,
    /// Between nodes, across a configuration where sheets cross.
    Crossing {
        /// The sign changed, and the state was moved by more than a step may be off: it lay
        /// beyond the other sheet.
        strays: bool,
        /// The sign changed, and the state was moved by more than this placement may be off: if
        /// it lay on the constraints, it lay on the other sheet.
        leaves: bool,
    },
    /// Where the constraints are regular, next to a configuration where they are nearly
    /// singular: a gap keeps the sheets apart.
    Gap,
}

impl Placement {
    /// The placement on a product of two sheets.
    pub(super) fn and(self, other: Self) -> Self {
        match (self, other) {
            (
                Self::Crossing { strays, leaves },
                Self::Crossing {
                    strays: too,
                    leaves: also,
                },
            ) => Self::Crossing {
                strays: strays || too,
                leaves: leaves || also,
            },
            (crossing @ Self::Crossing { .. }, _) | (_, crossing @ Self::Crossing { .. }) => {
                crossing
            }
            (Self::Regular, other) => other,
            (Self::Gap, _) => Self::Gap,
        }
    }

    /// Whether sheets cross nearby.
    pub(crate) fn is_crossing(self) -> bool {
        matches!(self, Self::Crossing { .. })
    }
}

impl<T: Real> Sheet<'_, T> {
    /// Puts a state onto its sheet.
    pub(super) fn place(
        &mut self,
        state: At<'_, T>,
        point: &mut PointView<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<Placement, Obstacle> {
        let here = (state.t, state.q);
        self.eliminate(here, None)?;
        let sine = self.frame.smallest();
        let mut why = Some(Obstacle::Unresolved);
        let mut placement = Placement::Regular;
        if sine < window() && !self.chart.gap && self.chart.moves() {
            let placed = workspace.scope(|workspace| {
                let like = self.frame.eliminated(workspace);
                self.place_between(state, &like, point, workspace)
            });
            match placed {
                Ok(Placement::Regular) => why = None,
                Ok(Placement::Gap) => placement = Placement::Gap,
                Ok(crossing) => return Ok(crossing),
                Err(obstacle) => why = Some(obstacle),
            }
            self.eliminate(here, None)?;
        }
        // Next to a gap the sheet is as smooth as it is narrow, and short steps follow it.
        let gap = self.chart.gap || placement == Placement::Gap;
        let noise = self.chart.accepted * T::from_f64(MAGNIFIED);
        let is_noise =
            !gap && self.chart.moves() && sine < window() && T::EPSILON > noise * sine * sine;
        if let Some(why) = why.filter(|_| is_noise) {
            return Err(why);
        }
        self.place_regular(state, point, workspace)?;
        Ok(placement)
    }

    /// Interpolates; `Regular` where the equations at the state itself are better.
    fn place_between(
        &mut self,
        state: At<'_, T>,
        like: &Eliminated<'_, T>,
        point: &mut PointView<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<Placement, Obstacle> {
        let best = match self.reuse_nodes(state, workspace) {
            Some(best) => best,
            None => match self.find_nodes(state, like, workspace)? {
                Ok(best) => best,
                Err(placement) => return Ok(placement),
            },
        };
        let sum = best.sum(0);
        point.tangent.copy_from_slice(sum.tangent);
        point.drift.copy_from_slice(sum.drift);
        point.particular.copy_from_slice(sum.particular);
        point.set(state);
        add_scaled(point.q, T::one(), sum.offset);
        let along = workspace.numbers(self.chart.freedoms);
        self.chart.coordinates(state.v, along);
        point.move_along(along);
        point.sine = like.smallest();
        self.polish(point, like)?;
        let flips = self
            .frame
            .block()
            .sign_changes_from(like.block(), workspace)
            > 0;
        let moved = self.chart.length(sum.offset) / self.chart.coordinate_scale.range;
        let several = T::from_f64(STRAYS);
        point.spacing = best.spacing;
        Ok(Placement::Crossing {
            strays: flips && moved > self.chart.accepted * several,
            leaves: flips && moved > (best.error + resolved()) * several,
        })
    }

    /// Finds nodes for a state, or a placement without nodes that is better.
    #[inline(never)]
    fn find_nodes<'b>(
        &mut self,
        state: At<'_, T>,
        like: &Eliminated<'_, T>,
        workspace: &Workspace<'b, T>,
    ) -> Result<Result<Interpolated<'b, T>, Placement>, Obstacle> {
        let mut tried = core::array::from_fn(|_| Interpolated::new(&self.chart, workspace));
        let mut found = self.try_nodes(state, like, LineParameter::Time, &mut tried, workspace);
        let poor = match found {
            Ok(Serves::Well) => tried[BEST].error > self.chart.accepted,
            Ok(Serves::Not(_)) => false,
            Err(_) => true,
        };
        if poor && self.chart.speed > T::zero() {
            let error = found.is_ok().then_some(tried[BEST].error);
            let other = self.try_nodes(state, like, LineParameter::Shift, &mut tried, workspace);
            let is_better =
                other == Ok(Serves::Well) && error.is_none_or(|error| tried[BEST].error < error);
            if is_better {
                found = other;
            } else if found.is_ok() {
                found = self.try_nodes(state, like, LineParameter::Time, &mut tried, workspace);
            }
        }
        let [best, ..] = tried;
        match found? {
            Serves::Well => Ok(Ok(best)),
            Serves::Not(placement) => Ok(Err(placement)),
        }
    }

    /// Tries nodes along the best direction. If the sheet moves, `parameter` says what moves it
    /// along the line.
    #[inline(never)]
    fn try_nodes(
        &mut self,
        state: At<'_, T>,
        like: &Eliminated<'_, T>,
        parameter: LineParameter,
        tried: &mut Tried<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<Serves, Obstacle> {
        workspace.scope(|workspace| {
            let mut direction = self.direction(state, like, parameter, workspace)?;
            let found = self.try_direction(state, like, &direction, tried, workspace);
            if !direction.is_of_time || !matches!(found, Err(Obstacle::Unresolved)) {
                return found;
            }
            // A law of time may stop before it comes to where it leads now, and there is nothing
            // to be crossed along it: nodes around the state itself serve as well.
            direction.centre = T::zero();
            self.try_direction(state, like, &direction, tried, workspace)
        })
    }

    /// Tries nodes along a direction.
    #[inline(never)]
    fn try_direction(
        &mut self,
        state: At<'_, T>,
        like: &Eliminated<'_, T>,
        direction: &Direction<'_, T>,
        tried: &mut Tried<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<Serves, Obstacle> {
        if !self.search(state, like, direction, tried, workspace)? {
            return Err(Obstacle::Unresolved);
        }
        let [best, ..] = tried;
        if !workspace.scope(|inner| self.is_crossing(state, like, direction, best, inner))? {
            return Ok(Serves::Not(Placement::Gap));
        }
        // Rows are no more exact than the coordinates, whose round-off grows with their size.
        let CoordinateScale { size, range, .. } = self.chart.coordinate_scale;
        let reach = |length: T| (direction.rate * length).max(T::one());
        let noise = T::from_f64(NOISE) * T::EPSILON * best.noise * reach(size);
        let excused = noise.min(excusable::<T>() * reach(range));
        if best.error > self.chart.accepted.max(excused) {
            return Err(Obstacle::Unresolved);
        }
        // If neither the interpolation nor the equations at the state are as good as wanted, the
        // better of the two.
        let sine = like.smallest();
        if best.error > self.chart.accepted && best.error * sine * sine > T::EPSILON {
            return Ok(Serves::Not(Placement::Regular));
        }
        self.store_nodes(state, direction, best);
        Ok(Serves::Well)
    }

    /// Tries spacings; `false` if the state is outside the nodes of all that are narrow
    /// enough.
    fn search(
        &mut self,
        state: At<'_, T>,
        like: &Eliminated<'_, T>,
        direction: &Direction<'_, T>,
        [best, found, last]: &mut Tried<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<bool, Obstacle> {
        let (known, mut width) = self.spacings(direction);
        let mut tried = None;
        if known > T::zero() {
            last.spacing = known;
            let inside = self.between_nodes(state, like, direction, last, workspace);
            if inside == Ok(true) && self.serves(last) {
                core::mem::swap(best, last);
                return Ok(true);
            }
            tried = Some(inside);
        }
        let (mut least, mut why) = (None, None);
        for _ in 0..LEVELS {
            let inside = match tried.take_if(|_| width == known) {
                Some(inside) => {
                    core::mem::swap(found, last);
                    inside
                }
                None => {
                    found.spacing = width;
                    self.between_nodes(state, like, direction, found, workspace)
                }
            };
            match inside {
                Ok(false) => break,
                Ok(true) => {
                    let resolves = found.error <= resolved();
                    if least.is_none_or(|least| found.score < least) {
                        core::mem::swap(best, found);
                        least = Some(best.score);
                    }
                    if resolves {
                        break;
                    }
                }
                Err(obstacle) => why = Some(obstacle),
            }
            width *= T::from_f64(0.5);
        }
        match (least, why) {
            (Some(_), _) => Ok(true),
            (None, Some(why)) => Err(why),
            (None, None) => Ok(false),
        }
    }

    /// The spacing that is tried first, zero for none, and the widest of the others. Mostly the
    /// last one serves again, or that of the last passage. Where the sheet moves, the sine may
    /// change ever more slowly and then faster again, and a spacing that was right before says
    /// nothing of how far nodes are apart now.
    fn spacings(&self, direction: &Direction<'_, T>) -> (T, T) {
        let widest =
            (spacing::<T>() * self.chart.coordinate_scale.range * direction.rate).min(spacing());
        let known = self.chart.spacing;
        if self.chart.speed > T::zero() {
            return (T::zero(), widest);
        }
        match known > T::zero() {
            true => (known, widest.min(known * T::from_f64(4.0))),
            false => (self.nodes.quality.spacing.min(widest), widest),
        }
    }

    /// Whether no better interpolation need be sought: its error counts as zero, or it is as good
    /// as a step needs it and nearly as good as the last one, which was the best of all spacings.
    pub(super) fn serves(&self, found: &Interpolated<'_, T>) -> bool {
        let nearly = self.nodes.quality.score * T::from_f64(NEARLY);
        let enough = found.error <= self.chart.accepted;
        found.score <= resolved() || enough && found.score <= nearly.min(resolvable())
    }

    /// Interpolates between nodes of the spacing of `found`; `false` if the state is outside.
    #[inline(never)]
    fn between_nodes(
        &mut self,
        state: At<'_, T>,
        like: &Eliminated<'_, T>,
        direction: &Direction<'_, T>,
        found: &mut Interpolated<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<bool, Obstacle> {
        if direction.centre.abs() * direction.rate > hull::<T>(SIDE) * found.spacing {
            return Ok(false);
        }
        workspace.scope(|inner| self.interpolate(state, direction, like, found, inner))?;
        self.judge(state, direction.rate, found);
        Ok(true)
    }

    /// Finds by how much an interpolation is off, relative to what is interpolated: the
    /// difference that one pair of nodes makes, made smaller by as much as it is smaller
    /// than that of the pair before.
    #[inline(never)]
    pub(super) fn judge(&self, state: At<'_, T>, rate: T, found: &mut Interpolated<'_, T>) {
        let chart = &self.chart;
        let [all, fewer, fewest] = [0, 1, 2].map(|set| found.sum(set));
        let speed = chart.length(state.v);
        let bend = chart.length(all.particular) + speed * speed * rate;
        let mut differences = [T::zero(); 2];
        for (difference, (a, b)) in differences.iter_mut().zip([(all, fewer), (fewer, fewest)]) {
            let offset = chart.apart(a.offset, b.offset) / chart.coordinate_scale.range;
            let particular = match bend > T::zero() {
                true => chart.apart(a.particular, b.particular) / bend,
                false => T::zero(),
            };
            let drift = match chart.speed > T::zero() {
                true => chart.apart(a.drift, b.drift) / chart.speed.max(speed),
                false => T::zero(),
            };
            let mut turn = T::zero();
            let columns = a.tangent.chunks_exact(chart.n());
            for (a, b) in columns.zip(b.tangent.chunks_exact(chart.n())) {
                turn += chart.apart(a, b);
            }
            *difference = offset + drift + particular + turn;
        }
        let [last, before] = differences;
        let ratio = last / before;
        let least = T::from_f64(1e-3);
        // The ratio is NaN where both are zero, and comparisons with NaN are false.
        found.error = if ratio < T::one() {
            last * ratio.max(least)
        } else {
            last
        };
        found.score = found.error + found.noise * T::EPSILON;
    }
}
