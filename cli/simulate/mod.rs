//! `bricard simulate`: rows of numbers, a summary, a plot.
//!
//! In:  a mechanism's name and what to change, how to integrate, what to record.
//! Out: CSV, a summary on standard error, SVG.

mod choices;
mod legs;
pub mod summary;

pub use choices::TOLERANCE;

use crate::arguments::Simulate;
use crate::changes::Changes;
use crate::checkpoint::{Checkpoint, Rows};
use crate::column::{Column, columns, header};
use crate::error::CommandError;
use crate::figure::overview;
use crate::interrupt;
use crate::mechanism::find;
use crate::output::{CsvWriter, probe, say};
use crate::plot::{Times, panels};
use crate::run::{RowSink, Stopped};
use bricard_runtime::Structure;

/// Simulates a mechanism.
pub fn simulate(arguments: &Simulate) -> Result<(), CommandError> {
    let mut mechanism = find(&arguments.name)?;
    let structure = mechanism.structure();
    let changes = Changes::find(structure, &arguments.name, &arguments.set, &arguments.start)?;
    changes.apply(mechanism.as_mut());
    let columns = columns(&arguments.columns, structure, &arguments.name)?;
    let mut plan = choices::plan(arguments, columns.clone())?;
    choices::check_files(arguments)?;
    plan.legs = legs::legs(arguments, &plan, &changes, structure)?;
    let mut record = Record::open(arguments, structure, &columns)?;
    if let Some(checkpoint) = plan.legs.as_ref().and_then(|legs| legs.from.as_ref()) {
        record.go_on(checkpoint);
    }
    interrupt::listen();
    let result = mechanism.run(&plan, &mut record);
    let report = match &result {
        Ok(report) => Some(report),
        Err(stopped) => stopped.report.as_deref(),
    };
    let passages = report.map_or(&[][..], |report| &report.passages);
    let passages: Vec<f64> = passages.iter().map(|passage| passage.t).collect();
    let kept = record.close(arguments, &passages, structure, &columns)?;
    if let Some(report) = report.filter(|report| result.is_ok() || report.steps > 0) {
        say(summary::summary(report, structure).trim_end());
    }
    match result {
        Ok(_) => Ok(()),
        Err(Stopped { error, .. }) => {
            legs::say_how_to_go_on(arguments);
            match error {
                CommandError::Run { reason, .. } => Err(CommandError::Run { reason, kept }),
                CommandError::Interrupted { .. } => Err(CommandError::Interrupted { kept }),
                error => Err(error),
            }
        }
    }
}

/// Where the rows go.
struct Record {
    csv: Option<CsvWriter>,
    rows: Option<Vec<Vec<f64>>>,
    count: usize,
    last: f64,
}

impl Record {
    fn open(
        arguments: &Simulate,
        structure: &Structure,
        columns: &[Column],
    ) -> Result<Self, CommandError> {
        if let Some(plot) = &arguments.plot {
            probe(plot)?;
        }
        let wanted = arguments.out.is_some() || arguments.plot.is_none();
        let open = || CsvWriter::new(arguments.out.as_deref(), &header(structure, columns));
        let csv = wanted.then(open).transpose()?;
        let rows = arguments.plot.is_some().then(Vec::new);
        Ok(Self {
            csv,
            rows,
            count: 0,
            last: 0.0,
        })
    }

    /// Goes on after the rows of a checkpoint.
    fn go_on(&mut self, checkpoint: &Checkpoint) {
        self.count = usize::try_from(checkpoint.rows.count).unwrap_or(usize::MAX);
        if let Some(csv) = &mut self.csv {
            csv.go_on(checkpoint.rows);
        }
    }

    /// Writes what is still to be written. Returns what to say of the rows if
    /// the run failed.
    fn close(
        &mut self,
        arguments: &Simulate,
        passages: &[f64],
        structure: &Structure,
        columns: &[Column],
    ) -> Result<String, CommandError> {
        let mut places = Vec::new();
        if let Some(csv) = &mut self.csv {
            csv.finish()?;
            places.push(csv.destination());
        }
        if let (Some(path), Some(rows)) = (&arguments.plot, &self.rows)
            && self.count > 0
        {
            let values: Vec<f64> = rows.iter().filter_map(|row| row.first().copied()).collect();
            let times = Times {
                values: &values,
                marks: passages,
                marked: "singular position",
            };
            panels(
                path,
                &arguments.name,
                times,
                &overview(structure, columns, rows),
            )?;
            places.push(path.display().to_string());
        }
        Ok(match self.count {
            0 => "\nno rows were computed, and nothing was written".to_string(),
            count => format!(
                "\nthe {count} rows computed before, up to t = {} s, are kept: {}",
                self.last,
                places.join(", ")
            ),
        })
    }
}

impl RowSink for Record {
    fn row(&mut self, values: &[f64]) -> Result<(), CommandError> {
        if let Some(csv) = &mut self.csv {
            csv.row(values)?;
        }
        if let Some(rows) = &mut self.rows {
            rows.push(values.to_vec());
        }
        self.count += 1;
        self.last = values.first().copied().unwrap_or(0.0);
        Ok(())
    }

    fn settle(&mut self) -> Result<Rows, CommandError> {
        self.csv
            .as_mut()
            .map_or(Ok(Rows::default()), CsvWriter::settle)
    }
}
