//! The picture of a run: curves, or a page on which the mechanism moves.
//!
//! In:  rows, what is known of the run.
//! Out: an SVG or an HTML file.

use crate::arguments::Simulate;
use crate::column::{Column, columns, header};
use crate::error::CommandError;
use crate::figure::{chosen, named, overview};
use crate::formula::Setting;
use crate::mechanism::description;
use crate::number::exact;
use crate::page::{self, Live, is_page};
use crate::plot::{Marks, Times, panels_as_svg, phase_as_svg};
use crate::raster;
use crate::run::{Plan, Report};
use crate::simulate::film::film;
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
    /// How it was integrated.
    pub plan: &'a Plan,
    /// What is shown of the rows.
    pub shown: &'a Shown,
    /// What was done.
    pub report: Option<&'a Report>,
    /// Why it ended early.
    pub error: Option<&'a CommandError>,
    /// What keeps a page up to date.
    pub live: Option<&'a Live>,
}

/// What is shown of the rows.
pub struct Shown {
    /// The columns that the run has to give besides coordinates and velocities.
    pub columns: Vec<Column>,
    /// The places in the rows of what is drawn over time; all if there are none.
    curves: Vec<usize>,
    /// The places of what is drawn over one another.
    phase: Option<[usize; 2]>,
}

/// What the command line asks for: columns, those of a page, and those that are drawn.
///
/// # Errors
///
/// [`CommandError::UnknownName`].
pub fn shown(
    arguments: &Simulate,
    wanted: &[Column],
    structure: &Structure,
) -> Result<Shown, CommandError> {
    let mut all = match arguments.plot.as_deref().is_some_and(is_page) {
        true => page::columns(wanted, structure),
        false => wanted.to_vec(),
    };
    let owner = &arguments.name;
    let mut curves = Vec::new();
    for word in &arguments.curves {
        curves.extend(places(word, &mut all, structure, owner)?);
    }
    let mut place = |word: &String| {
        let found = places(word, &mut all, structure, owner)?;
        // Of a vector the first component.
        Ok(found.first().copied().unwrap_or(0))
    };
    let phase = match &arguments.phase {
        Some([x, y]) => Some([place(x)?, place(y)?]),
        None => None,
    };
    Ok(Shown {
        columns: all,
        curves,
        phase,
    })
}

/// The places in the rows of what a word means. Columns that are missing are added.
fn places(
    word: &str,
    all: &mut Vec<Column>,
    structure: &Structure,
    owner: &str,
) -> Result<Vec<usize>, CommandError> {
    let word = word.trim();
    let always = header(structure, &[]);
    if let Some(place) = always.iter().position(|name| name == word) {
        return Ok(vec![place]);
    }
    let found = columns(&[word.to_string()], structure, owner);
    let found = found.map_err(|error| match error {
        CommandError::UnknownName { known, .. } => CommandError::UnknownName {
            kind: "coordinate, velocity, column or output",
            owner: owner.to_string(),
            name: word.to_string(),
            known: always.iter().cloned().chain(known).collect(),
        },
        error => error,
    })?;
    let place = |column: Column| {
        let known = all.iter().position(|known| *known == column);
        let place = known.unwrap_or_else(|| {
            all.push(column);
            all.len() - 1
        });
        always.len() + place
    };
    Ok(found.into_iter().map(place).collect())
}

impl Picture<'_> {
    /// Draws rows into the files that are wanted. Returns their names.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`], [`CommandError::Draw`].
    pub fn draw(&self, rows: &[Vec<f64>]) -> Result<Vec<String>, CommandError> {
        let (plot, path) = (&self.arguments.plot, &self.arguments.film);
        if let Some(plot) = plot {
            self.plot(plot, rows)?;
        }
        if let Some(path) = path {
            film(path, &self.arguments.name, self.mechanism, rows)?;
        }
        let files = plot.iter().chain(path);
        Ok(files.map(|path| path.display().to_string()).collect())
    }

    fn plot(&self, path: &Path, rows: &[Vec<f64>]) -> Result<(), CommandError> {
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
        let (title, columns) = (&self.arguments.name, &self.shown.columns);
        if let Some(pair) = self.shown.phase {
            let pair = pair.map(|place| named(structure, columns, rows, place));
            return raster::write(path, &phase_as_svg(path, title, &pair)?);
        }
        let curves = match &self.shown.curves[..] {
            [] => overview(structure, columns, rows),
            places => chosen(structure, columns, rows, places),
        };
        raster::write(path, &panels_as_svg(path, title, times, &curves)?)
    }

    fn page(&self, path: &Path, rows: &[Vec<f64>], marks: &[Marks]) -> Result<(), CommandError> {
        let structure = self.mechanism.structure();
        let name = &self.arguments.name;
        // The file may have been removed since.
        let description = description(name).ok();
        let source = description.map(|d| (d.file.display().to_string(), d.source));
        let summary = self.report.map(|report| quantities(report, structure));
        let run = page::Run {
            mechanism: self.mechanism,
            name,
            source,
            columns: &self.shown.columns,
            curves: &self.shown.curves,
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
        for setting in &self.arguments.set {
            let value = match setting {
                Setting::Number(number) => exact(number.value),
                Setting::Law { text, .. } => text.clone(),
            };
            tell("set", format!("{} = {value}", setting.name()));
        }
        for change in &self.arguments.start {
            let sign = if change.held { '=' } else { '~' };
            tell(
                "start",
                format!("{} {sign} {}", change.name, exact(change.value)),
            );
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
