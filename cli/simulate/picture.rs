//! The picture of a run: curves, or a page on which the mechanism moves.
//!
//! In:  rows, what is known of the run.
//! Out: an SVG or an HTML file.

use crate::arguments::Simulate;
use crate::column::{Column, columns, header};
use crate::comparison::{Called, Comparison, compared};
use crate::error::CommandError;
use crate::figure::{chosen, named, overview, places as places_of};
use crate::formula::{Assignment, Setting};
use crate::mechanism::description;
use crate::mistakes::{self, both};
use crate::number::exact;
use crate::output::say;
use crate::page::{self, Live, Sliders, is_page};
use crate::plot::{Marks, Portrait, Sheet, Times, panels_as_svg, phase_as_svg};
use crate::raster;
use crate::run::{Plan, Report};
use crate::simulate::film::film;
use bricard_driver::{AnyMechanism, Changes};
use bricard_runtime::{Stabilisation, StepControl, Structure};
use std::path::Path;

/// Steps between two rows of a picture from which on it may mislead.
const SPARSE: f64 = 2.0;

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
    /// What was done, in words.
    pub summary: Vec<[String; 2]>,
    /// Why it ended early.
    pub error: Option<String>,
    /// What keeps a page up to date.
    pub live: Option<&'a Live>,
    /// The mechanism as WebAssembly, for the sliders of a page, and what was changed of it.
    pub module: Option<(&'a [u8], &'a Changes)>,
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
    let curves = arguments.curves.iter();
    let curves = mistakes::all(curves.map(|word| places(word, &mut all, structure, owner)))?;
    let mut place = |word: &String| {
        let found = places(word, &mut all, structure, owner)?;
        // Of a vector the first component.
        Ok(found.first().copied().unwrap_or(0))
    };
    let phase = match &arguments.phase {
        Some([x, y]) => Some(both(place(x), place(y))?.into()),
        None => None,
    };
    Ok(Shown {
        columns: all,
        curves: curves.concat(),
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
            names: vec![word.to_string()],
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
    /// Draws a run, or compares several, in the files that are wanted. Returns their names.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`], [`CommandError::Draw`].
    pub fn draw(&self, runs: &[Called]) -> Result<Vec<String>, CommandError> {
        let (plot, path) = (&self.arguments.plot, &self.arguments.film);
        if let Some(plot) = plot {
            self.sparse().into_iter().for_each(|text| say(&text));
            match is_page(plot) {
                true => self.page(plot, runs)?,
                false => raster::write(plot, &self.plot(plot, runs)?, self.is_print())?,
            }
        }
        if let (Some(path), Some(run)) = (path, runs.first()) {
            film(&self.sheet(path), self.mechanism, &run.rows)?;
        }
        let files = plot.iter().chain(path);
        Ok(files.map(|path| path.display().to_string()).collect())
    }

    /// What to say where rows are so far apart that steps, which follow the motion, lie between
    /// them: a fast oscillation would look like a slow one.
    fn sparse(&self) -> Option<String> {
        let every = self.plan.every.filter(|_| self.arguments.every.is_none())?;
        let between = self.report?.steps as f64 * every / self.plan.options.until;
        (between > SPARSE).then(|| {
            format!(
                "warning: the picture shows a row every {} s, with {between:.0} steps between two; \
                 fast oscillations may look slow or be lost; give a smaller `--every`",
                exact(every)
            )
        })
    }

    fn is_print(&self) -> bool {
        self.arguments.width.is_some()
    }

    fn sheet<'b>(&'b self, path: &'b Path) -> Sheet<'b> {
        Sheet {
            path,
            title: &self.arguments.name,
            width: self.arguments.width,
        }
    }

    fn plot(&self, path: &Path, runs: &[Called]) -> Result<String, CommandError> {
        let structure = self.mechanism.structure();
        let (sheet, columns) = (self.sheet(path), &self.shown.columns);
        if let Some(pair) = self.shown.phase {
            let axes = pair.map(|place| named(structure, columns, &[], place).name);
            let portraits: Vec<Portrait> = runs.iter().map(|run| portrait(run, pair)).collect();
            return phase_as_svg(&sheet, [&axes[0], &axes[1]], &portraits);
        }
        if let [run] = runs {
            let marks = self.marks();
            let times: Vec<f64> = run.rows.iter().map(|row| row[0]).collect();
            let times = Times {
                values: &times,
                marks: &marks,
            };
            let curves = match &self.shown.curves[..] {
                [] => overview(structure, columns, &run.rows),
                places => chosen(structure, columns, &run.rows, places),
            };
            return panels_as_svg(&sheet, times, &curves);
        }
        // Each run has passages and events of its own.
        let comparison = self.compared(runs, places_of(structure, columns));
        let times = Times {
            values: &comparison.times,
            marks: &[],
        };
        panels_as_svg(&sheet, times, &comparison.panels)
    }

    /// The curves that are wanted, or those at some places, of several runs.
    fn compared(&self, runs: &[Called], all: Vec<usize>) -> Comparison {
        let places = match self.shown.curves.is_empty() {
            true => all,
            false => self.shown.curves.clone(),
        };
        let structure = self.mechanism.structure();
        compared(structure, &self.shown.columns, runs, &places)
    }

    /// What is marked: singular positions, and events.
    fn marks(&self) -> Vec<Marks> {
        let structure = self.mechanism.structure();
        let marks = self.report.map(|report| marks(report, structure));
        marks.unwrap_or_default()
    }

    fn page(&self, path: &Path, runs: &[Called]) -> Result<(), CommandError> {
        let name = &self.arguments.name;
        let columns = &self.shown.columns;
        // The file may have been removed since.
        let description = description(name).ok();
        let source = description.map(|d| (d.file.display().to_string(), d.source));
        let all = || (1..header(self.mechanism.structure(), columns).len()).collect();
        let first = runs.first();
        let sliders = self.module.map(|(module, changes)| Sliders {
            module,
            plan: self.plan,
            changes,
        });
        let run = page::Run {
            mechanism: self.mechanism,
            name,
            source,
            columns,
            curves: &self.shown.curves,
            rows: first.map_or(&[], |run| &run.rows),
            compared: (runs.len() > 1).then(|| self.compared(runs, all())),
            moving: first.map_or("", |run| &run.name),
            marks: &self.marks(),
            settings: self.settings(),
            summary: self.summary.clone(),
            error: self.error.clone(),
            live: self.live,
            sliders: sliders.as_ref(),
        };
        page::write(path, &run)
    }

    /// How it was integrated, and what was changed of the mechanism, in words.
    fn settings(&self) -> Vec<[String; 2]> {
        let options = &self.plan.options;
        let mut pairs = vec![["method", &options.method.to_string()].map(String::from)];
        let mut tell = |what: &str, value: String| pairs.push([what.to_string(), value]);
        match options.step_control {
            StepControl::Fixed { step } => tell("step", format!("{} s", exact(step))),
            StepControl::Adaptive { relative, absolute } => {
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
        for choice in &self.arguments.set {
            let value = |setting: &Setting| match setting {
                Setting::Number(number) => exact(number.value),
                Setting::Law { text, .. } => text.clone(),
            };
            let values: Vec<String> = choice.all().map(value).collect();
            let name = choice.first.name();
            tell("set", format!("{name} = {}", values.join(", ")));
        }
        for choice in &self.arguments.start {
            let Assignment { name, held, .. } = &choice.first;
            let sign = if *held { '=' } else { '~' };
            let values: Vec<String> = choice.all().map(|x| exact(x.value)).collect();
            tell("start", format!("{name} {sign} {}", values.join(", ")));
        }
        pairs
    }
}

/// Two columns of a run, one over the other.
fn portrait(run: &Called, [x, y]: [usize; 2]) -> Portrait {
    Portrait {
        name: run.name.clone(),
        points: run.rows.iter().map(|row| (row[x], row[y])).collect(),
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
