//! Where a run passed singular positions.
//!
//! In:  steps.
//! Out: [`Passage`]s, located within the steps.
//!
//! The sine by which the weakest constraint is independent goes to zero at a
//! singular position, linearly in time on both sides. Wherever it has a minimum
//! between looks and is small, the minimum is searched on the interpolants.

use super::{Observer, Probe};
use crate::{DynamicsError, Real, State, Step};
use core::ops::ControlFlow;

/// Minima of the sine above this aren't looked into.
const NEAR: f64 = 0.3;
/// A minimum of the sine below this is a passage through a singular position.
const PASSAGE: f64 = 1e-3;
/// Steps of the search: each shortens the bracket to 0.618 of its length, so
/// that the time is found to about 1e-8 of the distance between two looks.
const SEARCH_STEPS: usize = 38;

/// A passage through a singular position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage<T> {
    /// When (s).
    pub t: T,
    /// The smallest sine that was found, nearly zero.
    pub sine: T,
    /// How many constraint equations are independent there.
    pub rank: usize,
    /// How many are at regular positions.
    pub regular: usize,
}

/// Finds the passages of a run through singular positions.
#[derive(Clone, Debug)]
pub struct RankAudit<T, const N: usize> {
    /// Time and sine at the last two looks.
    looks: [(T, T); 2],
    /// The step before this one, if its end is near a singular position.
    previous: Option<Step<T, N>>,
    count: u64,
    last: Option<Passage<T>>,
    smallest: T,
}

impl<T: Real, const N: usize> Default for RankAudit<T, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real, const N: usize> RankAudit<T, N> {
    /// Nothing seen yet.
    pub fn new() -> Self {
        let nothing = (T::zero(), T::zero());
        Self {
            looks: [nothing; 2],
            previous: None,
            count: 0,
            last: None,
            smallest: T::one(),
        }
    }

    /// How many passages there were.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The last passage.
    pub fn last(&self) -> Option<&Passage<T>> {
        self.last.as_ref()
    }

    /// The smallest sine at any look or passage: how near the run came to a
    /// singular position.
    pub fn smallest(&self) -> T {
        self.smallest
    }

    /// Begins at the initial state.
    ///
    /// # Errors
    ///
    /// What the probe reports.
    pub fn start(
        &mut self,
        state: &State<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        *self = Self::new();
        let sine = probe.rank(state)?.sine;
        self.smallest = sine;
        self.looks = [(state.t, sine); 2];
        Ok(())
    }

    /// Looks at a step and calls `found` with each passage.
    ///
    /// # Errors
    ///
    /// What the probe reports.
    pub fn look(
        &mut self,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
        found: &mut dyn FnMut(&Passage<T>),
    ) -> Result<(), DynamicsError<T>> {
        for t in step.look_times() {
            let here = (t, probe.rank(&step.at(t))?.sine);
            let [before, middle] = self.looks;
            self.smallest = self.smallest.min(here.1);
            let lowest = middle.1 <= before.1 && middle.1 < here.1 && middle.0 > before.0;
            if lowest && middle.1 < T::from_f64(NEAR) {
                let passage = self.search(step, probe, before.0, here.0)?;
                self.smallest = self.smallest.min(passage.sine);
                if passage.sine < T::from_f64(PASSAGE) {
                    self.count += 1;
                    self.last = Some(passage);
                    found(&passage);
                }
            }
            self.looks = [middle, here];
        }
        self.remember(step);
        Ok(())
    }

    /// Keeps a step whose last look may turn out to be next to a minimum.
    fn remember(&mut self, step: &Step<T, N>) {
        let near = self.looks[1].1 < T::from_f64(NEAR);
        match (&mut self.previous, near) {
            (Some(previous), true) => previous.clone_from(step),
            (previous @ None, true) => *previous = Some(step.clone()),
            (previous, false) => *previous = None,
        }
    }

    /// Golden-section search for the smallest sine between two times of this
    /// step and the one before.
    fn search(
        &self,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
        from: T,
        to: T,
    ) -> Result<Passage<T>, DynamicsError<T>> {
        let state = |t: T| match &self.previous {
            Some(previous) if t < step.start().t => previous.at(t),
            _ => step.at(t),
        };
        let mut sine = |t: T| probe.rank(&state(t)).map(|rank| rank.sine);
        let golden = (T::from_f64(5.0).sqrt() - T::one()) / T::from_f64(2.0);
        let (mut low, mut high) = (from, to);
        let mut left = high - (high - low) * golden;
        let mut right = low + (high - low) * golden;
        let (mut at_left, mut at_right) = (sine(left)?, sine(right)?);
        for _ in 0..SEARCH_STEPS {
            if at_left < at_right {
                (high, right, at_right) = (right, left, at_left);
                left = high - (high - low) * golden;
                at_left = sine(left)?;
            } else {
                (low, left, at_left) = (left, right, at_right);
                right = low + (high - low) * golden;
                at_right = sine(right)?;
            }
        }
        let t = if at_left < at_right { left } else { right };
        let rank = probe.rank(&state(t))?;
        Ok(Passage {
            t,
            sine: rank.sine,
            rank: rank.rank,
            regular: rank.regular,
        })
    }
}

impl<T: Real, const N: usize> Observer<T, N> for RankAudit<T, N> {
    fn begin(
        &mut self,
        state: &State<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        self.start(state, probe)?;
        Ok(ControlFlow::Continue(()))
    }

    fn step(
        &mut self,
        step: &Step<T, N>,
        probe: &mut dyn Probe<T, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<T>> {
        self.look(step, probe, &mut |_| ())?;
        Ok(ControlFlow::Continue(()))
    }
}
