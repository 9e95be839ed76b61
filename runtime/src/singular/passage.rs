//! Passages through singular configurations.
//!
//! In:  accepted steps, the chart at their start.
//! Out: [`Passage`]s: where the block of near-dependent rows changes its sign.

use super::sheet::Sheet;
use crate::linalg::{Block, Frame, dot};
use crate::{Mechanism, Real, State};

/// Passages that are kept of one step.
const ROOM: usize = 8;
/// Steps of the search for the time of a passage.
const MOST_STEPS: usize = 60;
/// Looks into a step.
const LOOKS: usize = 4;
/// A row is looked at once more after this part of the step, to see how fast it changes.
const MOMENT: f64 = 1e-4;
/// A dip is looked into if the polynomial falls below this part of its ends.
const WORTH_A_LOOK: f64 = 0.25;
/// Halvings of the interval in which a row turns back.
const DEEPENINGS: usize = 26;
/// Places at which a polynomial is evaluated.
const SAMPLES: usize = 16;

/// A passage through a singular configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage<T> {
    /// When (s).
    pub t: T,
    /// The sine by which the weakest constraint is independent there: nearly zero.
    pub sine: T,
    /// How many constraint equations are independent there.
    pub rank: usize,
    /// How many are at regular configurations.
    pub regular: usize,
}

/// The passages of one step.
#[derive(Clone, Debug)]
pub(crate) struct Found<T> {
    list: [Option<Passage<T>>; ROOM],
    count: usize,
}

impl<T: Real> Found<T> {
    pub(crate) fn new() -> Self {
        Self {
            list: [None; ROOM],
            count: 0,
        }
    }

    pub(crate) fn clear(&mut self) {
        for passage in self.list.iter_mut().take(self.count) {
            *passage = None;
        }
        self.count = 0;
    }

    /// In the order of time.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Passage<T>> {
        self.list.iter().flatten()
    }

    fn push(&mut self, passage: Passage<T>) {
        if let Some(place) = self.list.get_mut(self.count) {
            *place = Some(passage);
            self.count += 1;
        }
    }
}

/// The block of near-dependent rows at a time of a step, and a little later.
#[derive(Clone)]
struct Look<T, const R: usize> {
    t: T,
    signs: Signs<T, R>,
    later: Block<T, R>,
}

/// What changes its sign where sheets cross.
#[derive(Clone)]
struct Signs<T, const R: usize> {
    block: Block<T, R>,
    /// That of the whole determinant: a step so long that no row was nearly dependent at
    /// its start shows in it all the same.
    negative: bool,
}

impl<T: Real, const R: usize> Signs<T, R> {
    fn of<const N: usize>(frame: &Frame<T, N, R>) -> Self {
        Self {
            block: frame.block().clone(),
            negative: frame.is_negative(),
        }
    }

    fn changes_from(&self, other: &Self) -> usize {
        let changes = self.block.sign_changes_from(&other.block);
        let odd = self.negative != other.negative;
        match changes {
            0 => usize::from(odd),
            changes => changes,
        }
    }
}

/// What is needed to look into a step.
struct View<'a, T, const N: usize, const R: usize> {
    like: Frame<T, N, R>,
    at: &'a dyn Fn(T) -> State<T, N>,
    /// How much later a look is taken once more.
    moment: T,
    regular: usize,
}

