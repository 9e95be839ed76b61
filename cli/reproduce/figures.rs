//! The paper's result figures.

use super::experiment::Outcome;
use crate::error::CommandError;
use crate::figure::{ERRORS, coordinates, series};
use crate::output::write;
use crate::plot::{Frame, Marks, Panel, Sheet, Times, frames_as_svg, panels_as_svg};
use crate::scene::shapes;
use std::path::Path;

/// Configurations that are drawn of the first second.
const FRAMES: usize = 6;
/// Time between the fainter configurations before each of them (s).
const GHOST_STEP: f64 = 0.05;
/// How many there are.
const GHOSTS: usize = 3;

/// File, title and experiment of each figure, in the order of the experiments.
const FIGURES: [(&str, &str); 4] = [
    ("figure_2.svg", "Fig. 2  Slider–crank without moment"),
    (
        "figure_3.svg",
        "Fig. 3  Slider–crank with moment u = 10 − 2 der(q1), 8 s",
    ),
    (
        "figure_4.svg",
        "Fig. 4  Slider–crank with moment u = 10 − 2 der(q1), 20 s",
    ),
    ("figure_6.svg", "Fig. 6  Double four-bar"),
];

/// Draws the figures into a folder. Returns the files.
///
/// # Errors
///
/// [`CommandError::Draw`] and [`CommandError::Write`].
pub fn draw(folder: &Path, outcomes: &[Outcome]) -> Result<Vec<String>, CommandError> {
    let mut written = Vec::new();
    for ((file, title), outcome) in FIGURES.iter().zip(outcomes) {
        let path = folder.join(file);
        let times: Vec<f64> = outcome
            .rows
            .iter()
            .filter_map(|row| row.first().copied())
            .collect();
        let passages = outcome.report.passages.iter();
        let marks = [Marks {
            times: passages.map(|passage| passage.t).collect(),
            name: "singular position".to_string(),
        }];
        let times = Times {
            values: &times,
            marks: &marks,
        };
        let sheet = Sheet::screen(&path, title);
        write(&path, &panels_as_svg(&sheet, times, &diagrams(outcome))?)?;
        written.push(path.display().to_string());
    }
    if let Some(outcome) = outcomes.last() {
        let path = folder.join("figure_6_configurations.svg");
        let title = "Fig. 6  Double four-bar: configurations in the first second (faint: the 0.15 s before)";
        let sheet = Sheet::screen(&path, title);
        write(&path, &frames_as_svg(&sheet, &configurations(outcome))?)?;
        written.push(path.display().to_string());
    }
    Ok(written)
}

/// Coordinates, and constraint errors at the level of positions and velocities.
fn diagrams(outcome: &Outcome) -> Vec<Panel> {
    let structure = outcome.mechanism.structure();
    let mut panels = coordinates(structure, &outcome.rows);
    let first = 1 + 2 * structure.coordinates.len();
    let errors = |axis: &str, name: &str, column| Panel {
        axis: axis.to_string(),
        scale: ERRORS,
        series: vec![series(name.to_string(), column, &outcome.rows)],
    };
    panels.push(errors("position error [m]", "max |g|", first));
    panels.push(errors("velocity error [m/s]", "max |dg/dt|", first + 1));
    panels
}

/// The mechanism at equal distances in the first second, each with what came
/// shortly before.
fn configurations(outcome: &Outcome) -> Vec<Frame> {
    let at = |t: f64| {
        let nearest = outcome.rows.iter().min_by(|a, b| {
            let away = |row: &Vec<f64>| row.first().map_or(f64::INFINITY, |x| (x - t).abs());
            away(a).total_cmp(&away(b))
        });
        let scene = nearest.and_then(|row| outcome.mechanism.scene(std::slice::from_ref(row)).ok());
        let drawn = scene.as_ref().and_then(|scene| {
            let frame = scene.frames.first()?;
            Some(shapes(scene, frame, false))
        });
        drawn.unwrap_or_default()
    };
    let frame = |i: usize| {
        let t = i as f64 / (FRAMES - 1) as f64;
        let before = (1..=GHOSTS).rev().map(|k| t - GHOST_STEP * k as f64);
        let before = before.filter(|t| *t > -1e-9).map(at).collect();
        Frame {
            caption: format!("t = {t:.1} s"),
            now: at(t),
            before,
        }
    };
    (0..FRAMES).map(frame).collect()
}
