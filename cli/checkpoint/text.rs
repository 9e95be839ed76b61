//! What stands in the file of a checkpoint.
//!
//! In:  a checkpoint and what the run is; a text.
//! Out: the text; the checkpoint, or why a run can't go on from the text.
//!
//! Numbers are kept by their bits, and a checksum of everything tells a damaged file
//! from a whole one.

use crate::hash::hash;
use crate::run::Report;
use bricard_runtime::{Counters, Origin, Passage, Structure};
use serde_json::{Value, json};
use std::time::Duration;

/// The version of the file.
const FORMAT: u64 = 4;
/// The time at which every run begins (s).
const BEGINNING: f64 = 0.0;
/// More steps, rows or seconds than any run comes to: sums of such numbers overflow
/// nowhere.
const COUNTLESS: u64 = 1 << 53;

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

impl Checkpoint {
    /// The text of the file, for a run in words.
    pub fn text(&self, run: &str) -> String {
        let mut value = self.json(run);
        value["checksum"] = checksum(&value).into();
        format!("{value:#}\n")
    }

    /// What a text says.
    ///
    /// # Errors
    ///
    /// Why a run can't go on from it.
    pub fn read(text: &str, run: &str, structure: &Structure) -> Result<Self, String> {
        let value: Value = serde_json::from_str(text)
            .map_err(|_| "it is no checkpoint, or damaged; give a file as --checkpoint wrote it")?;
        if value["format"] != FORMAT {
            let other = "it is no checkpoint of this version of bricard; begin the run anew";
            return Err(other.to_string());
        }
        if value["run"] != run {
            return Err(another(value["run"].as_str().unwrap_or_default(), run));
        }
        let whole = value["checksum"] == checksum(&value);
        let parsed = Self::parse(&value, structure).filter(|parsed| whole && parsed.is_sound());
        parsed
            .filter(|parsed| parsed.state.len() == 1 + 2 * structure.coordinates.len())
            .ok_or("it is damaged; begin the run anew".to_string())
    }

    /// Whether a run can have come here.
    fn is_sound(&self) -> bool {
        let begun = self.origin.t == BEGINNING && self.state.first() >= Some(&BEGINNING);
        begun && self.state.iter().all(|x| x.is_finite())
    }

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
            "t": self.state.first().map(|t| format!("{t:?} s")),
            "state": bits(&self.state),
            "origin": bits(&[t, energy, supplied]),
            "rows": self.rows.count,
            "bytes": self.rows.bytes,
            "steps": report.steps,
            "rejected": report.rejected,
            "errors": bits(&[report.constraint_error, report.energy_error, report.energy_exchanged]),
            "seconds": report.wall.as_secs_f64().to_bits(),
            "passages": passages,
            "events": events,
            "counters": counts(report.counters),
        })
    }

    fn parse(value: &Value, structure: &Structure) -> Option<Self> {
        let [t, energy, supplied] = numbers(&value["origin"])?[..] else {
            return None;
        };
        let [constraint_error, energy_error, energy_exchanged] = numbers(&value["errors"])?[..]
        else {
            return None;
        };
        let seconds = f64::from_bits(value["seconds"].as_u64()?);
        let wall = Duration::try_from_secs_f64(seconds).ok()?;
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
                count: count(&value["rows"])?,
                bytes: value["bytes"].as_u64(),
            },
            report: Report {
                steps: count(&value["steps"])?,
                rejected: count(&value["rejected"])?,
                wall: Some(wall).filter(|wall| wall.as_secs() < COUNTLESS)?,
                constraint_error,
                energy_error,
                energy_exchanged,
                passages: passages.collect::<Option<_>>()?,
                events: events.collect::<Option<_>>()?,
                counters: counters(&value["counters"])?,
            },
        })
    }
}

/// What is said of a checkpoint of another run. The words for a run are lines, each of what
/// is chosen, `: ` and the choice.
fn another(known: &str, run: &str) -> String {
    let differs = |(one, other): (&str, &str)| {
        let ((name, value), (same, known)) = (one.split_once(": ")?, other.split_once(": ")?);
        (name == same && value != known).then(|| name.to_string())
    };
    let others: Vec<String> = run.lines().zip(known.lines()).filter_map(differs).collect();
    let others = match others.is_empty() {
        true => String::new(),
        false => format!("; what differs: {}", others.join(", ")),
    };
    format!("it is one of another run: give the same mechanism and options{others}")
}

/// A number that changes with anything else in the file: the hash of all entries but this one.
pub(super) fn checksum(value: &Value) -> u64 {
    let mut rest = value.clone();
    if let Some(entries) = rest.as_object_mut() {
        entries.remove("checksum");
    }
    hash([&*rest.to_string()])
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

/// A number of things done.
fn count(value: &Value) -> Option<u64> {
    value.as_u64().filter(|count| *count < COUNTLESS)
}

fn passage(entry: &Value) -> Option<Passage<f64>> {
    let [t, sine] = numbers(&entry[0])?[..] else {
        return None;
    };
    let count = |value: &Value| usize::try_from(count(value)?).ok();
    Some(Passage {
        t,
        sine,
        rank: count(&entry[1])?,
        regular: count(&entry[2])?,
    })
}

/// All counters.
fn each(counters: &mut Counters) -> [&mut u64; 11] {
    [
        &mut counters.cheap_accelerations,
        &mut counters.beside_accelerations,
        &mut counters.robust_accelerations,
        &mut counters.rank_decisions,
        &mut counters.undetermined,
        &mut counters.mass_factorisations,
        &mut counters.constraint_factorisations,
        &mut counters.row_choices,
        &mut counters.projections,
        &mut counters.projection_iterations,
        &mut counters.robust_projections,
    ]
}

fn counts(mut counters: Counters) -> [u64; 11] {
    each(&mut counters).map(|count| *count)
}

fn counters(value: &Value) -> Option<Counters> {
    let mut counters = Counters::default();
    let (all, entries) = (each(&mut counters), value.as_array()?);
    if entries.len() != all.len() {
        return None;
    }
    for (counter, entry) in all.into_iter().zip(entries) {
        *counter = count(entry)?;
    }
    Some(counters)
}
