//! Time over error, by powers of ten.

use crate::work::Point;
use plotters::prelude::*;
use std::error::Error;
use std::path::Path;

/// Size of a diagram (pixels).
const SIZE: (u32, u32) = (900, 560);
/// Colours that people of any colour vision can tell apart (Okabe & Ito 2008).
const COLOURS: [RGBColor; 7] = [
    RGBColor(86, 180, 233),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(230, 159, 0),
    RGBColor(213, 94, 0),
    RGBColor(204, 121, 167),
    RGBColor(90, 90, 90),
];

/// Draws the points of each method that are on the right branch.
///
/// # Errors
///
/// What the drawing library says.
pub fn draw(
    path: &Path,
    title: &str,
    methods: &[(String, Vec<Point>)],
) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(title, ("sans-serif", 20))
        .margin(14)
        .set_label_area_size(LabelAreaPosition::Left, 70)
        .set_label_area_size(LabelAreaPosition::Bottom, 50)
        .build_cartesian_2d((1e-13..1e2).log_scale(), (1e-5..1e1).log_scale())?;
    chart
        .configure_mesh()
        .max_light_lines(0)
        .x_desc("error of q1 at the end [rad]")
        .y_desc("time of a run [s]")
        .x_label_formatter(&|x| format!("{x:.0e}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .label_style(("sans-serif", 15))
        .draw()?;
    for ((name, points), colour) in methods.iter().zip(COLOURS) {
        let at: Vec<_> = points
            .iter()
            .map(|point| (point.error.max(1e-13), point.seconds))
            .collect();
        chart
            .draw_series(LineSeries::new(at.iter().copied(), colour.stroke_width(2)))?
            .label(name)
            .legend(move |(x, y)| {
                PathElement::new(vec![(x, y), (x + 22, y)], colour.stroke_width(3))
            });
        chart.draw_series(at.iter().map(|at| Circle::new(*at, 4, colour.filled())))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.85))
        .border_style(RGBColor(200, 200, 200))
        .label_font(("sans-serif", 15))
        .draw()?;
    root.present()?;
    Ok(())
}
