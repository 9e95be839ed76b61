//! A run as JSON, for the script of the page.
//!
//! In:  [`Run`].
//! Out: JSON. Long rows of numbers are there as their bytes, in base 64.

use super::equations::mathml;
use super::live::Live;
use super::sliders::Sliders;
use super::thin::{evenly, kept};
use crate::column::Column;
use crate::comparison::Comparison;
use crate::figure::{added, chosen, coordinates, velocities};
use crate::number::exact;
use crate::plot::{Marks, Panel, Scale};
use crate::scene::is_spatial;
use base64::{Engine, engine::general_purpose::STANDARD};
use bricard_codegen::internals::keywords;
use bricard_driver::{AnyMechanism, Drawn, Scene};
use bricard_runtime::{Quantity, Structure};
use serde_json::{Value, json};
use std::env;
use std::path::Path;

/// Numbers of all curves that a page has room for.
const NUMBERS: usize = 60_000;
/// Rows that are not too many for a curve.
const ROWS: usize = 6000;
/// Numbers of all frames of the moving picture that a page has room for.
const PLACES: usize = 100_000;

/// What a page tells of a run.
pub struct Run<'a> {
    /// The mechanism, as it was set for the run.
    pub mechanism: &'a dyn AnyMechanism,
    /// What the command line calls it.
    pub name: &'a str,
    /// The file of its description and the text of it, as far as it is known.
    pub source: Option<(String, String)>,
    /// Columns besides time, coordinates and velocities.
    pub columns: &'a [Column],
    /// The columns that are drawn over time, by their places in the rows; all if there are
    /// none.
    pub curves: &'a [usize],
    /// The rows; of several runs those of the one that moves.
    pub rows: &'a [Vec<f64>],
    /// The curves of several runs, if there are several.
    pub compared: Option<Comparison>,
    /// What the run that moves is called among several.
    pub moving: &'a str,
    /// What happened, and when.
    pub marks: &'a [Marks],
    /// How it was integrated: pairs of words.
    pub settings: Vec<[String; 2]>,
    /// What came of it: pairs of words.
    pub summary: Vec<[String; 2]>,
    /// Why it ended early.
    pub error: Option<String>,
    /// What keeps the page up to date, if something does.
    pub live: Option<&'a Live>,
    /// The mechanism itself, if the page has sliders.
    pub sliders: Option<&'a Sliders<'a>>,
}

/// All that a page tells of a run.
///
/// # Errors
///
/// Why the mechanism does not answer.
pub fn data(run: &Run) -> Result<Value, String> {
    let structure = run.mechanism.structure();
    let Comparison { times, panels } = curves(run);
    let first = run.mechanism.scene(&run.rows[..run.rows.len().min(1)])?;
    Ok(json!({
        "name": run.name,
        "mechanism": structure.name,
        "docs": structure.docs,
        "program": concat!("bricard ", env!("CARGO_PKG_VERSION")),
        "command": command(),
        "source": run.source.as_ref().map(|(file, text)| json!({ "file": file, "text": text })),
        "words": words_of_the_language(),
        "equations": mathml(run.source.as_ref().map(|(file, text)| (Path::new(file), text.as_str()))),
        "parameters": parameters(structure, &first),
        "start": start(structure, run.rows),
        "settings": run.settings,
        "summary": run.summary,
        "error": run.error,
        "marks": run.marks.iter().enumerate().map(marks).collect::<Vec<_>>(),
        "rows": run.compared.as_ref().map_or(run.rows.len(), |all| all.times.len()),
        "moving": run.moving,
        "times": doubles(&times),
        "panels": panels.iter().map(|p| panel(p, structure)).collect::<Vec<_>>(),
        "scene": moving(run, &first)?,
        "sliders": run.sliders.map(|sliders| sliders.json(structure, run.columns, &first)),
        "live": run.live.map(|live| json!({ "script": live.name(), "version": live.version })),
    }))
}

/// The curves, at as many times as a page has room for.
fn curves(run: &Run) -> Comparison {
    let structure = run.mechanism.structure();
    let places = |rows: &[Vec<f64>]| {
        let width = rows.first().map_or(1, Vec::len);
        kept(rows, (NUMBERS / width).min(ROWS))
    };
    if let Some(compared) = &run.compared {
        return compared.thinned(&places(&compared.rows()));
    }
    let rows: Vec<Vec<f64>> = places(run.rows)
        .into_iter()
        .map(|i| run.rows[i].clone())
        .collect();
    let panels = match run.curves {
        [] => {
            let mut all = coordinates(structure, &rows);
            all.extend(velocities(structure, &rows));
            all.extend(added(structure, run.columns, &rows));
            all
        }
        places => chosen(structure, run.columns, &rows, places),
    };
    let times = rows.iter().filter_map(|row| row.first().copied()).collect();
    Comparison { times, panels }
}

