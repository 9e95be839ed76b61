//! What the last accepted state taught.
//!
//! In:  accepted states.
//! Out: [`Session`]: the chart of the sheet, where there is need of one, and how near the
//!      constraints came to losing rank.
//!
//! Trial states change nothing here but what is forgotten together with the trial.

use super::chart::Chart;
use super::point::Met;
use super::stored_nodes::Nodes;
use crate::tolerance::{passes, window};
use crate::{Real, State};
use nalgebra::SVector;

/// What is known since the last accepted state.
#[derive(Clone, Debug)]
pub(crate) struct Session<T, const N: usize, const R: usize> {
    /// The last accepted state.
    pub(crate) base: Option<State<T, N>>,
    /// It begins the motion, and need not be on the constraints.
    pub(crate) begins: bool,
    /// The chart of the sheet there; none where the constraints are safely regular.
    pub(crate) chart: Option<Chart<T, N, R>>,
    /// The chart of the last accepted step, by which its passages are found.
    pub(crate) step_chart: Option<Chart<T, N, R>>,
    /// The mechanism rests in a singular configuration, where nothing tells which sheet
    /// is meant, and stays.
    pub(crate) at_rest: bool,
    /// The next step may come near a singular configuration.
    pub(crate) near: bool,
    /// The rows that emitted code solves with came near dependence where others did not.
    pub(crate) chooses_rows: bool,
    /// The sine of the constraints at the last accepted state.
    pub(crate) sine: Option<T>,
    /// By how much it fell or grew in the last step (1/s).
    pub(crate) rate: T,
    /// What the trial step at hand came to.
    pub(crate) trial: Trial<T, N, R>,
    /// The nodes of the last interpolation.
    pub(crate) nodes: Nodes<T, N>,
    /// Accepted error of a step, relative; none for fixed steps.
    pub(crate) tolerance: Option<T>,
    /// When and where the search for passages was left open.
    pub(crate) open_search: Option<(T, SVector<T, N>)>,
}

/// What a trial step came to.
#[derive(Clone, Debug)]
pub(crate) struct Trial<T, const N: usize, const R: usize> {
    /// The smallest squared sine of its states.
    pub(crate) lowest: T,
    /// The squared sine at its end.
    pub(crate) end: T,
    /// The step after it may come near a singular configuration.
    pub(crate) near: bool,
    /// By how much the sine fell or grew in it (1/s).
    pub(crate) rate: T,
    /// A state came so near to a singular configuration that a chart is needed.
    pub(crate) wants_chart: bool,
    /// The chart at its end.
    pub(crate) chart: Option<Chart<T, N, R>>,
    /// The chart by which a long step without one of its own was inspected for crossings.
    pub(crate) inspection_chart: Option<Chart<T, N, R>>,
    /// The end's tangent space, drift, and how the sheets were met there.
    pub(crate) placed: Option<Placed<T, N>>,
    /// The state that was projected last was moved past another sheet, by more than the end of a
    /// step may be off.
    pub(crate) strays: bool,
    /// Emitted code projected its end.
    pub(crate) by_emitted: bool,
    /// Its end was projected by corrections that are not small.
    pub(crate) is_moved: bool,
    /// Some state of it lies next to a configuration where sheets were seen to cross.
    pub(crate) crosses: bool,
}

/// The end of a trial step on its sheet.
#[derive(Clone, Debug)]
pub(crate) struct Placed<T, const N: usize> {
    pub(crate) tangent: nalgebra::SMatrix<T, N, N>,
    pub(crate) drift: SVector<T, N>,
    pub(crate) met: [Met<T>; N],
    /// Whether it was moved past another sheet, by more than the placement may be off.
    pub(crate) leaves: bool,
}

impl<T: Real, const N: usize, const R: usize> Trial<T, N, R> {
    pub(crate) fn new() -> Self {
        Self {
            lowest: T::one(),
            end: T::one(),
            near: false,
            rate: T::zero(),
            wants_chart: false,
            chart: None,
            inspection_chart: None,
            placed: None,
            strays: false,
            by_emitted: false,
            is_moved: false,
            crosses: false,
        }
    }

    fn forget(&mut self) {
        self.lowest = T::one();
        self.end = T::one();
        self.near = false;
        self.rate = T::zero();
        self.wants_chart = false;
        self.chart = None;
        self.inspection_chart = None;
        self.placed = None;
        self.by_emitted = false;
        self.is_moved = false;
        self.crosses = false;
    }
}

impl<T: Real, const N: usize, const R: usize> Session<T, N, R> {
    pub(crate) fn new() -> Self {
        Self {
            base: None,
            begins: true,
            chart: None,
            step_chart: None,
            at_rest: false,
            near: false,
            chooses_rows: false,
            sine: None,
            rate: T::zero(),
            trial: Trial::new(),
            nodes: Nodes::new(),
            tolerance: None,
            open_search: None,
        }
    }

    /// Begins at a state of which nothing is known.
    ///
    /// Charts are large, so that what is forgotten is not overwritten.
    pub(crate) fn begin(&mut self, state: &State<T, N>) {
        self.base = Some(*state);
        self.begins = true;
        self.chart = None;
        self.step_chart = None;
        self.at_rest = false;
        self.near = false;
        self.chooses_rows = false;
        self.sine = None;
        self.rate = T::zero();
        self.trial.forget();
        self.nodes.forget();
        self.open_search = None;
    }

    /// Takes note of the squared sine of the constraints at a state of the trial step.
    #[inline]
    pub(crate) fn observe(&mut self, state: &State<T, N>, squared: T) {
        if squared <= self.trial.lowest {
            self.trial.lowest = squared;
            if self.sine.is_none() {
                self.observe_start(state, squared);
            }
        }
    }

    /// The sine at the start of a motion is what the first stage of its first step shows.
    #[cold]
    fn observe_start(&mut self, state: &State<T, N>, squared: T) {
        let is_start = |base: &State<T, N>| base.t == state.t && base.q.data.0 == state.q.data.0;
        if self.base.as_ref().is_some_and(is_start) && passes(squared, window()) {
            self.sine = Some(squared.sqrt());
        }
    }
}
