//! The runs of a session.
//!
//! In:  where a motion is, how far to go, which rows are wanted.
//! Out: rows, and what happened.

use crate::row::Columns;
use crate::run::{Log, Writer};
use crate::session::{DONE, ROOM, Session};
use bricard_runtime::{Grid, Interface, Mechanism, Options, simulate};

impl<M, const N: usize, const R: usize> Session<M, N, R>
where
    M: Mechanism<f64, N, R> + Interface<f64, N>,
{
    /// Moves on to a time (s) in one run, with rows at equal distances of time (s), which
    /// have the columns of some bits (see `row.rs`). If [`unfinished`](Self::unfinished)
    /// says so afterwards, rows or [`marks`](Self::marks) had no room: with `again` the same
    /// run goes on.
    pub fn run(&mut self, until: f64, every: f64, columns: u32, again: u32) -> u32 {
        let Some(columns) = Columns::of(columns) else {
            return self.fail(&"there are no columns of this number");
        };
        let structure = self.mechanism.structure();
        if columns.width(structure) > ROOM {
            return self.fail(&"a row has more numbers than there is room for");
        }
        if again == 0 {
            self.log = Log::EMPTY;
        }
        self.log.begin_piece();
        match self.go(until, every, columns) {
            Ok(()) => DONE,
            Err(refused) => refused,
        }
    }

    /// A piece of a run.
    fn go(&mut self, until: f64, every: f64, columns: Columns) -> Result<(), u32> {
        let Some(motion) = &mut self.motion else {
            return Err(self.not_begun());
        };
        let start = motion.state;
        let grid = match Grid::new(every) {
            Ok(grid) => grid,
            Err(error) => return Err(self.fail(&error)),
        };
        let options = Options {
            until,
            origin: self.log.origin,
            ..self.options
        };
        let mut writer = Writer::<N, R> {
            log: &mut self.log,
            columns,
            numbers: &mut self.numbers[..],
            grid,
            last: start,
            every,
            until,
        };
        let result = simulate::<_, _, N, R>(&self.mechanism, &start, &options, &mut [&mut writer]);
        let last = writer.last;
        let (end, error) = match result {
            Ok(summary) => (summary.end, None),
            Err(failure) => (failure.summary.end, Some(failure.error)),
        };
        motion.state = match self.log.unfinished && error.is_none() {
            true => last,
            false => end,
        };
        if let Some(error) = error {
            return Err(self.fail(&error));
        }
        if self.log.is_overfull() {
            return Err(
                self.fail(&"more happens in one step than there is room for: take shorter steps")
            );
        }
        if self.log.unfinished {
            self.log.end_piece(last.t);
        }
        Ok(())
    }

    /// Rows that the last run has written where numbers are read.
    pub fn rows(&self) -> u32 {
        self.log.written as u32
    }

    /// Whether the last run has more rows, passages and events than there was room for.
    pub fn unfinished(&self) -> u32 {
        self.log.unfinished.into()
    }

    /// Numbers in a row with the columns of some bits.
    pub fn width(&self, columns: u32) -> u32 {
        Columns::of(columns).map_or(0, |columns| {
            columns.width(self.mechanism.structure()) as u32
        })
    }

    /// What happened in the last piece of the run: pairs of numbers, of which the first is 0 for a
    /// passage through a singular position and one more than its place for an event, the
    /// second the time (s). How many pairs.
    pub fn marks(&mut self) -> u32 {
        let marks = self.log.marks();
        for ((kind, t), pair) in marks.iter().zip(self.numbers.chunks_exact_mut(2)) {
            pair.copy_from_slice(&[f64::from(*kind), *t]);
        }
        marks.len() as u32
    }
}