/// The command line that was given, to give it again.
fn command() -> String {
    let words = env::args_os().skip(1).map(|word| {
        let word = word.to_string_lossy().into_owned();
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+".contains(c);
        match !word.is_empty() && word.chars().all(plain) {
            true => word,
            false => format!("'{}'", word.replace('\'', r"'\''")),
        }
    });
    let words: Vec<String> = words.collect();
    format!("bricard {}", words.join(" "))
}

/// The words that are coloured in a description, by what they are.
fn words_of_the_language() -> Value {
    json!({
        "keyword": keywords::statements()
            .chain(keywords::connectives())
            .chain(keywords::directions())
            .chain(["mechanism"])
            .collect::<Vec<_>>(),
        "function": keywords::functions().chain(keywords::shapes()).collect::<Vec<_>>(),
        "constant": keywords::constants().collect::<Vec<_>>(),
    })
}

fn parameters(structure: &Structure, scene: &Scene) -> Vec<Value> {
    let all = structure.parameters.iter().zip(&scene.parameters);
    all.map(|(quantity, value)| described(quantity, *value))
        .collect()
}

/// Coordinates and velocities of the first row.
fn start(structure: &Structure, rows: &[Vec<f64>]) -> Vec<Value> {
    let Some(row) = rows.first() else {
        return Vec::new();
    };
    let coordinates = structure.freedoms();
    let positions = coordinates.iter().zip(row.iter().skip(1));
    let velocities = row.iter().skip(1 + coordinates.len());
    positions
        .zip(velocities)
        .map(|((quantity, value), rate)| {
            let mut start = described(quantity, *value);
            start["rate"] = json!(exact(*rate));
            start
        })
        .collect()
}

fn described(quantity: &Quantity, value: f64) -> Value {
    let Quantity { name, unit, docs } = quantity;
    json!({ "name": name, "unit": unit, "docs": docs.trim(), "value": exact(value) })
}

fn marks((place, marks): (usize, &Marks)) -> Value {
    let shown = &marks.times[..marks.times.len().min(Marks::MOST)];
    // Passages come first, then the events in the order of the description.
    json!({
        "name": marks.name,
        "event": place > 0,
        "times": shown,
        "all": marks.times.len(),
    })
}

fn panel(panel: &Panel, structure: &Structure) -> Value {
    let (kind, low) = match panel.scale {
        Scale::Linear => ("linear", None),
        Scale::Whole => ("whole", None),
        Scale::Logarithmic { low, .. } => ("logarithmic", Some(low)),
    };
    let series = panel.series.iter().map(|series| {
        json!({
            "name": series.name,
            "docs": documentation(&series.name, structure),
            "values": doubles(&series.values),
        })
    });
    json!({
        "axis": panel.axis,
        "scale": kind,
        "low": low,
        "series": series.collect::<Vec<_>>(),
    })
}

/// What the description says of a column.
fn documentation(name: &str, structure: &Structure) -> String {
    let quantities = structure.coordinates.iter().chain(structure.outputs);
    let of = |name: &str| {
        let mut all = quantities.clone();
        let found = all.find(|quantity| quantity.name == name);
        found.map(|quantity| quantity.docs.trim().to_string())
    };
    let inside = name
        .strip_prefix("der(")
        .and_then(|rest| rest.strip_suffix(')'));
    match inside.and_then(of).filter(|docs| !docs.is_empty()) {
        Some(docs) => format!("rate of: {docs}"),
        None => of(name).unwrap_or_default(),
    }
}

/// The moving picture, if something is drawn.
fn moving(run: &Run, first: &Scene) -> Result<Option<Value>, String> {
    let Some(frame) = first.frames.first().filter(|frame| !frame.is_empty()) else {
        return Ok(None);
    };
    let places = evenly(run.rows.len(), (PLACES / frame.len()).min(ROWS));
    let rows: Vec<Vec<f64>> = places.iter().map(|i| run.rows[*i].clone()).collect();
    let scene = run.mechanism.scene(&rows)?;
    let times: Vec<f64> = rows.iter().filter_map(|row| row.first().copied()).collect();
    let shapes = scene.shapes.iter().map(|shape| match shape {
        Drawn::Line(points) => json!({ "kind": "line", "points": points }),
        Drawn::Polygon(points) => json!({ "kind": "polygon", "points": points }),
        Drawn::Circle => json!({ "kind": "circle", "points": 1 }),
        Drawn::Trace => json!({ "kind": "trace", "points": 1 }),
    });
    Ok(Some(json!({
        "shapes": shapes.collect::<Vec<_>>(),
        "spatial": is_spatial(&scene),
        "times": doubles(&times),
        "frames": singles(scene.frames.iter().flatten()),
    })))
}

fn doubles(values: &[f64]) -> String {
    let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
    STANDARD.encode(bytes)
}

/// As many digits as a picture needs.
fn singles<'a>(values: impl Iterator<Item = &'a f64>) -> String {
    let bytes: Vec<u8> = values.flat_map(|x| (*x as f32).to_le_bytes()).collect();
    STANDARD.encode(bytes)
}
