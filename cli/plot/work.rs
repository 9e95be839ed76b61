//! Work-precision diagrams: time over error, both by powers of ten.

use super::axis::{power_of_ten, px};
use super::style::{DETAIL, FONT, GRID, HEADING, INK, STROKE, TEXT, colour};
use super::svg::{self, Area, Drawn};
use crate::error::CommandError;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::path::Path;

/// Size of the diagram (pixels).
const SIZE: (u32, u32) = (700, 520);
/// Width of the legend (pixels).
const LEGEND: u32 = 210;
/// Height of the title (pixels).
const TITLE: u32 = 36;
/// Distance of the lines of the legend (pixels).
const LINE: u32 = 20;
/// Radius of a mark.
const RADIUS: u32 = 4 * DETAIL;
/// Errors below are drawn here: they are round-off.
const LEAST_ERROR: f64 = 1e-17;

/// Points of one kind, in the order in which they are joined.
#[derive(Clone, Debug, PartialEq)]
pub struct Cloud {
    /// What the legend says.
    pub name: String,
    /// Place of the colour.
    pub colour: usize,
    /// How points look.
    pub mark: Mark,
    /// Error and time (s).
    pub points: Vec<(f64, f64)>,
}

/// How a point looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Filled.
    Disc,
    /// Hollow.
    Ring,
    /// Two strokes.
    Cross,
    /// Three corners.
    Triangle,
}

/// Draws time (s) over error; `path` is where it will go, for messages.
///
/// # Errors
///
/// As [`svg::text`].
pub fn work_diagram(path: &Path, title: &str, clouds: &[Cloud]) -> Result<String, CommandError> {
    let size = (SIZE.0 + LEGEND, SIZE.1 + TITLE);
    svg::text(path, size, |root| {
        let (head, rest) = root.split_vertically(TITLE * DETAIL);
        let style = TextStyle::from((FONT, HEADING).into_font()).color(&INK);
        head.draw(&Text::new(title.to_string(), px(86, 10), style))?;
        let (left, right) = rest.split_horizontally(SIZE.0 * DETAIL);
        diagram(&left, clouds)?;
        legend(&right, clouds)
    })
}

/// Powers of ten around all values.
fn range(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in values {
        (low, high) = (low.min(value), high.max(value));
    }
    if low > high {
        return 0.0..1.0;
    }
    let (low, high) = ((low - 0.1).floor(), (high + 0.1).ceil());
    low..high
}

/// Error and time of the points as exponents; those that are no numbers have no place.
fn exponents(cloud: &Cloud) -> Vec<(f64, f64)> {
    let drawn = |(error, time): &&(f64, f64)| {
        error.is_finite() && time.is_finite() && *time >= f64::MIN_POSITIVE
    };
    let place = |(error, time): &(f64, f64)| (error.max(LEAST_ERROR).log10(), time.log10());
    cloud.points.iter().filter(drawn).map(place).collect()
}

fn diagram(area: &Area, clouds: &[Cloud]) -> Drawn {
    let placed: Vec<_> = clouds.iter().map(exponents).collect();
    let errors = range(placed.iter().flatten().map(|point| point.0));
    let times = range(placed.iter().flatten().map(|point| point.1));
    let ticks = |range: &std::ops::Range<f64>| (range.end - range.start) as usize + 1;
    let (across, up) = (ticks(&errors), ticks(&times));
    let text = TextStyle::from((FONT, TEXT).into_font()).color(&INK);
    let mut chart = ChartBuilder::on(area)
        .margin_top(8 * DETAIL)
        .margin_right(14 * DETAIL)
        .margin_left(10 * DETAIL)
        .margin_bottom(8 * DETAIL)
        .set_label_area_size(LabelAreaPosition::Left, 76 * DETAIL)
        .set_label_area_size(LabelAreaPosition::Bottom, 48 * DETAIL)
        .build_cartesian_2d(errors, times)?;
    chart
        .configure_mesh()
        .max_light_lines(0)
        .bold_line_style(GRID.stroke_width(DETAIL))
        .axis_style(INK.stroke_width(DETAIL))
        .label_style(text.clone())
        .axis_desc_style(text)
        .set_all_tick_mark_size(5 * DETAIL)
        .x_labels(across)
        .y_labels(up)
        .x_desc("largest error of a coordinate at the end [m, rad]")
        .y_desc("time of a run [s]")
        .x_label_formatter(&|x| power_of_ten(*x))
        .y_label_formatter(&|y| power_of_ten(*y))
        .draw()?;
    for (cloud, points) in clouds.iter().zip(&placed) {
        let line = colour(cloud.colour).mix(0.55).stroke_width(STROKE);
        chart.draw_series(LineSeries::new(points.iter().copied(), line))?;
        let paint = colour(cloud.colour);
        match cloud.mark {
            Mark::Disc => chart.draw_series(
                points
                    .iter()
                    .map(|at| Circle::new(*at, RADIUS, paint.filled())),
            )?,
            Mark::Ring => chart.draw_series(
                points
                    .iter()
                    .map(|at| Circle::new(*at, RADIUS, paint.stroke_width(STROKE))),
            )?,
            Mark::Cross => chart.draw_series(
                points
                    .iter()
                    .map(|at| Cross::new(*at, RADIUS, paint.stroke_width(STROKE))),
            )?,
            Mark::Triangle => chart.draw_series(
                points
                    .iter()
                    .map(|at| TriangleMarker::new(*at, RADIUS, paint.filled())),
            )?,
        };
    }
    Ok(())
}

fn legend(area: &Area, clouds: &[Cloud]) -> Drawn {
    let anchor = Pos::new(HPos::Left, VPos::Center);
    let style = TextStyle::from((FONT, TEXT).into_font())
        .color(&INK)
        .pos(anchor);
    for (i, cloud) in (0u32..).zip(clouds) {
        let y = 22 + LINE * i;
        let paint = colour(cloud.colour);
        let at = px(20, y);
        area.draw(&PathElement::new(
            vec![px(6, y), px(34, y)],
            paint.mix(0.55).stroke_width(STROKE),
        ))?;
        match cloud.mark {
            Mark::Disc => area.draw(&Circle::new(at, RADIUS, paint.filled()))?,
            Mark::Ring => area.draw(&Circle::new(at, RADIUS, paint.stroke_width(STROKE)))?,
            Mark::Cross => area.draw(&Cross::new(at, RADIUS, paint.stroke_width(STROKE)))?,
            Mark::Triangle => area.draw(&TriangleMarker::new(at, RADIUS, paint.filled()))?,
        }
        area.draw(&Text::new(cloud.name.clone(), px(42, y), style.clone()))?;
    }
    Ok(())
}
