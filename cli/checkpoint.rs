//! Checkpoints: where a run can be taken up again, to the same bits.
//!
//! In:  a state at the end of a leg and what was done until then.
//! Out: a file, written whole or not at all, and what is read back from it.
//!
//! A run with checkpoints is divided into legs of [`LEG_STEPS`] steps. Each begins
//! with nothing but a state and the beginning of the run, so that the bits of the next
//! leg do not depend on whether the program was ended in between. Numbers are kept by
//! their bits.

use crate::error::CommandError;
use crate::run::Report;
use bricard_runtime::{Counters, Origin, Passage, Structure};
use serde_json::{Value, json};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Steps of a leg.
pub const LEG_STEPS: u64 = 1000;
/// Steps by which a leg is longer where it would end next to a singular position.
pub const EXTRA_STEPS: u64 = 100;
/// A leg doesn't end where constraints are independent by less than this sine: a
/// passage through a singular position belongs to one leg.
pub const CALM_SINE: f64 = 0.3;
/// How often the file is written while the run goes on.
const PERIOD: Duration = Duration::from_secs(5);
/// The version of the file.
const FORMAT: u64 = 1;

/// Which checkpoints a run writes, and which it begins with.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Legs {
    /// What the run is, in words: a checkpoint of another one is refused.
    pub run: String,
    /// Where checkpoints go.
    pub file: Option<PathBuf>,
    /// Where the run goes on.
    pub from: Option<Checkpoint>,
}

/// Where a run can be taken up again.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// The beginning of the run, and what was supplied since.
    pub origin: Origin<f64>,
    /// Time, coordinates, velocities.
    pub state: Vec<f64>,
    /// Rows that are written.
    pub rows: Rows,
    /// What was done.
    pub report: Report,
}

/// Rows that are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rows {
    /// How many.
    pub count: u64,
    /// The length of the file they are in.
    pub bytes: Option<u64>,
}

/// Writes checkpoints, not too often.
#[derive(Debug)]
pub struct Keeper<'a> {
    legs: &'a Legs,
    written: Instant,
    last: Option<Checkpoint>,
}

impl<'a> Keeper<'a> {
    /// Nothing written yet.
    pub fn new(legs: &'a Legs) -> Self {
        Self {
            legs,
            written: Instant::now(),
            last: None,
        }
    }

    /// Takes a checkpoint, and writes it if the last one is some time ago.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`].
    pub fn take(&mut self, checkpoint: Checkpoint) -> Result<(), CommandError> {
        self.last = Some(checkpoint);
        match self.written.elapsed() >= PERIOD {
            true => self.write(),
            false => Ok(()),
        }
    }

    /// Writes the last checkpoint that was taken.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`].
    pub fn write(&mut self) -> Result<(), CommandError> {
        if let (Some(file), Some(checkpoint)) = (&self.legs.file, &self.last) {
            let text = format!("{:#}\n", checkpoint.json(&self.legs.run));
            replace(file, &text).map_err(|error| CommandError::write(file, error))?;
        }
        self.written = Instant::now();
        Ok(())
    }
}

/// Replaces a file as a whole: whoever reads it sees the old text or the new one.
fn replace(path: &Path, text: &str) -> io::Result<()> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".new");
    let written = File::create(&beside).and_then(|mut file| {
        file.write_all(text.as_bytes())?;
        file.sync_all()
    });
    match written.and_then(|()| fs::rename(&beside, path)) {
        Ok(()) => Ok(()),
        Err(error) => {
            let _not_there = fs::remove_file(&beside);
            Err(error)
        }
    }
}

/// Reads the checkpoint of a run.
///
/// # Errors
///
/// [`CommandError::Read`], and [`CommandError::Checkpoint`] if the file is none, or one
/// of another run.
pub fn read(path: &Path, run: &str, structure: &Structure) -> Result<Checkpoint, CommandError> {
    let text = fs::read_to_string(path).map_err(|e| CommandError::Read(path.to_path_buf(), e))?;
    let refuse = |reason: &'static str| CommandError::Checkpoint {
        path: path.to_path_buf(),
        reason,
    };
    let value: Value = serde_json::from_str(&text).map_err(|_| refuse("it is no checkpoint"))?;
    if value["format"] != FORMAT {
        return Err(refuse("it is no checkpoint of this version of bricard"));
    }
    if value["run"] != run {
        return Err(refuse(
            "it is one of another run: give the same mechanism and options",
        ));
    }
    let parsed = Checkpoint::parse(&value, structure);
    parsed
        .filter(|checkpoint| checkpoint.state.len() == 1 + 2 * structure.coordinates.len())
        .ok_or_else(|| refuse("it is damaged"))
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// Numbers by their bits.
fn numbers(value: &Value) -> Option<Vec<f64>> {
    let entries = value.as_array()?;
    entries
        .iter()
        .map(|bits| bits.as_u64().map(f64::from_bits))
        .collect()
}

