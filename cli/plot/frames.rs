//! Configurations of a mechanism, side by side.

use super::Sheet;
use super::curve::has_place;
use super::sheet::{Area, Drawn, px};
use super::style::{DETAIL, GHOST, GRID, TEXT, colour, letters};
use crate::error::CommandError;
use plotters::prelude::*;
use std::path::Path;

/// A part of the picture of a mechanism, in metres.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// An open polygon.
    Line(Vec<[f64; 2]>),
    /// A closed, filled polygon.
    Polygon(Vec<[f64; 2]>),
    /// A circle.
    Circle([f64; 2], f64),
    /// A point whose path is wanted.
    Trace([f64; 2]),
}

/// A configuration and those shortly before it.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// What stands above it.
    pub caption: String,
    /// The configuration.
    pub now: Vec<Shape>,
    /// Earlier configurations, drawn faintly.
    pub before: Vec<Vec<Shape>>,
}

impl Shape {
    /// Its points.
    pub fn points(&self) -> &[[f64; 2]] {
        match self {
            Self::Line(points) | Self::Polygon(points) => points,
            Self::Circle(point, _) | Self::Trace(point) => std::slice::from_ref(point),
        }
    }

    /// How far it reaches around its points.
    pub fn radius(&self) -> f64 {
        match self {
            Self::Circle(_, radius) => radius.abs(),
            _ => 0.0,
        }
    }

    /// Whether all of it can be drawn.
    fn has_place(&self) -> bool {
        let numbers = self.points().iter().flatten().copied();
        numbers.chain([self.radius()]).all(has_place)
    }
}

/// Frames in a row, where there is room.
const COLUMNS: usize = 3;
/// Width of a frame on the screen (pixels).
const WIDTH: u32 = 300;
/// Height of a caption (pixels).
const CAPTION: u32 = 26;
/// Empty border around what is drawn, as a fraction of its size.
const BORDER: f64 = 0.08;
/// What is smaller than this, relative to its place, is drawn as if it were so large
/// (one at the origin: in metres).
const SMALLEST: f64 = 1e-9;

/// Draws configurations in one scale, equal in both directions.
///
/// # Errors
///
/// As [`Sheet::draw`].
pub fn frames_as_svg(sheet: &Sheet, frames: &[Frame]) -> Result<String, CommandError> {
    strip(sheet, frames, bounds(frames))
}

/// Draws each configuration for itself, all in one scale.
///
/// # Errors
///
/// As [`Sheet::draw`].
pub fn film_as_svg<'a>(
    path: &'a Path,
    title: &'a str,
    frames: &'a [Frame],
) -> impl Iterator<Item = Result<String, CommandError>> + 'a {
    let bounds = bounds(frames);
    let each = frames.iter().map(std::slice::from_ref);
    each.map(move |frame| strip(&Sheet::screen(path, title), frame, bounds))
}

fn strip(
    sheet: &Sheet,
    frames: &[Frame],
    bounds: ([f64; 2], [f64; 2]),
) -> Result<String, CommandError> {
    let (across, up) = (bounds.1[0] - bounds.0[0], bounds.1[1] - bounds.0[1]);
    let most = if sheet.is_narrow() { 2 } else { COLUMNS };
    let columns = u32::try_from(frames.len().clamp(1, most)).unwrap_or(1);
    let rows = u32::try_from(frames.len().div_ceil(most)).unwrap_or(1);
    let wide = sheet
        .pixels()
        .map_or(WIDTH, |pixels| (pixels - 24) / columns);
    let picture = (f64::from(wide) * (up / across).clamp(0.3, 2.0)) as u32;
    let size = (
        sheet.pixels().unwrap_or(columns * wide + 24),
        sheet.head() + rows * (CAPTION + picture + 8) + 8,
    );
    sheet.draw(size, |root| {
        sheet.heading(root, 12)?;
        for (i, frame) in (0u32..).zip(frames) {
            let corner = (
                12 + (i % columns) * wide,
                sheet.head() + (i / columns) * (CAPTION + picture + 8),
            );
            let size = (wide * DETAIL, (CAPTION + picture) * DETAIL);
            let area = root.clone().shrink(px(corner.0, corner.1), size);
            draw(&area, frame, &Projection::new(bounds, (wide, picture)))?;
        }
        Ok(())
    })
}

/// Metres to pixels of a frame.
struct Projection {
    corner: [f64; 2],
    scale: f64,
    height: f64,
}

