//! Panels of curves over time, one below the other.

use super::axis::{Axis, power_of_ten};
use super::curve::{Curve, curves, has_place};
use super::legend::{self, Entry, Kind};
use super::sheet::{Area, Drawn};
use super::style::{DETAIL, DOT, GRID, INK, STROKE, TEXT, colour, letters, mark};
use super::{Panel, Scale, Sheet};
use crate::error::CommandError;
use plotters::prelude::*;

/// Width of a picture (pixels).
const WIDTH: u32 = 860;
/// Height of a panel (pixels).
const PANEL: u32 = 190;
/// Height that the axis of time adds to the last panel (pixels).
const TIME_AXIS: u32 = 44;
/// Margins to the left and to the right of a diagram (pixels).
const MARGINS: (u32, u32) = (14, 8);
/// Width that a tick of time has for its number (pixels), about.
const WIDTH_OF_TICK: u32 = 75;
/// Spans of time shorter than this part of the time itself are not drawn.
const SHORTEST: f64 = 1e-9;
/// Lines of the grid, about.
const TICKS: usize = 6;
/// Powers of ten at a logarithmic axis, at most.
const MOST_POWERS: usize = 12;

/// A diagram's times: what it shows, and what is marked.
#[derive(Clone, Copy, Debug)]
pub struct Times<'a> {
    /// The time of each value (s).
    pub values: &'a [f64],
    /// Times to mark by vertical lines.
    pub marks: &'a [Marks],
}

/// Times at which something of one kind happens.
#[derive(Clone, Debug, PartialEq)]
pub struct Marks {
    /// When (s).
    pub times: Vec<f64>,
    /// What happens.
    pub name: String,
}

impl Marks {
    /// Times of one kind that are marked: more would be a grey area.
    pub const MOST: usize = 500;

    /// Whether there are few enough to tell one from the next.
    fn are_shown(&self) -> bool {
        self.times.len() <= Self::MOST
    }
}

/// Draws panels with a common axis of time (s).
///
/// # Errors
///
/// As [`Sheet::draw`].
pub fn panels_as_svg(
    sheet: &Sheet,
    times: Times,
    panels: &[Panel],
) -> Result<String, CommandError> {
    let prepared: Vec<_> = panels
        .iter()
        .map(|panel| curves(times.values, &panel.series, panel.scale))
        .collect();
    let happens = times.marks.iter().filter(|marks| !marks.times.is_empty());
    let happens: Vec<&Marks> = happens.collect();
    let legends: Vec<Vec<Entry>> = prepared
        .iter()
        .enumerate()
        .map(|(panel, (curves, _))| entries(curves, if panel == 0 { &happens } else { &[] }))
        .collect();
    let beside = legend::width(legends.iter().flatten());
    let (width, narrow) = (sheet.pixels(), sheet.is_narrow());
    let wide = match width {
        Some(width) if narrow => width,
        Some(width) => width - beside.min(width / 2),
        None => WIDTH,
    };
    let (axes, labels) = verticals(panels, prepared.iter().map(|(_, range)| *range));
    let inside = wide - labels;
    let heads: Vec<u32> = match narrow {
        true => legends
            .iter()
            .map(|legend| legend::height(legend, inside))
            .collect(),
        false => vec![0; panels.len()],
    };
    let count = u32::try_from(panels.len()).unwrap_or(1);
    let height = sheet.head() + PANEL * count + heads.iter().sum::<u32>() + TIME_AXIS;
    let time = axis_of_time(times.values, inside - MARGINS.0 - MARGINS.1);
    sheet.draw((width.unwrap_or(WIDTH + beside), height), |root| {
        sheet.heading(root, labels)?;
        let (_, mut rest) = root.split_vertically(sheet.head() * DETAIL);
        for (i, (panel, (curves, _))) in panels.iter().zip(&prepared).enumerate() {
            let last = i + 1 == panels.len();
            let (above, below) = rest.split_vertically(heads[i] * DETAIL);
            let height = if last { PANEL + TIME_AXIS } else { PANEL };
            let (area, below) = below.split_vertically(height * DETAIL);
            let (left, right) = area.split_horizontally(wide * DETAIL);
            let axes = (&time, &axes[i], labels);
            diagram(&left, panel, curves, axes, (&happens, last))?;
            match narrow {
                true => legend::above(&above, &legends[i], labels, inside)?,
                false => legend::beside(&right, &legends[i], PANEL)?,
            }
            rest = below;
        }
        Ok(())
    })
}

