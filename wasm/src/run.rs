//! A run in one call.
//!
//! In:  steps.
//! Out: rows, one after the other in one place, and what happened when, in another.
//!
//! Where one of the places is full, the run ends, to be gone on with when they have been
//! read: at the end of a step away from singular positions if there is one in time, since
//! the passage through a singular position belongs to one piece.

use crate::row::Columns;
use bricard_runtime::{
    DynamicsError, Grid, Observer, Occurrence, Origin, Passage, Probe, State, Step,
};
use core::ops::ControlFlow;

/// Passages and events of a piece that there is room for.
const MOST_MARKS: usize = 1000;
/// So many that come at once there is always room for: the events of a mechanism, 64 at most,
/// and the passages of a step.
const AT_ONCE: usize = 100;
/// Constraints that are independent by more than this sine are away from singular positions.
const CALM_SINE: f64 = 0.3;
/// The part of a place that is left for steps near singular positions.
const SPARE: usize = 8;
/// What is left of the last interval between rows is round-off up to this part of it, or of
/// the run, if that is shorter.
const SHORT: f64 = 1e-9;

/// What is known of a run from one piece to the next.
#[derive(Clone, Copy, Debug)]
pub struct Log {
    /// Its beginning, once it has begun.
    pub origin: Option<Origin<f64>>,
    /// Rows of all pieces.
    pub rows: u64,
    /// Rows of the last piece.
    pub written: usize,
    /// Whether there is another piece to come.
    pub unfinished: bool,
    marks: [(u32, f64); MOST_MARKS],
    happened: usize,
}

impl Log {
    /// Of no run.
    pub const EMPTY: Self = Self {
        origin: None,
        rows: 0,
        written: 0,
        unfinished: false,
        marks: [(0, 0.0); MOST_MARKS],
        happened: 0,
    };

    /// Begins a piece, of which nothing is known yet.
    pub fn begin_piece(&mut self) {
        (self.written, self.unfinished, self.happened) = (0, false, 0);
    }

    /// What happened in the last piece, and when: zero for a passage through a singular
    /// position, one more than its place for an event.
    pub fn marks(&self) -> &[(u32, f64)] {
        &self.marks[..self.happened.min(MOST_MARKS)]
    }

    /// Whether more happened in one step than there is room for.
    pub fn is_overfull(&self) -> bool {
        self.happened > MOST_MARKS
    }

    /// Forgets what happened after the end of the piece, within its last step: the next
    /// piece will tell it.
    pub fn end_piece(&mut self, t: f64) {
        let mut kept = 0;
        for place in 0..self.marks().len() {
            if self.marks[place].1 <= t {
                self.marks[kept] = self.marks[place];
                kept += 1;
            }
        }
        self.happened = kept;
    }

    fn happens(&mut self, kind: usize, t: f64) {
        if let Some(place) = self.marks.get_mut(self.happened) {
            *place = (kind as u32, t);
        }
        self.happened += 1;
    }
}

/// Makes rows of steps.
pub struct Writer<'a, const N: usize, const R: usize> {
    pub log: &'a mut Log,
    pub columns: Columns,
    pub numbers: &'a mut [f64],
    /// Gives the rows of a step one at a time.
    pub grid: Grid<f64>,
    /// The state of the last row, where a run goes on that was cut there.
    pub last: State<f64, N>,
    pub every: f64,
    pub until: f64,
}

impl<const N: usize, const R: usize> Writer<'_, N, R> {
    /// Rows that there is room for.
    fn room(&self, probe: &dyn Probe<f64, N>) -> usize {
        self.numbers.len() / self.columns.width(probe.structure())
    }

    fn add(
        &mut self,
        state: &State<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        if self.log.written >= self.room(probe) {
            self.log.unfinished = true;
            return Ok(ControlFlow::Break(()));
        }
        let width = self.columns.width(probe.structure());
        let begin = self.log.written * width;
        let row = &mut self.numbers[begin..begin + width];
        self.columns.write::<N, R>(state, probe, row)?;
        self.log.written += 1;
        self.log.rows += 1;
        self.last = *state;
        Ok(ControlFlow::Continue(()))
    }

    /// The rows of a step, and one at the end of the run, where the last interval is a
    /// short one.
    fn rows(
        &mut self,
        step: &Step<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        while let Some(row) = self.grid.row(step, probe)? {
            if self.add(&row, probe)?.is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        let end = step.end();
        let short = self.every.min(self.until.abs()) * SHORT;
        match end.t >= self.until && end.t - self.last.t > short {
            true => self.add(end, probe),
            false => Ok(ControlFlow::Continue(())),
        }
    }

    /// Whether the end of a step is a good place to end a piece.
    fn is_over(
        &self,
        state: &State<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<bool, DynamicsError<f64>> {
        let is_full = |taken, room| taken >= room - room / SPARE;
        let full =
            is_full(self.log.written, self.room(probe)) || is_full(self.log.happened, MOST_MARKS);
        Ok(full && state.t < self.until && probe.rank(state)?.sine >= CALM_SINE)
    }
}

impl<const N: usize, const R: usize> Observer<f64, N> for Writer<'_, N, R> {
    fn begin(
        &mut self,
        state: &State<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        if let Some(origin) = self.log.origin {
            self.grid.go_on(origin.t, self.log.rows);
            return Ok(ControlFlow::Continue(()));
        }
        self.log.origin = Some(Origin {
            t: state.t,
            energy: probe.energy(state).balance,
            supplied: 0.0,
        });
        self.grid.begin(state.t);
        // The projection of the start may have moved what is held by its round-off.
        let first = self.last;
        self.add(&first, probe)
    }

    fn step(
        &mut self,
        step: &Step<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        if self.rows(step, probe)?.is_break() {
            return Ok(ControlFlow::Break(()));
        }
        // An event has ended it, or there is little room left.
        if self.log.unfinished || self.is_over(step.end(), probe)? {
            self.log.unfinished = true;
            self.last = *step.end();
            return Ok(ControlFlow::Break(()));
        }
        Ok(ControlFlow::Continue(()))
    }

    fn event(&mut self, occurrence: &Occurrence<f64, N>) -> ControlFlow<()> {
        let t = occurrence.state.t;
        self.log.happens(occurrence.index + 1, t);
        if self.log.happened < MOST_MARKS - AT_ONCE || t >= self.until {
            return ControlFlow::Continue(());
        }
        self.log.unfinished = true;
        ControlFlow::Break(())
    }

    fn passage(&mut self, passage: &Passage<f64>) -> ControlFlow<()> {
        self.log.happens(0, passage.t);
        ControlFlow::Continue(())
    }
}
