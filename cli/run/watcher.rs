//! What watches a run for the command line.
//!
//! In:  rows and times, as they are reached.
//! Out: rows to a [`RowSink`], a line of progress, Ctrl-C.

use super::plan::{Plan, RowSink};
use crate::error::CommandError;
use crate::interrupt;
use crate::progress::Progress;
use bricard_driver::Watch;
use std::ops::ControlFlow;

/// Watches a run.
pub(super) struct Watcher<'a> {
    /// Where the rows go.
    pub(super) sink: &'a mut dyn RowSink,
    progress: Progress,
    /// What the run was broken off for.
    pub(super) refused: Option<CommandError>,
}

impl<'a> Watcher<'a> {
    /// A watcher of a plan's run, from a time (s).
    pub(super) fn new(plan: &Plan, begun: f64, sink: &'a mut dyn RowSink) -> Self {
        Self {
            sink,
            progress: Progress::new(begun, plan.options.until, plan.watched),
            refused: None,
        }
    }

    /// Breaks the run off if Ctrl-C was pressed.
    fn listen(&mut self) -> ControlFlow<()> {
        match interrupt::is_wanted() {
            true => self.refuse(CommandError::interrupted()),
            false => ControlFlow::Continue(()),
        }
    }

    fn refuse(&mut self, error: CommandError) -> ControlFlow<()> {
        self.refused = Some(error);
        ControlFlow::Break(())
    }
}

impl Watch for Watcher<'_> {
    fn row(&mut self, values: &[f64]) -> ControlFlow<()> {
        match self.sink.row(values) {
            Ok(()) => self.listen(),
            Err(error) => self.refuse(error),
        }
    }

    fn at(&mut self, t: f64, steps: u64) -> ControlFlow<()> {
        self.progress.at(t, steps);
        self.listen()
    }
}
