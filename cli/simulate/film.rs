//! A film of a run: a moving picture, or a strip of configurations.
//!
//! In:  rows of a run.
//! Out: a GIF; an SVG, PNG or PDF with a few of its frames.

use crate::error::CommandError;
use crate::files::is_of;
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
/// How long a moving picture lasts at most (s): a longer run is shown faster.
const LONGEST: f64 = 10.0;
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
    let scene = |rows: &[&Vec<f64>]| {
        let rows: Vec<Vec<f64>> = rows.iter().map(|row| (*row).clone()).collect();
        mechanism.scene(&rows).map_err(failed)
    };
    let (begin, end) = (time(rows.first()), time(rows.last()));
    if is_of(path, &["gif"]) {
        let count = (((end - begin) * RATE).ceil() as usize).clamp(2, MOST);
        let chosen = nearest(rows, spread(begin, end, count));
        let frames = moving(&chosen, &scene(&chosen)?);
        let pace = (LONGEST / (end - begin)).min(1.0);
        let bytes = gif(path, title, &frames, &delays(&chosen, pace))?;
        return replace(path, &bytes);
    }
    let apart = APART * (end - begin) / (STRIP - 1) as f64;
    let now = nearest(rows, spread(begin, end, STRIP));
    let before = |row: &&Vec<f64>| {
        let times = (1..=GHOSTS).rev().map(|k| row[0] - apart * k as f64);
        let earlier = nearest(rows, times.filter(|t| *t >= begin));
        earlier
            .into_iter()
            .filter(|other| other[0] < row[0])
            .collect()
    };
    let before: Vec<Vec<&Vec<f64>>> = now.iter().map(before).collect();
    let groups = now.iter().zip(&before);
    let all: Vec<&Vec<f64>> = groups
        .flat_map(|(now, before)| before.iter().chain([now]).copied())
        .collect();
    let frames = still(&now, &before, &scene(&all)?);
    raster::write(path, &frames_as_svg(sheet, &frames)?, sheet.width.is_some())
}

fn time(row: Option<&Vec<f64>>) -> f64 {
    row.and_then(|row| row.first()).copied().unwrap_or(0.0)
}

/// The rows that are nearest to some times, each once: a picture shows a configuration that was
/// computed, with its time.
fn nearest(rows: &[Vec<f64>], times: impl IntoIterator<Item = f64>) -> Vec<&Vec<f64>> {
    let place = |t: f64| {
        let after = rows.partition_point(|row| row[0] < t).min(rows.len() - 1);
        let before = after.saturating_sub(1);
        match t - rows[before][0] < rows[after][0] - t {
            true => before,
            false => after,
        }
    };
    let mut places: Vec<usize> = times.into_iter().map(place).collect();
    places.dedup();
    places.into_iter().map(|place| &rows[place]).collect()
}

/// How long each frame is shown, in hundredths of a second.
fn delays(rows: &[&Vec<f64>], pace: f64) -> Vec<u16> {
    let shown = |pair: &[&Vec<f64>]| {
        let delay = (HUNDREDTHS * pace * (pair[1][0] - pair[0][0])).round();
        delay.clamp(2.0, 1000.0) as u16
    };
    let mut delays: Vec<u16> = rows.windows(2).map(shown).collect();
    delays.push(delays.last().copied().unwrap_or(100));
    delays
}

/// Times at equal distances, both ends among them.
fn spread(begin: f64, end: f64, count: usize) -> Vec<f64> {
    let step = (end - begin) / (count - 1) as f64;
    (0..count).map(|i| begin + step * i as f64).collect()
}

fn caption(t: f64) -> String {
    format!("t = {t:.2} s")
}

/// The frames of a strip, each with those before it.
fn still(now: &[&Vec<f64>], before: &[Vec<&Vec<f64>>], scene: &Scene) -> Vec<Frame> {
    let spatial = is_spatial(scene);
    let mut drawn = scene
        .frames
        .iter()
        .map(|frame| shapes(scene, frame, spatial));
    let groups = now.iter().zip(before);
    groups
        .map(|(row, before)| Frame {
            before: drawn.by_ref().take(before.len()).collect(),
            now: drawn.next().unwrap_or_default(),
            caption: caption(row[0]),
        })
        .collect()
}

/// The frames of a moving picture, each with the paths of its points.
fn moving(rows: &[&Vec<f64>], scene: &Scene) -> Vec<Frame> {
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
    let frame = |(i, row): (usize, &&Vec<f64>)| Frame {
        caption: caption(row[0]),
        now: all.get(i).cloned().unwrap_or_default(),
        before: all[i.saturating_sub(TRAIL)..i].iter().map(trace).collect(),
    };
    rows.iter().enumerate().map(frame).collect()
}

/// A moving picture; the delays are in hundredths of a second.
fn gif(
    path: &Path,
    title: &str,
    frames: &[Frame],
    delays: &[u16],
) -> Result<Vec<u8>, CommandError> {
    let failed = |reason: String| CommandError::Draw(path.to_path_buf(), reason);
    let mut pictures = Vec::new();
    for (svg, delay) in film_as_svg(path, title, frames).zip(delays) {
        let pixels = pixels(&svg?, DETAIL).map_err(failed)?;
        let side = |length: u32| u16::try_from(length).unwrap_or(u16::MAX);
        let (width, height) = (side(pixels.width()), side(pixels.height()));
        let mut colours = pixels.take();
        let mut picture = gif::Frame::from_rgba_speed(width, height, &mut colours, MATCHING);
        picture.delay = *delay;
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