/// The axis of some times, so wide (pixels).
fn axis_of_time(times: &[f64], width: u32) -> Axis {
    let mut known = times.iter().copied().filter(|t| has_place(*t));
    let from = known.next().unwrap_or(0.0);
    let range = widened((from, known.next_back().unwrap_or(from)));
    Axis::numbers_across(range, (width / WIDTH_OF_TICK) as usize + 1, width)
}

/// The axes of panels with these ranges, and their width (pixels).
fn verticals(panels: &[Panel], ranges: impl Iterator<Item = Range>) -> (Vec<Axis>, u32) {
    let axes = panels.iter().zip(ranges);
    let axes: Vec<Axis> = axes
        .map(|(panel, range)| vertical(panel.scale, range))
        .collect();
    let width = axes.iter().map(Axis::width).max().unwrap_or(0);
    (axes, width)
}

/// The axis of values in a range.
fn vertical(scale: Scale, range: Range) -> Axis {
    let decades = (range.1 - range.0).ceil() as usize;
    match scale {
        Scale::Linear => Axis::numbers(range, TICKS),
        Scale::Whole => Axis::whole(range, TICKS),
        Scale::Logarithmic { low, .. } => {
            Axis::labelled(range, (decades / 2 + 1).min(MOST_POWERS), |y| {
                match y <= f64::from(low) {
                    true => format!("≤{}", power_of_ten(y)),
                    false => power_of_ten(y),
                }
            })
        }
    }
}

/// What explains the curves and the marks of a panel; the first one explains the marks.
fn entries(curves: &[Curve], happens: &[&Marks]) -> Vec<Entry> {
    let curve = |curve: &Curve| Entry {
        name: curve.name.clone(),
        kind: Kind::Curve(curve.place),
    };
    let mark = |(place, marks): (usize, &&Marks)| Entry {
        name: match marks.are_shown() {
            true => marks.name.clone(),
            false => format!("{} ({}, not marked)", marks.name, marks.times.len()),
        },
        kind: Kind::Mark(place),
    };
    let marks = happens.iter().enumerate().map(mark);
    curves.iter().map(curve).chain(marks).collect()
}

type Range = (f64, f64);

fn diagram(
    area: &Area,
    panel: &Panel,
    curves: &[Curve],
    (time, axis, labels): (&Axis, &Axis, u32),
    (marks, last): (&[&Marks], bool),
) -> Drawn {
    let below = if last { TIME_AXIS } else { 0 };
    let above = axis.head();
    let mut chart = ChartBuilder::on(area)
        .margin_top(above * DETAIL)
        .margin_bottom(10 * DETAIL)
        .margin_left(MARGINS.0 * DETAIL)
        .margin_right(MARGINS.1 * DETAIL)
        .set_label_area_size(LabelAreaPosition::Left, labels * DETAIL)
        .set_label_area_size(LabelAreaPosition::Bottom, below * DETAIL)
        .build_cartesian_2d(time.clone(), axis.clone())?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .max_light_lines(0)
        .bold_line_style(GRID.stroke_width(DETAIL))
        .axis_style(INK.stroke_width(DETAIL))
        .label_style(letters(TEXT))
        .axis_desc_style(letters(TEXT))
        .set_tick_mark_size(LabelAreaPosition::Left, 5 * DETAIL)
        .set_tick_mark_size(LabelAreaPosition::Bottom, 5 * DETAIL)
        .y_desc(panel.axis.as_str())
        .x_desc("time t [s]")
        .draw()?;
    axis.note_above(area, MARGINS.0 + labels)?;
    if last {
        time.note_below(area, MARGINS.1)?;
    }
    for (place, marks) in marks.iter().enumerate().filter(|(_, x)| x.are_shown()) {
        let style = mark(place).stroke_width(DETAIL);
        let line = |t: f64| PathElement::new(vec![(t, axis.range.0), (t, axis.range.1)], style);
        let shown = marks
            .times
            .iter()
            .filter(|t| (time.range.0..=time.range.1).contains(*t));
        chart.draw_series(shown.map(|t| line(*t)))?;
    }
    for curve in curves {
        let ink = colour(curve.place);
        let points = curve.points.iter().copied();
        match panel.scale {
            Scale::Linear | Scale::Whole => {
                chart.draw_series(LineSeries::new(points, ink.stroke_width(STROKE)))?;
            }
            Scale::Logarithmic { .. } => {
                chart.draw_series(points.map(|at| Circle::new(at, DOT, ink.filled())))?;
            }
        }
    }
    Ok(())
}

/// A range that is not empty, nor lost in the round-off of its ends.
fn widened((from, to): Range) -> Range {
    let size = from.abs().max(to.abs());
    match to - from > SHORTEST * size {
        true => (from, to),
        false => (from, from + size.max(1.0)),
    }
}
