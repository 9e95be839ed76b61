//! Passages through singular configurations.
//!
//! In:  accepted steps, the chart at their start.
//! Out: [`Passage`]s: where the constraints become singular and the motion goes on to the
//!      other side.

use super::sheet::Sheet;
use crate::linalg::{Block, Frame};
use crate::{Mechanism, Real, State};

/// Passages that are kept of one step.
const ROOM: usize = 8;
/// Steps of the search for the time of a passage.
const MOST_STEPS: usize = 60;
/// Looks into a step.
const LOOKS: usize = 4;
/// The determinant is taken once more at this part of the step beside a look, to see how
/// fast it changes.
const MOMENT: f64 = 1e-4;
/// Loops that become singular within this part of a step do so at once.
const AT_ONCE: f64 = 1e-6;
/// A dip is looked into if the polynomial falls below this part of its ends.
const WORTH_A_LOOK: f64 = 0.25;
/// Halvings of the interval in which the determinant turns back.
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

/// What changes its sign where sheets cross.
#[derive(Clone)]
struct Signs<T, const R: usize> {
    block: Block<T, R>,
    /// That of the whole system vanishes where the constraints are singular and nowhere
    /// else: the tangent space turns by far less than a right angle within a step.
    determinant: T,
    negative: bool,
}

impl<T: Real, const R: usize> Signs<T, R> {
    fn of<const N: usize>(frame: &Frame<T, N, R>) -> Self {
        Self {
            block: frame.block().clone(),
            determinant: frame.determinant(),
            negative: frame.is_negative(),
        }
    }

    /// How many sheets were crossed. Blocks count them, and determinants tell whether
    /// their number is odd; a block also changes its sign where one of the rows before it
    /// loses its pivot.
    fn changes_from(&self, other: &Self) -> usize {
        let changes = self.block.sign_changes_from(&other.block);
        let odd = self.negative != other.negative;
        match (changes % 2 == 1) == odd {
            true => changes,
            false => usize::from(odd),
        }
    }
}

/// The start of a step: the order of elimination for all of its states, and the signs.
pub(crate) struct Reference<T, const N: usize, const R: usize> {
    like: Frame<T, N, R>,
    signs: Signs<T, R>,
}

/// A look into a step.
#[derive(Clone)]
struct Look<T, const R: usize> {
    t: T,
    signs: Signs<T, R>,
}

/// What is needed to look into a step.
struct View<'a, T, const N: usize, const R: usize> {
    like: Frame<T, N, R>,
    at: &'a dyn Fn(T) -> State<T, N>,
    start: T,
    length: T,
    regular: usize,
}

