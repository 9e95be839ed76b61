//! The direction in which the constraints leave a singular configuration fastest.
//!
//! In:  a state near a singular configuration, its frame.
//! Out: [`Direction`]: along the sheet, and in time where constraints move.
//!
//! The block of near-dependent rows changes along the sheet, to first order, by one
//! matrix for each coordinate of the chart. Of the directions the one is taken along
//! which all of its singular values pass zero fast and at one place.

use super::kept::SIDE;
use super::obstacle::Obstacle;
use super::sheet::Sheet;
use crate::linalg::{Block, Frame, add_scaled, column, norm};
use crate::tolerance::{difference, hull, spacing, window};
use crate::{Real, State};
use nalgebra::SVector;

/// Directions that are tried where several loops are nearly singular at once.
const TRIALS: usize = 64;

/// Coordinates of the chart, time among them, up to which the change of the block along
/// each is kept: what it is along any direction then follows.
const FEW: usize = 4;

/// Share of the coordinates in a direction, below which nothing but time moves along it.
const STILL: f64 = 1e-3;

/// A line through a state along which the constraints leave a singular configuration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Direction<T, const N: usize> {
    /// The change of position along it, of length one in the metric.
    q: SVector<T, N>,
    /// The change of time along it (s).
    t: T,
    /// Whether nothing but time moves along it.
    pub(super) is_of_time: bool,
    /// Where the singular configuration is.
    pub(super) centre: T,
    /// How fast the sine changes.
    pub(super) rate: T,
}

impl<T: Real, const N: usize> Direction<T, N> {
    /// The state a distance along it.
    pub(super) fn moved(&self, state: &State<T, N>, distance: T) -> State<T, N> {
        State::new(
            state.t + self.t * distance,
            state.q + self.q * distance,
            state.v,
        )
    }
}

/// The best direction so far.
struct Best<T, const N: usize> {
    direction: Direction<T, N>,
    score: T,
}

impl<T: Real, const N: usize, const R: usize> Sheet<'_, T, N, R> {
    /// The best direction through a state whose frame is `like`.
    pub(super) fn direction(
        &mut self,
        state: &State<T, N>,
        like: &Frame<T, N, R>,
    ) -> Result<Direction<T, N>, Obstacle> {
        let clock = self.clock();
        let dimension = (self.chart.freedoms + usize::from(clock.is_some())).min(N);
        let mut best = None;
        if like.block().size == 1 {
            let steepest = self.steepest(state, like, dimension, clock)?;
            let direction = self.line(&steepest, clock);
            let change = self.change(state, like, &direction)?;
            self.consider(like.block(), direction, &change, &mut best);
        } else {
            self.try_directions(state, like, (dimension, clock), &mut best)?;
        }
        best.map(|best| best.direction).ok_or(Obstacle::Unresolved)
    }

    /// Judges directions that are spread evenly.
    #[inline(never)]
    fn try_directions(
        &mut self,
        state: &State<T, N>,
        like: &Frame<T, N, R>,
        (dimension, clock): (usize, Option<T>),
        best: &mut Option<Best<T, N>>,
    ) -> Result<(), Obstacle> {
        let mut kept: [Block<T, R>; FEW] = core::array::from_fn(|_| Block::zeros(0));
        if dimension <= FEW {
            for (i, kept) in kept[..dimension].iter_mut().enumerate() {
                let coordinate = self.line(&column(|k| unit(k == i)), clock);
                *kept = self.change(state, like, &coordinate)?;
            }
        }
        let mut change = Block::zeros(0);
        for trial in 0..if dimension > 1 { TRIALS } else { 1 } {
            let shares = spread_evenly(trial, dimension);
            let direction = self.line(&shares, clock);
            if dimension <= FEW {
                change.set_combination(&shares, &kept[..dimension]);
            } else {
                change = self.change(state, like, &direction)?;
            }
            self.consider(like.block(), direction, &change, best);
        }
        Ok(())
    }

    /// The time (s) in which the sheet moves by one unit of length when it is fastest;
    /// none if it rests.
    fn clock(&self) -> Option<T> {
        let speed = self.chart.speed;
        (speed > T::zero()).then(|| T::one() / speed)
    }

    /// A line along some coordinates of the chart, of which time may be the last.
    fn line(&self, shares: &[T; N], clock: Option<T>) -> Direction<T, N> {
        let mut q: SVector<T, N> = SVector::zeros();
        let columns = shares.iter().zip(&self.chart.tangent.data.0);
        for (share, column) in columns.take(self.chart.freedoms) {
            add_scaled(q.as_mut_slice(), *share, column);
        }
        let t = match (clock, shares.get(self.chart.freedoms)) {
            (Some(unit), Some(share)) => unit * *share,
            _ => T::zero(),
        };
        add_scaled(q.as_mut_slice(), t, self.chart.drift.as_slice());
        let others = &shares[..self.chart.freedoms.min(N)];
        Direction {
            q,
            t,
            is_of_time: t != T::zero() && norm_of(others) < T::from_f64(STILL),
            centre: T::zero(),
            rate: T::zero(),
        }
    }

    /// The direction of the first coordinate of the chart.
    pub(super) fn along_chart(&self) -> Direction<T, N> {
        self.line(&column(|k| unit(k == 0)), None)
    }

    /// Judges a direction along which the block changes: how fast its singular values do,
    /// and whether they pass zero near one place.
    fn consider(
        &self,
        here: &Block<T, R>,
        mut direction: Direction<T, N>,
        change: &Block<T, R>,
        best: &mut Option<Best<T, N>>,
    ) {
        // Where the block is diagonal, its last entries are those that nearly vanish, and
        // the others are those of rows that only might have.
        let (slopes, values) = change.in_bases_of(here);
        let values = &values[..here.size];
        let weak = values.iter().filter(|value| **value < window()).count();
        let weak = weak.max(1);
        let met = meeting(&slopes.last(weak), &values[here.size - weak..]);
        let Some((centre, rate)) = met else {
            return;
        };
        (direction.centre, direction.rate) = (centre, rate);
        let step = spacing::<T>() * self.chart.reach.min(T::one() / rate);
        if centre.abs() <= step * hull(SIDE) {
            let least = best.as_ref().map(|best| best.score);
            let score = clearance_of(here, change, (centre, step), least);
            if least.is_none_or(|least| score > least) {
                *best = Some(Best { direction, score });
            }
        }
    }

    /// The direction in which the one entry of the block changes fastest.
    #[inline(never)]
    fn steepest(
        &mut self,
        state: &State<T, N>,
        like: &Frame<T, N, R>,
        dimension: usize,
        clock: Option<T>,
    ) -> Result<[T; N], Obstacle> {
        let mut gradient = [T::zero(); N];
        for (i, entry) in gradient.iter_mut().enumerate().take(dimension) {
            let direction = self.line(&column(|k| unit(k == i)), clock);
            *entry = self.change(state, like, &direction)?.entries[0][0];
        }
        let size = norm(&gradient);
        // False for NaN, too.
        let changes = size > T::zero();
        match changes {
            true => Ok(column(|i| gradient[i] / size)),
            false => Err(Obstacle::Unresolved),
        }
    }

    /// The change of the block along a direction, by a one-sided difference: direction
    /// and spacing of the nodes are wanted to a few digits only.
    fn change(
        &mut self,
        state: &State<T, N>,
        like: &Frame<T, N, R>,
        direction: &Direction<T, N>,
    ) -> Result<Block<T, R>, Obstacle> {
        let distance = difference::<T>() * self.chart.reach;
        self.eliminate(&direction.moved(state, distance), Some(like))?;
        let difference = self.frame.block().plus(-T::one(), like.block());
        Ok(Block::zeros(difference.size).plus(T::one() / distance, &difference))
    }
}

