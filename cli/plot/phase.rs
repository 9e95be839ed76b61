//! One quantity over another: a phase portrait.

use super::Series;
use super::axis::{px, short};
use super::curve::has_place;
use super::style::{DETAIL, FONT, GRID, HEADING, INK, STROKE, TEXT, colour};
use super::svg;
use crate::error::CommandError;
use plotters::prelude::*;
use std::path::Path;

/// Size of a picture (pixels).
const SIZE: (u32, u32) = (620, 520);
/// Height of the title (pixels).
const TITLE: u32 = 36;
/// Width of the vertical axis with its labels (pixels).
const LABELS: u32 = 78;
/// Margin around the values, as a part of their range.
const MARGIN: f64 = 0.06;
/// Points of a curve, at most.
const POINTS: usize = 20_000;

/// Draws a quantity over another one, each with its name and unit.
///
/// # Errors
///
/// As [`svg::text`].
pub fn phase_as_svg(path: &Path, title: &str, pair: &[Series; 2]) -> Result<String, CommandError> {
    let [across, up] = pair;
    let all = across.values.iter().copied().zip(up.values.iter().copied());
    let points: Vec<(f64, f64)> = all
        .filter(|(x, y)| has_place(*x) && has_place(*y))
        .collect();
    let x = range(points.iter().map(|point| point.0));
    let y = range(points.iter().map(|point| point.1));
    svg::text(path, SIZE, |root| {
        let (head, rest) = root.split_vertically(TITLE * DETAIL);
        let style = |size| TextStyle::from((FONT, size).into_font()).color(&INK);
        head.draw(&Text::new(
            title.to_string(),
            px(LABELS, 10),
            style(HEADING),
        ))?;
        let mut chart = ChartBuilder::on(&rest)
            .margin(12 * DETAIL)
            .set_label_area_size(LabelAreaPosition::Left, LABELS * DETAIL)
            .set_label_area_size(LabelAreaPosition::Bottom, 44 * DETAIL)
            .build_cartesian_2d(x.0..x.1, y.0..y.1)?;
        chart
            .configure_mesh()
            .max_light_lines(0)
            .bold_line_style(GRID.stroke_width(DETAIL))
            .axis_style(INK.stroke_width(DETAIL))
            .label_style(style(TEXT))
            .axis_desc_style(style(TEXT))
            .x_labels(7)
            .y_labels(7)
            .x_desc(across.name.as_str())
            .y_desc(up.name.as_str())
            .x_label_formatter(&|value| short(*value, x.1 - x.0))
            .y_label_formatter(&|value| short(*value, y.1 - y.0))
            .draw()?;
        let step = points.len().div_ceil(POINTS).max(1);
        let drawn = points.iter().copied().step_by(step);
        chart.draw_series(LineSeries::new(drawn, colour(0).stroke_width(STROKE)))?;
        // Where it begins.
        let first = points.first().copied();
        let begin = first.map(|at| Circle::new(at, 4 * DETAIL, colour(1).filled()));
        chart.draw_series(begin)?;
        Ok(())
    })
}

/// The range of values with a margin; not empty.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    });
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