impl<M, T: Real, const N: usize, const R: usize> Sheet<'_, M, T, N, R>
where
    M: Mechanism<T, N, R> + ?Sized,
{
    /// What states of a step that begins here are compared with; `None` where the
    /// constraints can't be eliminated.
    pub(crate) fn reference(&mut self, start: &State<T, N>) -> Option<Reference<T, N, R>> {
        self.eliminate_widely(start).ok()?;
        Some(Reference {
            like: self.frame.clone(),
            signs: Signs::of(self.frame),
        })
    }

    /// How many sheets are crossed on the way to a state; `None` where that can't be told.
    pub(crate) fn sign_changes(
        &mut self,
        from: &Reference<T, N, R>,
        to: &State<T, N>,
    ) -> Option<usize> {
        self.eliminate(to, Some(&from.like)).ok()?;
        Some(Signs::of(self.frame).changes_from(&from.signs))
    }

    /// The passages of a step whose states are `at`, by its chart.
    pub(crate) fn passages(
        &mut self,
        (start, end): (&State<T, N>, &State<T, N>),
        at: &dyn Fn(T) -> State<T, N>,
        regular: usize,
    ) -> Found<T> {
        let mut found = Found::new();
        let Some(reference) = self.reference(start) else {
            return found;
        };
        let view = View {
            like: reference.like,
            at,
            start: start.t,
            length: end.t - start.t,
            regular,
        };
        let mut before: Option<(Look<T, R>, T)> = None;
        for k in 0..=LOOKS {
            let t = match k {
                LOOKS => end.t,
                _ => start.t + view.length * T::from_f64(k as f64 / LOOKS as f64),
            };
            let Some(here) = self.look(&view, t) else {
                continue;
            };
            let Some(rate) = self.rate(&view, &here) else {
                continue;
            };
            if let Some((before, rate_before)) = &before {
                match self.beyond(&view, (before, &here), [*rate_before, rate]) {
                    Some(middle) => {
                        self.between(&view, before, &middle, &mut found);
                        self.between(&view, &middle, &here, &mut found);
                    }
                    None => self.between(&view, before, &here, &mut found),
                }
            }
            before = Some((here, rate));
        }
        found
    }

    fn look(&mut self, view: &View<T, N, R>, t: T) -> Option<Look<T, R>> {
        self.eliminate(&(view.at)(t), Some(&view.like)).ok()?;
        let signs = Signs::of(self.frame);
        Some(Look { t, signs })
    }

    /// How fast the determinant changes where somebody looks (1/s).
    fn rate(&mut self, view: &View<T, N, R>, look: &Look<T, R>) -> Option<T> {
        let moment = view.length * T::from_f64(MOMENT);
        let beside = match look.t > view.start + moment {
            true => look.t - moment,
            false => look.t + moment,
        };
        self.eliminate(&(view.at)(beside), Some(&view.like)).ok()?;
        let change = look.signs.determinant - self.frame.determinant();
        Some(change / (look.t - beside))
    }

    /// Passages between two looks: one for each loop that becomes singular, unless several
    /// do so at once.
    fn between(
        &mut self,
        view: &View<T, N, R>,
        from: &Look<T, R>,
        to: &Look<T, R>,
        found: &mut Found<T>,
    ) {
        let changes = to.signs.changes_from(&from.signs);
        let at_once = to.t - from.t <= view.length * T::from_f64(AT_ONCE);
        let middle = match changes {
            0 => return,
            1 => None,
            _ if at_once => None,
            _ => self.look(view, (from.t + to.t) * T::from_f64(0.5)),
        };
        match middle {
            Some(middle) => {
                self.between(view, from, &middle, found);
                self.between(view, &middle, to, found);
            }
            None => self.pass(view, (from, to), changes, found),
        }
    }

    /// A passage of so many loops at once.
    fn pass(
        &mut self,
        view: &View<T, N, R>,
        (from, to): (&Look<T, R>, &Look<T, R>),
        changes: usize,
        found: &mut Found<T>,
    ) {
        let t = match from.signs.negative == to.signs.negative {
            true => (from.t + to.t) * T::from_f64(0.5),
            false => self.locate(view, from, to),
        };
        let sine = match self.look(view, t) {
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

    /// A look between two others, of equal signs, that is beyond a singular configuration,
    /// if there is one: by the cubic polynomial through the determinants and their rates,
    /// and then by bisection.
    fn beyond(
        &mut self,
        view: &View<T, N, R>,
        (from, to): (&Look<T, R>, &Look<T, R>),
        rates: [T; 2],
    ) -> Option<Look<T, R>> {
        if from.signs.negative != to.signs.negative {
            return None;
        }
        let sign = if from.signs.negative {
            -T::one()
        } else {
            T::one()
        };
        let span = to.t - from.t;
        let ends = [from, to].map(|look| sign * look.signs.determinant);
        let rates = rates.map(|rate| sign * rate * span);
        let dips = rates[0] < T::zero() && rates[1] > T::zero();
        let (mut x, lowest) = lowest_of_cubic(ends, rates);
        let worth_a_look = lowest <= ends[0].min(ends[1]) * T::from_f64(WORTH_A_LOOK);
        if !dips || !worth_a_look || to.signs.changes_from(&from.signs) > 0 {
            return None;
        }
        let (mut a, mut b) = (T::zero(), T::one());
        for _ in 0..DEEPENINGS {
            let look = self.look(view, from.t + span * x)?;
            if look.signs.negative != from.signs.negative {
                return Some(look);
            }
            // Towards where it falls.
            if sign * self.rate(view, &look)? > T::zero() {
                b = x;
            } else {
                a = x;
            }
            x = (a + b) * T::from_f64(0.5);
        }
        None
    }

    /// The time at which the determinant changes its sign, by the method of false position
    /// in its Illinois form.
    fn locate(&mut self, view: &View<T, N, R>, from: &Look<T, R>, to: &Look<T, R>) -> T {
        let (mut a, mut fa) = (from.t, from.signs.determinant);
        let (mut b, mut fb) = (to.t, to.signs.determinant);
        let half = T::from_f64(0.5);
        for _ in 0..MOST_STEPS {
            let width = (b - a).abs();
            if width <= T::EPSILON * a.abs().max(b.abs()) || fa == fb || fb == T::zero() {
                break;
            }
            let t = b - fb * (b - a) / (fb - fa);
            let Some(f) = self.look(view, t).map(|look| look.signs.determinant) else {
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
