//! A film of a run: a moving picture, or a strip of configurations.
//!
//! In:  rows of a run.
//! Out: a GIF; an SVG, PNG or PDF with a few of its frames.

use crate::error::CommandError;
use crate::output::replace;
use crate::plot::{Frame, Shape, Sheet, film_as_svg, frames_as_svg};
use crate::raster::{self, pixels};
use crate::scene::{is_spatial, shapes};
use bricard_driver::{AnyMechanism, Scene};
use gif::{Encoder, EncodingError, Repeat};
use std::path::Path;

/// Frames of a strip.
const STRIP: usize = 6;
/// Frames of a moving picture for each second, and the most of them.
const RATE: f64 = 25.0;
const MOST: usize = 250;
/// Earlier configurations that a strip shows faintly, and how far apart they are, as a part
/// of the distance of its frames.
const GHOSTS: usize = 3;
const APART: f64 = 0.12;
/// Frames of which a moving picture shows the paths of points.
const TRAIL: usize = 40;
/// Hundredths of a second: the unit of time of a GIF.
const HUNDREDTHS: f64 = 100.0;
/// Pixels of a moving picture for each of the drawing.
const DETAIL: f32 = 1.5;
/// How closely colours are matched: 1 is best, 30 fastest.
const MATCHING: i32 = 10;

/// Whether a file of this name is a moving picture.
fn moves(path: &Path) -> bool {
    path.extension()
        .is_some_and(|kind| kind.eq_ignore_ascii_case("gif"))
}

/// Draws a film of rows that are not empty.
///
/// # Errors
///
/// [`CommandError::Draw`], [`CommandError::Write`].
pub fn film(
    sheet: &Sheet,
    mechanism: &dyn AnyMechanism,
    rows: &[Vec<f64>],
) -> Result<(), CommandError> {
    let Sheet { path, title, .. } = *sheet;
    let failed = |reason: String| CommandError::Draw(path.to_path_buf(), reason);
    if !mechanism.structure().drawn {
        let reason = "the description draws nothing; add statements such as \
                      `draw line([0, 0], A);`";
        return Err(failed(reason.to_string()));
    }
    let time = |row: Option<&Vec<f64>>| row.and_then(|row| row.first()).copied().unwrap_or(0.0);
    let (begin, end) = (time(rows.first()), time(rows.last()));
    let at = |t: f64| {
        let after = rows.partition_point(|row| row[0] < t - 1e-9);
        rows[after.min(rows.len() - 1)].clone()
    };
    let seen = |times: &[f64]| {
        let rows: Vec<Vec<f64>> = times.iter().map(|t| at(*t)).collect();
        mechanism.scene(&rows).map_err(failed)
    };
    if moves(path) {
        let count = (((end - begin) * RATE).ceil() as usize).clamp(2, MOST);
        let times = spread(begin, end, count);
        let frames = moving(&times, &seen(&times)?);
        let delay = (HUNDREDTHS * (end - begin) / (count - 1) as f64).round();
        let bytes = gif(path, title, &frames, delay.clamp(2.0, 1000.0) as u16)?;
        return replace(path, &bytes);
    }
    let shown = spread(begin, end, STRIP);
    let apart = APART * (end - begin) / (STRIP - 1) as f64;
    let earlier = |t: f64| {
        (0..=GHOSTS)
            .rev()
            .map(move |k| (t - apart * k as f64).max(begin))
    };
    let times: Vec<f64> = shown.iter().flat_map(|t| earlier(*t)).collect();
    let frames = still(&shown, &seen(&times)?);
    raster::write(path, &frames_as_svg(sheet, &frames)?, sheet.width.is_some())
}

/// Times at equal distances, both ends among them.
fn spread(begin: f64, end: f64, count: usize) -> Vec<f64> {
    let step = (end - begin) / (count - 1) as f64;
    (0..count).map(|i| begin + step * i as f64).collect()
}

fn caption(t: f64) -> String {
    format!("t = {t:.2} s")
}

/// The frames of a strip, of scenes with those before each.
fn still(times: &[f64], scene: &Scene) -> Vec<Frame> {
    let spatial = is_spatial(scene);
    let drawn = |frame: &Vec<f64>| shapes(scene, frame, spatial);
    let groups = scene.frames.chunks(GHOSTS + 1).zip(times);
    groups
        .map(|(group, t)| {
            let (now, before) = group
                .split_last()
                .map_or((None, group), |(x, y)| (Some(x), y));
            Frame {
                caption: caption(*t),
                now: now.map(drawn).unwrap_or_default(),
                before: before.iter().map(drawn).collect(),
            }
        })
        .collect()
}

/// The frames of a moving picture, each with the paths of its points.
fn moving(times: &[f64], scene: &Scene) -> Vec<Frame> {
    let spatial = is_spatial(scene);
    let all: Vec<Vec<Shape>> = scene
        .frames
        .iter()
        .map(|frame| shapes(scene, frame, spatial))
        .collect();
    let trace = |shapes: &Vec<Shape>| {
        let points = shapes.iter().filter(|s| matches!(s, Shape::Trace(_)));
        points.cloned().collect::<Vec<_>>()
    };
    let frame = |(i, t): (usize, &f64)| Frame {
        caption: caption(*t),
        now: all.get(i).cloned().unwrap_or_default(),
        before: all[i.saturating_sub(TRAIL)..i].iter().map(trace).collect(),
    };
    times.iter().enumerate().map(frame).collect()
}

/// A moving picture; `delay` is in hundredths of a second.
fn gif(path: &Path, title: &str, frames: &[Frame], delay: u16) -> Result<Vec<u8>, CommandError> {
    let failed = |reason: String| CommandError::Draw(path.to_path_buf(), reason);
    let mut pictures = Vec::new();
    for svg in film_as_svg(path, title, frames) {
        let pixels = pixels(&svg?, DETAIL).map_err(failed)?;
        let side = |length: u32| u16::try_from(length).unwrap_or(u16::MAX);
        let (width, height) = (side(pixels.width()), side(pixels.height()));
        let mut colours = pixels.take();
        let mut picture = gif::Frame::from_rgba_speed(width, height, &mut colours, MATCHING);
        picture.delay = delay;
        pictures.push(picture);
    }
    let (width, height) = pictures
        .first()
        .map_or((1, 1), |first| (first.width, first.height));
    let mut bytes = Vec::new();
    let mut encode = || -> Result<(), EncodingError> {
        let mut encoder = Encoder::new(&mut bytes, width, height, &[])?;
        encoder.set_repeat(Repeat::Infinite)?;
        let mut all = pictures.iter();
        all.try_for_each(|picture| encoder.write_frame(picture))
    };
    encode().map_err(|error| failed(error.to_string()))?;
    Ok(bytes)
}
