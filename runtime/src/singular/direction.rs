//! The direction in which the constraints leave a singular configuration fastest.
//!
//! In:  a state near a singular configuration, its elimination.
//! Out: [`Direction`]: along the sheet, and where constraints move in time, or with the
//!      constraints that move while time stands still.
//!
//! The block of near-dependent rows changes along the sheet, to first order, by one
//! matrix for each coordinate of the chart. Of the directions the one is taken along
//! which all of its singular values pass zero fast and at one place.

use super::obstacle::Obstacle;
use super::sheet::{Sheet, Shift};
use super::stored_nodes::SIDE;
use crate::Real;
use crate::equations::At;
use crate::linalg::{Block, Eliminated, Workspace, add_scaled, dot, norm};
use crate::tolerance::{difference, hull, spacing, window};

/// Directions that are tried where several loops are nearly singular at once.
const TRIALS: usize = 16;

/// Up to so many coordinates of the chart, time among them, the change of the block along each is
/// kept; the change along any direction follows from these.
const FEW: usize = 4;

/// Share of the coordinates in a direction, below which nothing but time moves along it.
const STILL: f64 = 1e-3;

/// A line through a state along which the constraints leave a singular configuration.
#[derive(Debug)]
pub(super) struct Direction<'a, T> {
    /// The change of position along it, of length one in the metric.
    pub(super) q: &'a mut [T],
    /// The change of time along it (s).
    t: T,
    /// How the constraint rows that move are shifted along it, in the order and scale of the
    /// frame's rows.
    shift: &'a mut [T],
    /// Whether any row is shifted.
    pub(super) is_shifted: bool,
    /// Whether nothing but time moves along it.
    pub(super) is_of_time: bool,
    /// Where the singular configuration is.
    pub(super) centre: T,
    /// How fast the sine changes.
    pub(super) rate: T,
    /// How fast the block changes.
    change: Block<'a, T>,
}

impl<'a, T: Real> Direction<'a, T> {
    /// A direction that leads nowhere, for a block of this size.
    fn new(n: usize, size: usize, workspace: &Workspace<'a, T>) -> Self {
        Self {
            q: workspace.numbers(n),
            t: T::zero(),
            shift: workspace.numbers(n),
            is_shifted: false,
            is_of_time: false,
            centre: T::zero(),
            rate: T::zero(),
            change: Block::with_capacity(size, workspace),
        }
    }

    fn set(&mut self, other: &Direction<'_, T>) {
        self.q.copy_from_slice(other.q);
        self.shift.copy_from_slice(other.shift);
        (self.t, self.is_of_time) = (other.t, other.is_of_time);
        self.is_shifted = other.is_shifted;
        (self.centre, self.rate) = (other.centre, other.rate);
        self.change.set(&other.change);
    }

    /// Whether a block that was found at a distance along the line has the signs to which the block
    /// at its start changes up to there. On the other of two sheets that cross, it has opposite
    /// signs. A law of time may turn back on the way, so that signs tell nothing along time.
    pub(super) fn leads_to(
        &self,
        there: &Block<'_, T>,
        (here, distance): (&Block<'_, T>, T),
        workspace: &Workspace<'_, T>,
    ) -> bool {
        if self.is_of_time {
            return true;
        }
        workspace.scope(|workspace| {
            let mut expected = Block::with_capacity(here.size(), workspace);
            expected.set_sum(here, distance, &self.change);
            there.sign_changes_from(&expected, workspace) == 0
        })
    }

    /// The time and the position a distance along it.
    pub(super) fn moved(&self, state: At<'_, T>, distance: T, q: &mut [T]) -> T {
        q.copy_from_slice(state.q);
        add_scaled(q, distance, self.q);
        state.t + self.t * distance
    }

    /// What the constraint rows are to be a distance along it, instead of zero.
    pub(super) fn shifted(&self, distance: T) -> Shift<'_, T> {
        Shift(self.is_shifted.then_some((distance, &*self.shift)))
    }
}

