//! Work-precision diagrams: time over error, both by powers of ten.

use super::axis::power_of_ten;
use super::curve::ends;
use super::sheet::{Area, Drawn, Sheet, px};
use super::style::{DETAIL, GRID, INK, STROKE, TEXT, colour, letters, level};
use crate::error::CommandError;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use std::path::Path;

/// Size of the diagram (pixels).
const SIZE: (u32, u32) = (700, 520);
/// Width of the legend (pixels).
const LEGEND: u32 = 210;
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

impl Cloud {
    /// How its points are painted.
    fn paint(&self) -> ShapeStyle {
        let ink = colour(self.colour);
        match self.mark {
            Mark::Disc | Mark::Triangle => ink.filled(),
            Mark::Ring | Mark::Cross => ink.stroke_width(STROKE),
        }
    }

    /// How they are joined.
    fn line(&self) -> ShapeStyle {
        colour(self.colour).mix(0.55).stroke_width(STROKE)
    }
}

/// Draws time (s) over error; `path` is where it will go, for messages.
///
/// # Errors
///
/// As [`Sheet::draw`].
pub fn work_diagram(path: &Path, title: &str, clouds: &[Cloud]) -> Result<String, CommandError> {
    let sheet = Sheet::screen(path, title);
    sheet.draw((SIZE.0 + LEGEND, SIZE.1 + sheet.head()), |root| {
        sheet.heading(root, 86)?;
        let (_, rest) = root.split_vertically(sheet.head() * DETAIL);
        let (left, right) = rest.split_horizontally(SIZE.0 * DETAIL);
        diagram(&left, clouds)?;
        legend(&right, clouds)
    })
}

/// Powers of ten around all values.
fn range(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) = ends(values);
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
        .label_style(letters(TEXT))
        .axis_desc_style(letters(TEXT))
        .set_all_tick_mark_size(5 * DETAIL)
        .x_labels(across)
        .y_labels(up)
        .x_desc("largest error of a coordinate at the end [m, rad]")
        .y_desc("time of a run [s]")
        .x_label_formatter(&|x| power_of_ten(*x))
        .y_label_formatter(&|y| power_of_ten(*y))
        .draw()?;
    for (cloud, points) in clouds.iter().zip(&placed) {
        chart.draw_series(LineSeries::new(points.iter().copied(), cloud.line()))?;
        let (paint, points) = (cloud.paint(), points.iter().copied());
        match cloud.mark {
            Mark::Disc | Mark::Ring => {
                chart.draw_series(points.map(|at| Circle::new(at, RADIUS, paint)))?
            }
            Mark::Cross => chart.draw_series(points.map(|at| Cross::new(at, RADIUS, paint)))?,
            Mark::Triangle => {
                chart.draw_series(points.map(|at| TriangleMarker::new(at, RADIUS, paint)))?
            }
        };
    }
    Ok(())
}

fn legend(area: &Area, clouds: &[Cloud]) -> Drawn {
    for (i, cloud) in (0u32..).zip(clouds) {
        let y = 22 + LINE * i;
        let (at, paint, line) = (px(20, y), cloud.paint(), cloud.line());
        area.draw(&PathElement::new(vec![px(6, y), px(34, y)], line))?;
        match cloud.mark {
            Mark::Disc | Mark::Ring => area.draw(&Circle::new(at, RADIUS, paint))?,
            Mark::Cross => area.draw(&Cross::new(at, RADIUS, paint))?,
            Mark::Triangle => area.draw(&TriangleMarker::new(at, RADIUS, paint))?,
        }
        let name = cloud.name.clone();
        area.draw(&Text::new(name, px(42, y), level(HPos::Left)))?;
    }
    Ok(())
}
