//! Passages through singular configurations.
//!
//! In:  accepted steps, the chart at their start.
//! Out: [`Passage`]s: where the constraints become singular and the motion goes on to the
//!      other side.
//!
//! The determinant of the constraints with the duals of the tangent space changes its sign
//! there. It is sampled along the step. Between two samples of opposite signs the time is found
//! by a root finder; between two of equal signs the cubic polynomial through them and their
//! rates tells whether there may be two passages, which bisection looks for. Where several loops
//! become singular, the signs of the block of near-dependent rows count them, and the interval
//! is divided until there is one for each, or they are so close that they count as one.

use super::cubic::lowest_of_cubic;
use super::determinant_signs::DeterminantSigns;
use super::found::{Found, Passage, Searched};
use super::samples::{SAMPLES, Sample, Sampled};
use super::sheet::Sheet;
use crate::Real;
use crate::crossing::zero;
use crate::linalg::{Eliminated, Frame, Workspace};
use core::convert::Infallible;

/// Room that an elimination and all that follows from it take, in blocks of near-dependent rows.
const BLOCKS: usize = 6;
/// Parts of a step that are sampled, each no longer than the range of the coordinates, so that
/// not several singular configurations are passed between two samples.
const MOST_PARTS: usize = 64;
/// Constraint equations of a single loop in the plane.
const SINGLE: usize = 2;
/// The determinant is taken once more at this part of the step beside a time, to see how fast
/// it changes.
const MOMENT: f64 = 1e-4;
/// A dip may hold two passages if the polynomial falls below this part of its ends.
const DIP: f64 = 0.25;
/// Halvings of the interval in which the determinant turns back.
const DEEPENINGS: usize = 26;
/// Halvings after which the search is given up if the determinant would not reach zero even at
/// twice the rate at which it falls.
const DEEP: usize = 4;

/// The constraints at a time of a step, eliminated in one order for all times.
struct Elimination<'a, T> {
    t: T,
    signs: DeterminantSigns<'a, T>,
    /// The determinant of the whole system vanishes where the constraints are singular and
    /// nowhere else: the tangent space turns by far less than a right angle within a step.
    determinant: T,
    /// The logarithm of its size, which the determinant of many rows is too small to tell.
    logarithm: T,
}

impl<'a, T: Real> Elimination<'a, T> {
    fn with(t: T, signs: DeterminantSigns<'a, T>, frame: &mut Frame<'_, T>) -> Self {
        Self {
            t,
            determinant: frame.determinant(),
            logarithm: frame.log_volume(),
            signs,
        }
    }
}

/// A step, and the order of elimination.
struct Search<'a, T> {
    step: &'a Searched<'a, T>,
    like: Eliminated<'a, T>,
}

