//! One quantity over another: a phase portrait.

use super::Sheet;
use super::axis::Axis;
use super::curve::{ends, has_place};
use super::legend::{self, Entry, Kind};
use super::style::{DETAIL, GRID, INK, STROKE, TEXT, colour, letters};
use crate::error::CommandError;
use plotters::prelude::*;

/// Size of a picture (pixels).
const SIZE: (u32, u32) = (620, 484);
/// Width that a tick has (pixels), about.
const WIDTH_OF_TICK: u32 = 90;
/// Margin around the diagram (pixels).
const EDGE: u32 = 12;
/// Margin around the values, as a part of their range.
const MARGIN: f64 = 0.06;
/// Points of a curve, at most.
const POINTS: usize = 20_000;

/// One quantity over another in one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Portrait {
    /// What tells the run from others; empty if there is one.
    pub name: String,
    /// Both quantities; those that have no place are left out.
    pub points: Vec<(f64, f64)>,
}

/// Draws a quantity over another one, each with its name and unit, in one run or several.
///
/// # Errors
///
/// As [`Sheet::draw`].
pub fn phase_as_svg(
    sheet: &Sheet,
    [across, up]: [&str; 2],
    portraits: &[Portrait],
) -> Result<String, CommandError> {
    let placed = |(x, y): &&(f64, f64)| has_place(*x) && has_place(*y);
    let all = || portraits.iter().flat_map(|portrait| &portrait.points);
    let x = range(all().filter(placed).map(|point| point.0));
    let y = range(all().filter(placed).map(|point| point.1));
    let legend = entries(portraits);
    let width = sheet.pixels().unwrap_or(SIZE.0);
    let most = (width / WIDTH_OF_TICK) as usize;
    let up_axis = Axis::numbers(y, most);
    let labels = up_axis.width();
    let inside = width - labels - 2 * EDGE;
    let across_axis = Axis::numbers_across(x, most, inside);
    let above = legend::height(&legend, width - labels);
    let height = width * SIZE.1 / SIZE.0 + sheet.head() + above;
    sheet.draw((width, height), |root| {
        sheet.heading(root, labels)?;
        let (head, rest) = root.split_vertically((sheet.head() + above) * DETAIL);
        let (_, explained) = head.split_vertically(sheet.head() * DETAIL);
        legend::above(&explained, &legend, labels, width - labels)?;
        let mut chart = ChartBuilder::on(&rest)
            .margin(EDGE * DETAIL)
            .margin_top(up_axis.head() * DETAIL)
            .set_label_area_size(LabelAreaPosition::Left, labels * DETAIL)
            .set_label_area_size(LabelAreaPosition::Bottom, 44 * DETAIL)
            .build_cartesian_2d(across_axis.clone(), up_axis.clone())?;
        chart
            .configure_mesh()
            .max_light_lines(0)
            .bold_line_style(GRID.stroke_width(DETAIL))
            .axis_style(INK.stroke_width(DETAIL))
            .label_style(letters(TEXT))
            .axis_desc_style(letters(TEXT))
            .x_desc(across)
            .y_desc(up)
            .draw()?;
        up_axis.note_above(&rest, EDGE + labels)?;
        across_axis.note_below(&rest, EDGE)?;
        for (place, portrait) in portraits.iter().enumerate() {
            let points = || portrait.points.iter().filter(placed).copied();
            let step = portrait.points.len().div_ceil(POINTS).max(1);
            let line = colour(place).stroke_width(STROKE);
            chart.draw_series(LineSeries::new(points().step_by(step), line))?;
            // Where it begins.
            let ink = if portraits.len() == 1 { 1 } else { place };
            let first = points().next();
            let begin = first.map(|at| Circle::new(at, 4 * DETAIL, colour(ink).filled()));
            chart.draw_series(begin)?;
        }
        Ok(())
    })
}

/// What tells runs apart, if there are several.
fn entries(portraits: &[Portrait]) -> Vec<Entry> {
    let entry = |(place, portrait): (usize, &Portrait)| Entry {
        name: portrait.name.clone(),
        kind: Kind::Curve(place),
    };
    let all = portraits.iter().enumerate().map(entry);
    all.filter(|_| portraits.len() > 1).collect()
}

/// The range of values with a margin; not empty.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = ends(values);
    if low > high {
        return (-1.0, 1.0);
    }
    let size = low.abs().max(high.abs());
    let margin = match high - low > 1e-9 * size {
        true => MARGIN * (high - low),
        false if size < 1e-290 => 1.0,
        false => 0.1 * size,
    };
    (low - margin, high + margin)
}

#[cfg(test)]
mod tests {
    use super::range;

    #[test]
    fn a_range_is_never_empty() {
        for values in [vec![], vec![0.0], vec![5.0, 5.0], vec![-1e300, 1e300]] {
            let (low, high) = range(values.iter().copied());
            assert!(low < high && (high - low).is_finite(), "{values:?}");
        }
    }
}
