//! The picture of a run: curves, or a page on which the mechanism moves.
//!
//! In:  rows, what is known of the run.
//! Out: an SVG or an HTML file.

use crate::arguments::Simulate;
use crate::check::read;
use crate::column::Column;
use crate::error::CommandError;
use crate::figure::overview;
use crate::mechanism::{file, source};
use crate::number::exact;
use crate::page::{self, Live, is_page};
use crate::plot::{Marks, Times, panels};
use crate::run::{Plan, Report};
use crate::simulate::summary::quantities;
use bricard_driver::AnyMechanism;
use bricard_runtime::{Pace, Stabilisation, Structure};
use std::path::Path;

/// What a picture tells of a run besides its rows.
pub struct Picture<'a> {
    /// What was asked for.
    pub arguments: &'a Simulate,
    /// The mechanism, as it was set.
    pub mechanism: &'a dyn AnyMechanism,
    /// How it was integrated, and the columns of the rows.
    pub plan: &'a Plan,
    /// What was done.
    pub report: Option<&'a Report>,
    /// Why it ended early.
    pub error: Option<&'a CommandError>,
    /// What keeps a page up to date.
    pub live: Option<&'a Live>,
}

/// The columns that the run has to give: those that are wanted, and those of a page.
pub fn columns(arguments: &Simulate, wanted: &[Column], structure: &Structure) -> Vec<Column> {
    match arguments.plot.as_deref().is_some_and(is_page) {
        true => page::columns(wanted, structure),
        false => wanted.to_vec(),
    }
}

impl Picture<'_> {
    /// Draws rows into a file.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`], [`CommandError::Draw`].
    pub fn draw(&self, path: &Path, rows: &[Vec<f64>]) -> Result<(), CommandError> {
        let structure = self.mechanism.structure();
        let marks = self.report.map(|report| marks(report, structure));
        let marks = marks.unwrap_or_default();
        if is_page(path) {
            return self.page(path, rows, &marks);
        }
        let values: Vec<f64> = rows.iter().filter_map(|row| row.first().copied()).collect();
        let times = Times {
            values: &values,
            marks: &marks,
        };
        let curves = overview(structure, &self.plan.columns, rows);
        panels(path, &self.arguments.name, times, &curves)
    }

    fn page(&self, path: &Path, rows: &[Vec<f64>], marks: &[Marks]) -> Result<(), CommandError> {
        let structure = self.mechanism.structure();
        let name = &self.arguments.name;
        let source = match file(name) {
            // It may have been removed since.
            Some(file) => read(file).ok().map(|text| (name.clone(), text)),
            None => source(name).map(|text| (structure.file.to_string(), text.to_string())),
        };
        let summary = self.report.map(|report| quantities(report, structure));
        let run = page::Run {
            mechanism: self.mechanism,
            name,
            source,
            columns: &self.plan.columns,
            rows,
            marks,
            settings: self.settings(),
            summary: summary.unwrap_or_default(),
            error: self.error.map(ToString::to_string),
            live: self.live,
        };
        page::write(path, &run)
    }

    /// How it was integrated, and what was changed of the mechanism, in words.
    fn settings(&self) -> Vec<[String; 2]> {
        let options = &self.plan.options;
        let mut pairs = vec![["method", &options.scheme.to_string()].map(String::from)];
        let mut tell = |what: &str, value: String| pairs.push([what.to_string(), value]);
        match options.pace {
            Pace::Fixed { step } => tell("step", format!("{} s", exact(step))),
            Pace::Adaptive { relative, absolute } => {
                tell("relative tolerance", exact(relative));
                tell("absolute tolerance", exact(absolute));
            }
        }
        tell("form", options.settings.form.to_string());
        let stabilisation = match options.settings.stabilisation {
            Stabilisation::Projection => "projection".to_string(),
            Stabilisation::Baumgarte { alpha, beta } => {
                format!(
                    "Baumgarte, α = {} 1/s, β = {} 1/s",
                    exact(alpha),
                    exact(beta)
                )
            }
            Stabilisation::None => "none".to_string(),
        };
        tell("stabilisation", stabilisation);
        tell("end", format!("{} s", exact(options.until)));
        match self.plan.every {
            Some(every) => tell("rows every", format!("{} s", exact(every))),
            None => tell("rows", "after each step".to_string()),
        }
        for (what, changes) in [
            ("set", &self.arguments.set),
            ("start", &self.arguments.start),
        ] {
            for change in changes {
                let sign = if change.held { '=' } else { '~' };
                tell(
                    what,
                    format!("{} {sign} {}", change.name, exact(change.value)),
                );
            }
        }
        pairs
    }
}

/// What is marked in a plot: singular positions, and the events by name.
fn marks(report: &Report, structure: &Structure) -> Vec<Marks> {
    let passages = report.passages.iter().map(|passage| passage.t);
    let passages = Marks {
        times: passages.collect(),
        name: "singular position".to_string(),
    };
    let events = structure.events.iter().map(|event| {
        let of_name = report.events.iter().filter(|(name, _)| *name == event.name);
        Marks {
            times: of_name.map(|(_, t)| *t).collect(),
            name: event.name.to_string(),
        }
    });
    std::iter::once(passages).chain(events).collect()
}