impl Checkpoint {
    fn json(&self, run: &str) -> Value {
        let report = &self.report;
        let passage = |p: &Passage<f64>| (bits(&[p.t, p.sine]), p.rank, p.regular);
        let passages: Vec<_> = report.passages.iter().map(passage).collect();
        let events: Vec<_> = report
            .events
            .iter()
            .map(|(name, t)| (name, t.to_bits()))
            .collect();
        let Origin {
            t,
            energy,
            supplied,
        } = self.origin;
        json!({
            "format": FORMAT,
            "run": run,
            "t": self.state.first(),
            "state": bits(&self.state),
            "origin": bits(&[t, energy, supplied]),
            "rows": self.rows.count,
            "bytes": self.rows.bytes,
            "steps": report.steps,
            "rejected": report.rejected,
            "errors": bits(&[report.constraint_error, report.energy_error]),
            "seconds": report.wall.as_secs_f64().to_bits(),
            "passages": passages,
            "events": events,
            "counters": counts(&report.counters),
        })
    }

    fn parse(value: &Value, structure: &Structure) -> Option<Self> {
        let [t, energy, supplied] = numbers(&value["origin"])?[..] else {
            return None;
        };
        let [constraint_error, energy_error] = numbers(&value["errors"])?[..] else {
            return None;
        };
        let seconds = f64::from_bits(value["seconds"].as_u64()?);
        let passages = value["passages"].as_array()?.iter().map(passage);
        let events = value["events"].as_array()?.iter().map(|entry| {
            let name = entry[0].as_str()?;
            let event = structure.events.iter().find(|event| event.name == name)?;
            Some((event.name, f64::from_bits(entry[1].as_u64()?)))
        });
        Some(Self {
            origin: Origin {
                t,
                energy,
                supplied,
            },
            state: numbers(&value["state"])?,
            rows: Rows {
                count: value["rows"].as_u64()?,
                bytes: value["bytes"].as_u64(),
            },
            report: Report {
                steps: value["steps"].as_u64()?,
                rejected: value["rejected"].as_u64()?,
                wall: Duration::try_from_secs_f64(seconds).ok()?,
                constraint_error,
                energy_error,
                passages: passages.collect::<Option<_>>()?,
                events: events.collect::<Option<_>>()?,
                counters: counters(&value["counters"])?,
            },
        })
    }
}

fn passage(entry: &Value) -> Option<Passage<f64>> {
    let [t, sine] = numbers(&entry[0])?[..] else {
        return None;
    };
    let count = |value: &Value| usize::try_from(value.as_u64()?).ok();
    Some(Passage {
        t,
        sine,
        rank: count(&entry[1])?,
        regular: count(&entry[2])?,
    })
}

fn counts(counters: &Counters) -> [u64; 12] {
    [
        counters.cheap_accelerations,
        counters.landed_accelerations,
        counters.robust_accelerations,
        counters.rank_decisions,
        counters.undetermined,
        counters.branch_evaluations,
        counters.mass_factorisations,
        counters.constraint_factorisations,
        counters.row_choices,
        counters.projections,
        counters.projection_iterations,
        counters.robust_projections,
    ]
}

fn counters(value: &Value) -> Option<Counters> {
    let counts: Option<Vec<u64>> = value.as_array()?.iter().map(Value::as_u64).collect();
    let counts: [u64; 12] = counts?.try_into().ok()?;
    let [
        cheap,
        landed,
        robust,
        decisions,
        undetermined,
        branch,
        mass,
        rows,
        choices,
        ..,
    ] = counts;
    Some(Counters {
        cheap_accelerations: cheap,
        landed_accelerations: landed,
        robust_accelerations: robust,
        rank_decisions: decisions,
        undetermined,
        branch_evaluations: branch,
        mass_factorisations: mass,
        constraint_factorisations: rows,
        row_choices: choices,
        projections: counts[9],
        projection_iterations: counts[10],
        robust_projections: counts[11],
    })
}