impl Projection {
    fn new(bounds: ([f64; 2], [f64; 2]), (width, height): (u32, u32)) -> Self {
        let detail = f64::from(DETAIL);
        let (width, height) = (f64::from(width - 10) * detail, f64::from(height) * detail);
        let size = [bounds.1[0] - bounds.0[0], bounds.1[1] - bounds.0[1]];
        let scale = (width / size[0]).min(height / size[1]);
        let spare = [width / scale - size[0], height / scale - size[1]];
        let corner = [bounds.0[0] - spare[0] / 2.0, bounds.0[1] - spare[1] / 2.0];
        Self {
            corner,
            scale,
            height: height + f64::from(CAPTION) * detail,
        }
    }

    fn pixel(&self, point: [f64; 2]) -> (i32, i32) {
        let x = (point[0] - self.corner[0]) * self.scale;
        let y = self.height - (point[1] - self.corner[1]) * self.scale;
        (x.round() as i32, y.round() as i32)
    }
}

/// The corners of what is drawn in frames, with a border.
fn bounds(frames: &[Frame]) -> ([f64; 2], [f64; 2]) {
    let before = frames
        .iter()
        .flat_map(|frame| frame.before.iter().flatten());
    bounds_of(before.chain(frames.iter().flat_map(|frame| &frame.now)))
}

/// The corners of shapes, with a border.
pub fn bounds_of<'a>(shapes: impl Iterator<Item = &'a Shape>) -> ([f64; 2], [f64; 2]) {
    let mut corners = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let mut include = |point: [f64; 2], radius: f64| {
        for (axis, x) in point.into_iter().enumerate() {
            corners.0[axis] = corners.0[axis].min(x - radius);
            corners.1[axis] = corners.1[axis].max(x + radius);
        }
    };
    let all = shapes.filter(|shape| shape.has_place());
    for shape in all {
        let points = shape.points().iter();
        points.for_each(|point| include(*point, shape.radius()));
    }
    let numbers = || corners.0.iter().chain(&corners.1);
    if !numbers().all(|x| x.is_finite()) {
        return ([-1.0; 2], [1.0; 2]);
    }
    let farthest = numbers().fold(1.0, |most: f64, x| most.max(x.abs()));
    let longest = (corners.1[0] - corners.0[0])
        .max(corners.1[1] - corners.0[1])
        .max(SMALLEST * farthest);
    let border = BORDER * longest;
    (corners.0.map(|x| x - border), corners.1.map(|x| x + border))
}

fn draw(area: &Area, frame: &Frame, projection: &Projection) -> Drawn {
    let (width, height) = area.dim_in_pixel();
    let edge = |v: u32| i32::try_from(v).unwrap_or(0);
    let right = edge(width) - 10 * edge(DETAIL);
    let top = edge(CAPTION * DETAIL);
    area.draw(&Rectangle::new(
        [(0, top), (right, edge(height))],
        GRID.stroke_width(DETAIL),
    ))?;
    let caption = frame.caption.clone();
    area.draw(&Text::new(caption, px(0, 6), letters(TEXT)))?;
    for shape in frame.before.iter().flatten().filter(|s| s.has_place()) {
        draw_shape(area, shape, projection, GHOST, 1)?;
    }
    let mut lines = 0;
    for shape in frame.now.iter().filter(|s| s.has_place()) {
        let ink = colour(lines);
        lines += usize::from(matches!(shape, Shape::Line(_)));
        draw_shape(area, shape, projection, ink, 3)?;
    }
    Ok(())
}

fn draw_shape(
    area: &Area,
    shape: &Shape,
    projection: &Projection,
    ink: RGBColor,
    width: u32,
) -> Drawn {
    let pixels = |points: &[[f64; 2]]| -> Vec<(i32, i32)> {
        points
            .iter()
            .map(|point| projection.pixel(*point))
            .collect()
    };
    match shape {
        Shape::Line(points) => {
            let path = pixels(points);
            area.draw(&PathElement::new(
                path.clone(),
                ink.stroke_width(width * DETAIL),
            ))?;
            let joint = |at| Circle::new(at, (width + 1) * DETAIL, ink.filled());
            path.into_iter().try_for_each(|at| area.draw(&joint(at)))
        }
        Shape::Polygon(points) => area.draw(&Polygon::new(pixels(points), ink.mix(0.4).filled())),
        Shape::Circle(centre, radius) => {
            let radius = (radius.abs() * projection.scale).round() as u32;
            let style = ink.stroke_width(width * DETAIL);
            area.draw(&Circle::new(projection.pixel(*centre), radius, style))
        }
        Shape::Trace(point) => area.draw(&Circle::new(
            projection.pixel(*point),
            2 * DETAIL,
            ink.filled(),
        )),
    }
}