/// What moves rheonomic constraints along a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LineParameter {
    /// Time.
    Time,
    /// A shift of their right-hand sides at one time: where a law of time stops, it leads no
    /// farther, and at a knot of a spline it is not smooth; the shifted constraints are smooth in
    /// the shift even so.
    Shift,
}

/// How rheonomic constraints move along a line.
#[derive(Clone, Copy, Debug)]
enum Moving<'a, T> {
    Nothing,
    /// The time (s) in which the sheet moves by one unit of length when it is fastest.
    Time(T),
    /// How rows are shifted in one unit of length.
    Rows(&'a [T]),
}

/// Where directions are looked for.
struct Search<'a, 'b, T> {
    state: At<'a, T>,
    like: &'a Eliminated<'b, T>,
    /// Coordinates of the chart, and what moves the sheet, if anything does.
    dimension: usize,
    moving: Moving<'a, T>,
}

/// The best direction so far, and its score: none until a direction was judged.
struct Best<'a, T> {
    direction: Direction<'a, T>,
    score: Option<T>,
}

impl<T: Real> Sheet<'_, T> {
    /// The best direction through a state with this elimination. If the sheet moves, `parameter`
    /// says what moves it along the line.
    #[inline(never)]
    pub(super) fn direction<'b>(
        &mut self,
        state: At<'_, T>,
        like: &Eliminated<'_, T>,
        parameter: LineParameter,
        workspace: &Workspace<'b, T>,
    ) -> Result<Direction<'b, T>, Obstacle> {
        let rows = workspace.numbers(self.chart.n());
        let moves = self.chart.speed > T::zero();
        let moving = match parameter {
            LineParameter::Time if moves => Moving::Time(T::one() / self.chart.speed),
            LineParameter::Shift if moves && self.shift(state, rows) => Moving::Rows(rows),
            LineParameter::Shift => return Err(Obstacle::Unresolved),
            LineParameter::Time => Moving::Nothing,
        };
        let dimension = self.chart.freedoms + usize::from(moves);
        let search = Search {
            state,
            like,
            dimension: dimension.min(self.chart.n()),
            moving,
        };
        let mut best = Best {
            direction: Direction::new(self.chart.n(), like.block().size(), workspace),
            score: None,
        };
        workspace.scope(|workspace| match like.block().size() {
            1 => self.try_steepest(&search, &mut best, workspace),
            _ => self.try_directions(&search, &mut best, workspace),
        })?;
        match best.score {
            Some(_) => Ok(best.direction),
            None => Err(Obstacle::Unresolved),
        }
    }

    /// The direction in which the one entry of the block changes fastest.
    fn try_steepest(
        &mut self,
        search: &Search<'_, '_, T>,
        best: &mut Best<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<(), Obstacle> {
        let mut direction = Direction::new(self.chart.n(), 1, workspace);
        let mut change = Block::zeros(1, workspace);
        let gradient = workspace.numbers(search.dimension);
        for (i, entry) in gradient.iter_mut().enumerate() {
            self.set_axis(search, i, &mut direction, workspace);
            self.change(search, &direction, &mut change, workspace)?;
            *entry = change.first();
        }
        let size = norm(gradient);
        // A comparison with NaN is false, so that a gradient that is NaN counts as none.
        let changes = size > T::zero();
        if !changes {
            return Err(Obstacle::Unresolved);
        }
        for entry in &mut *gradient {
            *entry /= size;
        }
        self.set_line(gradient, search.moving, &mut direction);
        self.change(search, &direction, &mut change, workspace)?;
        self.consider(search.like.block(), direction, &change, best, workspace);
        Ok(())
    }

    /// Judges directions that are spread evenly.
    fn try_directions(
        &mut self,
        search: &Search<'_, '_, T>,
        best: &mut Best<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<(), Obstacle> {
        let (size, dimension) = (search.like.block().size(), search.dimension);
        let few = dimension.min(FEW);
        let mut kept: [Block<'_, T>; FEW] =
            core::array::from_fn(|i| Block::zeros(if i < few { size } else { 0 }, workspace));
        let mut direction = Direction::new(self.chart.n(), size, workspace);
        if dimension <= FEW {
            for (i, kept) in kept[..dimension].iter_mut().enumerate() {
                self.set_axis(search, i, &mut direction, workspace);
                self.change(search, &direction, kept, workspace)?;
            }
        }
        let mut change = Block::zeros(size, workspace);
        let shares = workspace.numbers(dimension);
        for trial in 0..if dimension > 1 { TRIALS } else { 1 } {
            spread_evenly(trial, shares);
            workspace.scope(|workspace| {
                let mut direction = Direction::new(self.chart.n(), size, workspace);
                self.set_line(shares, search.moving, &mut direction);
                if dimension <= FEW {
                    change.set_combination(shares, &kept[..dimension]);
                } else {
                    self.change(search, &direction, &mut change, workspace)?;
                }
                self.consider(search.like.block(), direction, &change, best, workspace);
                Ok(())
            })?;
        }
        Ok(())
    }

    /// How rows are shifted when the sheet moves on by one unit of length in the direction in which
    /// it moved last: in proportion to what the law of time does to them in a while. `false` if
    /// that is nothing.
    fn shift(&mut self, state: At<'_, T>, rows: &mut [T]) -> bool {
        let chart = self.chart;
        let duration = spacing::<T>() * chart.coordinate_scale.range / chart.speed;
        for (sign, t) in [(T::one(), state.t), (-T::one(), state.t + duration)] {
            self.equations.locate(t, state.q);
            let residual = self.equations.constraints().residual;
            for (target, &row) in rows.iter_mut().zip(chart.rows) {
                *target += sign * chart.row_scale[row] * residual[row];
            }
        }
        self.equations.locate(state.t, state.q);
        let moved = self.rates(chart.heading, T::zero());
        let share = dot(rows, moved) / dot(rows, rows);
        for entry in &mut *rows {
            *entry *= share;
        }
        // False where nothing moved, and where no row was seen to: the share is then NaN.
        share.abs() > T::zero()
    }

    /// A line along one coordinate of the chart, or along what moves the sheet.
    fn set_axis(
        &self,
        search: &Search<'_, '_, T>,
        axis: usize,
        direction: &mut Direction<'_, T>,
        workspace: &Workspace<'_, T>,
    ) {
        workspace.scope(|workspace| {
            let shares = workspace.numbers(search.dimension);
            shares[axis] = T::one();
            self.set_line(shares, search.moving, direction);
        });
    }

    /// A line along some coordinates of the chart, after which a share of what moves the
    /// sheet may follow.
    fn set_line(&self, shares: &[T], moving: Moving<'_, T>, direction: &mut Direction<'_, T>) {
        direction.q.fill(T::zero());
        for (share, column) in shares.iter().zip(self.chart.tangents()) {
            add_scaled(direction.q, *share, column);
        }
        direction.t = T::zero();
        let share = shares.get(self.chart.freedoms).copied();
        match (moving, share.unwrap_or_default()) {
            (Moving::Nothing, _) => {}
            (Moving::Time(unit), share) => {
                direction.t = unit * share;
                add_scaled(direction.q, direction.t, self.chart.drift);
            }
            (Moving::Rows(rows), share) => {
                add_scaled(direction.q, share, self.chart.heading);
                direction.shift.fill(T::zero());
                add_scaled(direction.shift, share, rows);
                direction.is_shifted = true;
            }
        }
        let others = &shares[..self.chart.freedoms.min(shares.len())];
        direction.is_of_time = direction.t != T::zero() && norm(others) < T::from_f64(STILL);
        (direction.centre, direction.rate) = (T::zero(), T::zero());
    }

    /// Judges a direction along which the block changes: how fast its singular values do,
    /// and whether they pass zero near one place.
    fn consider(
        &self,
        here: &Block<'_, T>,
        mut direction: Direction<'_, T>,
        change: &Block<'_, T>,
        best: &mut Best<'_, T>,
        workspace: &Workspace<'_, T>,
    ) {
        // Where the block is diagonal, its last entries are those that nearly vanish, and
        // the others are those of rows that only might have.
        let met = workspace.scope(|workspace| {
            let (slopes, values) = change.in_bases_of(here, workspace);
            let weak = values.iter().filter(|value| **value < window()).count();
            let weak = weak.max(1).min(values.len());
            let first = values.len() - weak;
            meeting(slopes.last(weak, workspace), &values[first..], workspace)
        });
        let Some((centre, rate)) = met else {
            return;
        };
        (direction.centre, direction.rate) = (centre, rate);
        direction.change.set(change);
        let step = spacing::<T>() * self.chart.coordinate_scale.range.min(T::one() / rate);
        if centre.abs() > step * hull(SIDE) {
            return;
        }
        let score = clearance_of(here, change, (centre, step), best.score, workspace);
        if best.score.is_none_or(|least| score > least) {
            best.direction.set(&direction);
            best.score = Some(score);
        }
    }

    /// The change of the block along a direction, by a one-sided difference: direction
    /// and spacing of the nodes are wanted to a few digits only.
    fn change(
        &mut self,
        search: &Search<'_, '_, T>,
        direction: &Direction<'_, T>,
        change: &mut Block<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<(), Obstacle> {
        let distance = difference::<T>() * self.chart.coordinate_scale.range;
        workspace.scope(|workspace| {
            let q = workspace.numbers(self.chart.n());
            let t = direction.moved(search.state, distance, q);
            self.eliminate((t, q), Some(search.like))
        })?;
        change.set_sum(self.frame.block(), -T::one(), search.like.block());
        change.scale(T::one() / distance);
        Ok(())
    }
}

/// Where the nearest of some singular values passes zero, and how fast the slowest of them
/// changes, to first order; none if one of them stays what it is.
fn meeting<T: Real>(
    mut slopes: Block<'_, T>,
    values: &[T],
    workspace: &Workspace<'_, T>,
) -> Option<(T, T)> {
    let mut nearest = T::from_f64(f64::INFINITY);
    for (i, value) in values.iter().enumerate() {
        let centre = -*value / slopes.row(i)[i];
        // A comparison with NaN is false, so that a value that is and stays zero is passed over.
        if centre.abs() < nearest.abs() {
            nearest = centre;
        }
    }
    let rate = slopes.smallest(workspace);
    (rate > T::zero() && nearest.is_finite()).then_some((nearest, rate))
}

/// Directions that fill the sphere evenly, by multiples of irrational numbers.
fn spread_evenly<T: Real>(trial: usize, vector: &mut [T]) {
    for (i, entry) in vector.iter_mut().enumerate() {
        let root = ((i * i + 3 * i + 2) as f64 + 0.5).sqrt();
        *entry = T::from_f64(2.0 * ((trial + 1) as f64 * root % 1.0) - 1.0);
    }
    let size = norm(vector);
    for entry in vector {
        *entry /= size;
    }
}

/// The smallest sine of nodes on both sides of a place, to first order; where it is not above the
/// best score so far, nothing but an upper bound of it.
fn clearance_of<T: Real>(
    here: &Block<'_, T>,
    change: &Block<'_, T>,
    (centre, step): (T, T),
    best: Option<T>,
    workspace: &Workspace<'_, T>,
) -> T {
    workspace.scope(|workspace| {
        let sides = (1..=SIDE).flat_map(|k| [T::from_f64(k as f64), -T::from_f64(k as f64)]);
        let mut there = Block::with_capacity(here.size(), workspace);
        let mut least = T::one();
        for place in sides {
            if best.is_some_and(|best| least <= best) {
                break;
            }
            there.set_sum(here, centre + step * place, change);
            least = least.min(there.smallest(workspace));
        }
        least
    })
}
