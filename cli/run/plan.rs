//! What is wanted of a run.
//!
//! Out: [`Plan`], and [`RowSink`], where its rows go.

use crate::checkpoint::{Checkpoint, Checkpoints, Rows};
use crate::error::CommandError;
use bricard_driver::{Column, Segment};
use bricard_runtime::Options;

/// How to integrate and what to record.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Method, end, form of the equations.
    pub options: Options<f64>,
    /// Distance of the rows (s); a row after each step if there is none.
    pub every: Option<f64>,
    /// Columns besides time, coordinates and velocities.
    pub columns: Vec<Column>,
    /// The checkpoints of a run that has some.
    pub checkpoints: Option<Checkpoints>,
    /// Whether somebody waits for the run.
    pub watched: bool,
}

impl Plan {
    /// A run from its start to its end that nobody waits for.
    pub fn new(options: Options<f64>, every: Option<f64>, columns: Vec<Column>) -> Self {
        Self {
            options,
            every,
            columns,
            checkpoints: None,
            watched: false,
        }
    }

    /// The first part of the run, or the next one after a checkpoint.
    pub fn segment(&self, from: Option<&Checkpoint>) -> Segment {
        Segment {
            options: Options {
                origin: from.map(|checkpoint| checkpoint.origin),
                ..self.options
            },
            from: from.map(|checkpoint| checkpoint.state.clone()),
            every: self.every,
            columns: self.columns.clone(),
            rows: from.map_or(0, |checkpoint| checkpoint.rows.count),
            short: self.checkpoints.is_some(),
        }
    }
}

/// Receives rows.
pub trait RowSink {
    /// Takes a row: time, coordinates, velocities, added columns.
    ///
    /// # Errors
    ///
    /// What stands in the way; it ends the run.
    fn row(&mut self, values: &[f64]) -> Result<(), CommandError>;

    /// Hands all rows over to where they go, and says what is there.
    ///
    /// # Errors
    ///
    /// As [`row`](Self::row).
    fn flush(&mut self) -> Result<Rows, CommandError> {
        Ok(Rows::default())
    }
}

/// Rows that are kept in memory.
impl RowSink for Vec<Vec<f64>> {
    fn row(&mut self, values: &[f64]) -> Result<(), CommandError> {
        self.push(values.to_vec());
        Ok(())
    }
}