impl<T: Real> Sheet<'_, T> {
    /// Finds the passages of a step, by its chart.
    ///
    /// In a singular configuration itself the sign of the determinant is round-off. A step that
    /// ends there is searched up to the last sample that has a sign, and the next one from it.
    pub(super) fn passages(
        &mut self,
        step: &Searched<'_, T>,
        found: &mut Found<T>,
        workspace: &Workspace<'_, T>,
    ) {
        let (start, end) = (step.start.t, step.start.t + step.length);
        let (range, path) = (
            self.chart.coordinate_scale.range,
            self.path(step, workspace),
        );
        let parts = (1..MOST_PARTS).find(|n| path <= range * T::from_f64(*n as f64));
        let parts = parts.unwrap_or(MOST_PARTS);
        let mut before = self
            .open_sample(step, workspace)
            .map(|sample| (sample, None));
        let mut from = start;
        for k in 1..=parts {
            let to = start + step.length * T::from_f64(k as f64 / parts as f64);
            let sampled = self.samples(step, (from, to), workspace);
            self.search_among(step, sampled, &mut before, found, workspace);
            from = to;
        }
        let last = before.map(|(sample, _)| sample.t);
        found.open = last.filter(|last| *last < end);
    }

    /// Searches between consecutive samples; `before` is the last of the samples of earlier parts.
    fn search_among(
        &mut self,
        step: &Searched<'_, T>,
        sampled: [Sampled<T>; SAMPLES],
        before: &mut Option<(Sample<T>, Option<T>)>,
        found: &mut Found<T>,
        workspace: &Workspace<'_, T>,
    ) {
        for (sample, rate) in sampled {
            let Some(here) = sample else {
                continue;
            };
            if let Some((before, rate_before)) = &*before
                && before.t < here.t
            {
                let rates = [*rate_before, rate];
                self.search_between(step, (before, &here), rates, found, workspace);
            }
            *before = Some((here, rate));
        }
    }

    /// Searches between two positions of a step, where the determinant changes at these rates.
    fn search_between(
        &mut self,
        step: &Searched<'_, T>,
        (from, to): (&Sample<T>, &Sample<T>),
        rates: [Option<T>; 2],
        found: &mut Found<T>,
        workspace: &Workspace<'_, T>,
    ) {
        let falls = rates.map(|rate| rate.map(|rate| rate * from.determinant < T::zero()));
        let may_dip = falls[0] != Some(false) && falls[1] != Some(true);
        let passes = from.determinant.sign() != to.determinant.sign();
        // A single loop does not become singular twice at once.
        if self.constraints() <= SINGLE && !passes && !may_dip {
            return;
        }
        // An elimination at the position nearer to a singular configuration puts all rows last that
        // may turn against others in between; one at the farther position might miss two of them.
        let mut orders = [(from, to), (to, from)];
        if to.sine < from.sine {
            orders.swap(0, 1);
        }
        // In the order of elimination of the one, a pivot may be lost at the other.
        for ends in orders {
            let searched =
                workspace.scope(|inner| self.search_in_order(step, ends, rates, found, inner));
            if searched.is_some() {
                return;
            }
        }
    }

    /// Searches between two positions in the order of elimination of the first; `None` where the
    /// other can't be eliminated in it.
    fn search_in_order(
        &mut self,
        step: &Searched<'_, T>,
        (own, other): (&Sample<T>, &Sample<T>),
        rates: [Option<T>; 2],
        found: &mut Found<T>,
        workspace: &Workspace<'_, T>,
    ) -> Option<()> {
        let q = workspace.numbers(self.chart.n());
        step.position(own.t, q);
        let reference = self.reference(own.t, q, workspace)?;
        let like = reference.like;
        let own = Elimination::with(own.t, reference.signs, &mut self.frame);
        let search = Search { step, like };
        let other = self.eliminated_at(&search, other.t, workspace)?;
        let (from, to) = match own.t < other.t {
            true => (&own, &other),
            false => (&other, &own),
        };
        // Signs are compared with those at the end that is farther from singular configurations:
        // two positions next to one, each nearer to that of another loop, tell nothing together.
        let (base, [before, after]) = match from.logarithm >= to.logarithm {
            true => (
                &from.signs,
                [0, to.signs.changes_from(&from.signs, workspace)],
            ),
            false => (
                &to.signs,
                [from.signs.changes_from(&to.signs, workspace), 0],
            ),
        };
        let ends = [(from, before), (to, after)];
        let middle = match before.max(after) {
            0 => self.find_double(&search, (from, to), rates, workspace),
            _ => None,
        };
        match middle {
            Some(middle) => {
                let changes = middle.signs.changes_from(base, workspace);
                let middle = (&middle, changes);
                self.find_of_loops(&search, base, [ends[0], middle], found, workspace);
                self.find_of_loops(&search, base, [middle, ends[1]], found, workspace);
            }
            None => self.find_of_loops(&search, base, ends, found, workspace),
        }
        Some(())
    }

    /// Passages between two times. Those of different loops that happen at once are one, also where
    /// a division of the interval came to lie between them.
    fn find_of_loops(
        &mut self,
        search: &Search<'_, T>,
        base: &DeterminantSigns<'_, T>,
        ends: [(&Elimination<'_, T>, usize); 2],
        found: &mut Found<T>,
        workspace: &Workspace<'_, T>,
    ) {
        if ends[0].1.abs_diff(ends[1].1) < 2 {
            return self.find_between(search, base, ends, false, found, workspace);
        }
        let mut of_loops = Found::new(search.step);
        self.find_between(search, base, ends, false, &mut of_loops, workspace);
        found.add(&of_loops, self.constraints());
    }

    /// Eliminates the constraints at a time within a step.
    fn eliminate_at(
        &mut self,
        search: &Search<'_, T>,
        t: T,
        workspace: &Workspace<'_, T>,
    ) -> Option<()> {
        workspace.scope(|workspace| {
            let q = workspace.numbers(self.chart.n());
            search.step.position(t, q);
            self.eliminate((t, q), Some(&search.like)).ok()
        })
    }

    fn eliminated_at<'b>(
        &mut self,
        search: &Search<'_, T>,
        t: T,
        workspace: &Workspace<'b, T>,
    ) -> Option<Elimination<'b, T>> {
        self.eliminate_at(search, t, workspace)?;
        let signs = DeterminantSigns::of(&mut self.frame, workspace);
        Some(Elimination::with(t, signs, &mut self.frame))
    }

    /// The determinant at a time within a step.
    fn determinant_at(
        &mut self,
        search: &Search<'_, T>,
        t: T,
        workspace: &Workspace<'_, T>,
    ) -> Option<T> {
        self.eliminate_at(search, t, workspace)?;
        Some(self.frame.determinant())
    }

    /// How fast the determinant changes at a time of the step (1/s).
    fn rate(
        &mut self,
        search: &Search<'_, T>,
        (t, determinant): (T, T),
        workspace: &Workspace<'_, T>,
    ) -> Option<T> {
        let moment = search.step.length * T::from_f64(MOMENT);
        let beside = match t > search.step.start.t + moment {
            true => t - moment,
            false => t + moment,
        };
        let change = determinant - self.determinant_at(search, beside, workspace)?;
        Some(change / (t - beside))
    }

    /// Passages between two times, at which so many signs differ from those of a base: one for each
    /// loop that becomes singular, unless several do so at once. The interval is divided in the
    /// middle if `halve` says so.
    fn find_between(
        &mut self,
        search: &Search<'_, T>,
        base: &DeterminantSigns<'_, T>,
        [(from, changes_from), (to, changes_to)]: [(&Elimination<'_, T>, usize); 2],
        halve: bool,
        found: &mut Found<T>,
        workspace: &Workspace<'_, T>,
    ) {
        let changes = changes_to.abs_diff(changes_from);
        let (width, half) = (to.t - from.t, T::from_f64(0.5));
        let at_once = search.step.at_once();
        let middle = match changes {
            0 => return,
            1 => None,
            _ if width <= at_once => None,
            _ if halve => Some((from.t + to.t) * half),
            _ => Some(estimate_multiple(from, to, changes, at_once)),
        };
        // An elimination in the middle, and those of both halves, need room for a few blocks.
        let size = search.like.block().size();
        let room = BLOCKS * size * size + self.chart.n();
        let middle = middle.filter(|_| workspace.has_room(room));
        workspace.scope(|workspace| {
            let middle = middle.and_then(|t| self.eliminated_at(search, t, workspace));
            let Some(middle) = middle else {
                self.record(search, (from, to), changes, found, workspace);
                return;
            };
            let changes = middle.signs.changes_from(base, workspace);
            let middle = (&middle, changes);
            for ends in [[(from, changes_from), middle], [middle, (to, changes_to)]] {
                let slow = ends[1].0.t - ends[0].0.t > width * half;
                self.find_between(search, base, ends, slow, found, workspace);
            }
        });
    }

    /// Records a passage of so many loops at once.
    fn record(
        &mut self,
        search: &Search<'_, T>,
        (from, to): (&Elimination<'_, T>, &Elimination<'_, T>),
        changes: usize,
        found: &mut Found<T>,
        workspace: &Workspace<'_, T>,
    ) {
        let t = match from.signs.negative == to.signs.negative {
            true => (from.t + to.t) * T::from_f64(0.5),
            false => self.locate(search, from, to, workspace),
        };
        let sine = match self.eliminate_at(search, t, workspace) {
            Some(()) => self.frame.smallest(),
            None => T::zero(),
        };
        let regular = self.constraints();
        let rank = match self.rank_of_all_rows(workspace) {
            Some(rank) if rank == regular || !self.all_depend(search.step, t, workspace) => return,
            Some(rank) => rank,
            None => regular - changes.min(regular),
        };
        found.push(Passage {
            t,
            sine,
            rank,
            regular,
        });
    }

    /// An elimination beyond a singular configuration, between two others of equal signs, if there
    /// is one. It is sought by the cubic polynomial through the determinants and their rates,
    /// which are taken where they are not known, and then by bisection.
    fn find_double<'b>(
        &mut self,
        search: &Search<'_, T>,
        (from, to): (&Elimination<'_, T>, &Elimination<'_, T>),
        rates: [Option<T>; 2],
        workspace: &Workspace<'b, T>,
    ) -> Option<Elimination<'b, T>> {
        let mut rate = |known: Option<T>, end: &Elimination<'_, T>| {
            known.or_else(|| self.rate(search, (end.t, end.determinant), workspace))
        };
        let rates = [rate(rates[0], from)?, rate(rates[1], to)?];
        let sign = if from.signs.negative {
            -T::one()
        } else {
            T::one()
        };
        let span = to.t - from.t;
        let ends = [from, to].map(|end| sign * end.determinant);
        let rates = rates.map(|rate| sign * rate * span);
        let (mut x, lowest) = lowest_of_cubic(ends, rates)?;
        let is_deep = lowest <= ends[0].min(ends[1]) * T::from_f64(DIP);
        if !is_deep {
            return None;
        }
        let (mut a, mut b) = (T::zero(), T::one());
        for deepening in 0..DEEPENINGS {
            let t = from.t + span * x;
            let middle = self.eliminated_at(search, t, workspace)?;
            if middle.signs.negative != from.signs.negative {
                return self.is_told(search, &middle, workspace).then_some(middle);
            }
            let rate = sign * self.rate(search, (t, middle.determinant), workspace)?;
            // The search goes on in the half into which the determinant falls.
            if rate > T::zero() {
                b = x;
            } else {
                a = x;
            }
            let fall = rate.abs() * span * (b - a);
            if deepening >= DEEP && fall * T::from_f64(2.0) < sign * middle.determinant {
                return None;
            }
            x = (a + b) * T::from_f64(0.5);
        }
        None
    }

    /// Whether the sign of a determinant within a step, whose frame is at hand, is that of the
    /// motion: beyond a singular configuration by more than what the inside of a step may be off,
    /// whose error along a sheet leaves no constraint error.
    fn is_told(
        &mut self,
        search: &Search<'_, T>,
        there: &Elimination<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> bool {
        workspace.scope(|workspace| {
            let q = workspace.numbers(self.chart.n());
            search.step.position(there.t, q);
            let sine = self.frame.smallest();
            sine > search.step.unseen() && self.tells(sine, there.determinant, (there.t, q))
        })
    }

    /// The time at which the determinant changes its sign.
    fn locate(
        &mut self,
        search: &Search<'_, T>,
        from: &Elimination<'_, T>,
        to: &Elimination<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> T {
        // The determinant can't be told in the singular configuration itself: there it is zero.
        let mut determinant = |t| {
            let determinant = self.determinant_at(search, t, workspace);
            Ok::<_, Infallible>(determinant.unwrap_or_default())
        };
        let ends = [from, to].map(|end| (end.t, end.determinant));
        let Ok(t) = zero(&mut determinant, ends[0], ends[1]);
        t
    }
}

/// A time close to where so many loops become singular, if they do so at once: the determinant then
/// vanishes like that power of the time. It is put a little farther from the nearer end, so that
/// the shorter part holds the zero.
fn estimate_multiple<T: Real>(
    from: &Elimination<'_, T>,
    to: &Elimination<'_, T>,
    loops: usize,
    at_once: T,
) -> T {
    let ratio = (to.logarithm - from.logarithm) / T::from_f64(loops as f64);
    let (width, little) = (to.t - from.t, at_once * T::from_f64(0.25));
    let to_nearer = width / (T::one() + ratio.abs().exp());
    // False where either determinant is zero.
    match to_nearer.is_finite() {
        true if ratio >= T::zero() => from.t + to_nearer + little,
        true => to.t - to_nearer - little,
        false => from.t + width * T::from_f64(0.5),
    }
}