/// Where the nearest of some singular values passes zero, and how fast the slowest of them
/// changes, to first order; none if one of them stays what it is.
#[inline(never)]
fn meeting<T: Real, const R: usize>(slopes: &Block<T, R>, values: &[T]) -> Option<(T, T)> {
    let mut nearest = T::from_f64(f64::INFINITY);
    for (i, value) in values.iter().enumerate() {
        let centre = -*value / slopes.entries[i][i];
        // False for NaN.
        if centre.abs() < nearest.abs() {
            nearest = centre;
        }
    }
    let rate = slopes.clone().smallest();
    (rate > T::zero() && nearest.is_finite()).then_some((nearest, rate))
}

fn unit<T: Real>(one: bool) -> T {
    if one { T::one() } else { T::zero() }
}

fn norm_of<T: Real>(shares: &[T]) -> T {
    shares.iter().fold(T::zero(), |sum, x| sum + *x * *x).sqrt()
}

/// Directions that fill the sphere evenly, by multiples of irrational numbers.
fn spread_evenly<T: Real, const N: usize>(trial: usize, dimension: usize) -> [T; N] {
    let mut vector = [T::zero(); N];
    for (i, entry) in vector[..dimension.min(N)].iter_mut().enumerate() {
        let root = ((i * i + 3 * i + 2) as f64 + 0.5).sqrt();
        *entry = T::from_f64(2.0 * ((trial + 1) as f64 * root % 1.0) - 1.0);
    }
    let size = norm(&vector);
    column(|i| vector[i] / size)
}

/// The smallest sine of nodes on both sides of a place, to first order; of no interest
/// where it is not above a score that another place has, and then only a bound of it.
fn clearance_of<T: Real, const R: usize>(
    here: &Block<T, R>,
    change: &Block<T, R>,
    (centre, step): (T, T),
    best: Option<T>,
) -> T {
    let sides = (1..=SIDE).flat_map(|k| [T::from_f64(k as f64), -T::from_f64(k as f64)]);
    let (mut least, mut there) = (T::one(), Block::zeros(0));
    for place in sides {
        if best.is_some_and(|best| least <= best) {
            break;
        }
        there.set_sum(here, centre + step * place, change);
        least = least.min(there.smallest());
    }
    least
}