impl<M, T: Real, const N: usize, const R: usize> Sheet<'_, M, T, N, R>
where
    M: Mechanism<T, N, R> + ?Sized,
{
    /// How many eigenvalues of the block change their sign from one state to another;
    /// `None` where the blocks cannot be compared.
    pub(crate) fn sign_changes(&mut self, from: &State<T, N>, to: &State<T, N>) -> Option<usize> {
        self.eliminate_widely(from).ok()?;
        let like = self.frame.clone();
        let before = Signs::of(&like);
        self.eliminate(to, Some(&like)).ok()?;
        Some(Signs::of(self.frame).changes_from(&before))
    }

    /// The passages of a step whose states are `at`, by its chart.
    pub(crate) fn passages(
        &mut self,
        (start, end): (&State<T, N>, &State<T, N>),
        at: &dyn Fn(T) -> State<T, N>,
        regular: usize,
    ) -> Found<T> {
        let mut found = Found::new();
        if self.eliminate_widely(start).is_err() {
            return found;
        }
        let length = end.t - start.t;
        let view = View {
            like: self.frame.clone(),
            at,
            moment: length * T::from_f64(MOMENT),
            regular,
        };
        let Some(mut before) = self.look(&view, start.t) else {
            return found;
        };
        for k in 1..=LOOKS {
            let t = match k {
                LOOKS => end.t - view.moment,
                _ => start.t + length * T::from_f64(k as f64 / LOOKS as f64),
            };
            if let Some(here) = self.look(&view, t) {
                self.between(&view, &before, &here, &mut found);
                before = here;
            }
        }
        if let Some(signs) = self.signs_at(&view, end.t) {
            let later = signs.block.clone();
            let last = Look {
                t: end.t,
                signs,
                later,
            };
            if last.signs.changes_from(&before.signs) > 0 {
                self.turn(&view, &before, &last, &mut found);
            }
        }
        found
    }

    fn look(&mut self, view: &View<T, N, R>, t: T) -> Option<Look<T, R>> {
        let signs = self.signs_at(view, t)?;
        let later = self.signs_at(view, t + view.moment)?.block;
        Some(Look { t, signs, later })
    }

    /// Passages between two looks: one where signs change, two where a row comes back
    /// from beyond the singular configuration.
    fn between(
        &mut self,
        view: &View<T, N, R>,
        from: &Look<T, R>,
        to: &Look<T, R>,
        found: &mut Found<T>,
    ) {
        if to.signs.changes_from(&from.signs) > 0 {
            return self.turn(view, from, to, found);
        }
        for row in 0..from.signs.block.size {
            let Some(middle) = self.deepest(view, row, from, to) else {
                continue;
            };
            self.turn(view, from, &middle, found);
            self.turn(view, &middle, to, found);
            return;
        }
    }

    /// A passage between two looks of different sign.
    fn turn(
        &mut self,
        view: &View<T, N, R>,
        from: &Look<T, R>,
        to: &Look<T, R>,
        found: &mut Found<T>,
    ) {
        let changes = to.signs.changes_from(&from.signs);
        let t = match to.signs.block.sign_changes_from(&from.signs.block) {
            0 => self.halve(view, from, to),
            _ => self.locate(view, from, to),
        };
        let sine = match self.signs_at(view, t) {
            Some(_) => self.frame.smallest(),
            None => T::zero(),
        };
        found.push(Passage {
            t,
            sine,
            rank: view.regular - changes.min(view.regular),
            regular: view.regular,
        });
    }

    fn signs_at(&mut self, view: &View<T, N, R>, t: T) -> Option<Signs<T, R>> {
        self.eliminate(&(view.at)(t), Some(&view.like)).ok()?;
        Some(Signs::of(self.frame))
    }

    /// The time at which the determinant changes its sign.
    fn halve(&mut self, view: &View<T, N, R>, from: &Look<T, R>, to: &Look<T, R>) -> T {
        let (mut before, mut after) = (from.t, to.t);
        for _ in 0..MOST_STEPS {
            let middle = (before + after) * T::from_f64(0.5);
            match self.signs_at(view, middle) {
                Some(signs) if signs.negative == from.signs.negative => before = middle,
                _ => after = middle,
            }
        }
        after
    }

    /// The look at which a row is deepest beyond the singular configuration, between two
    /// looks before it, if it is beyond it at all: by the cubic polynomial through values
    /// and rates, and then by parabolas.
    fn deepest(
        &mut self,
        view: &View<T, N, R>,
        row: usize,
        from: &Look<T, R>,
        to: &Look<T, R>,
    ) -> Option<Look<T, R>> {
        let reference = from.signs.block.entries[row];
        let value = |block: &Block<T, R>| dot(&block.entries[row], &reference);
        let span = to.t - from.t;
        let rate =
            |look: &Look<T, R>| (value(&look.later) - value(&look.signs.block)) / view.moment;
        let ends = [value(&from.signs.block), value(&to.signs.block)];
        let rates = [rate(from) * span, rate(to) * span];
        let dips = rates[0] < T::zero() && rates[1] > T::zero();
        let lowest = lowest_of_cubic(ends, rates);
        if !dips || lowest.1 > ends[0].min(ends[1]) * T::from_f64(WORTH_A_LOOK) {
            return None;
        }
        let (mut a, mut b) = (T::zero(), T::one());
        let mut x = lowest.0;
        for _ in 0..DEEPENINGS {
            let look = self.look(view, from.t + span * x)?;
            if value(&look.signs.block) < T::zero() {
                return Some(look);
            }
            // Towards where it falls.
            if rate(&look) > T::zero() {
                b = x;
            } else {
                a = x;
            }
            x = (a + b) * T::from_f64(0.5);
        }
        None
    }

    /// The time at which a row of the block turns against what it was before, by the
    /// method of false position in its Illinois form.
    fn locate(&mut self, view: &View<T, N, R>, from: &Look<T, R>, to: &Look<T, R>) -> T {
        let (first, last) = (&from.signs.block, &to.signs.block);
        let row = turning_row(first, last);
        let value = |block: &Block<T, R>| dot(&block.entries[row], &first.entries[row]);
        let (mut a, mut fa) = (from.t, value(first));
        let (mut b, mut fb) = (to.t, value(last));
        let half = T::from_f64(0.5);
        for _ in 0..MOST_STEPS {
            let width = (b - a).abs();
            if width <= T::EPSILON * a.abs().max(b.abs()) || fa == fb || fb == T::zero() {
                break;
            }
            let t = b - fb * (b - a) / (fb - fa);
            let Some(f) = self.signs_at(view, t).map(|signs| value(&signs.block)) else {
                break;
            };
            if (f < T::zero()) != (fb < T::zero()) {
                (a, fa) = (b, fb);
            } else {
                fa *= half;
            }
            let moved = (t - b).abs();
            (b, fb) = (t, f);
            if moved <= T::EPSILON * t.abs() {
                break;
            }
        }
        b
    }
}

/// Where a cubic polynomial on [0, 1] with these values and rates at the ends is lowest,
/// and its value there.
fn lowest_of_cubic<T: Real>(ends: [T; 2], rates: [T; 2]) -> (T, T) {
    let number = T::from_f64;
    let value = |x: T| {
        let rest = T::one() - x;
        ends[0] * rest * rest * (T::one() + number(2.0) * x)
            + ends[1] * x * x * (T::one() + number(2.0) * rest)
            + rates[0] * x * rest * rest
            - rates[1] * x * x * rest
    };
    let samples = (1..SAMPLES).map(|k| number(k as f64 / SAMPLES as f64));
    samples.fold((number(0.5), value(number(0.5))), |lowest, x| {
        let here = value(x);
        if here < lowest.1 { (x, here) } else { lowest }
    })
}

/// The row that turns most between two blocks.
fn turning_row<T: Real, const R: usize>(from: &Block<T, R>, to: &Block<T, R>) -> usize {
    let value = |row: usize| dot(&from.entries[row], &to.entries[row]);
    let lower = |best: usize, row: usize| if value(row) < value(best) { row } else { best };
    (0..from.size).fold(0, lower)
}
