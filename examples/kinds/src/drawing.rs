//! Panels side by side, as SVG.
//!
//! In:  [`Picture`]s.
//! Out: text.

use crate::curve::Point;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

/// Pictures are drawn this many times as large and shown reduced, because the drawing
/// library places points on whole pixels.
const DETAIL: u32 = 4;
/// Width and height of a panel (pixels).
const PANEL: (u32, u32) = (280, 270);
/// Height of the title (pixels).
const TITLE: u32 = 32;
const TEXT: u32 = 13 * DETAIL;
const HEADING: u32 = 16 * DETAIL;
const FONT: &str = "sans-serif";
/// Empty border around curves, as a fraction of their size.
const BORDER: f64 = 0.08;
const INK: RGBColor = RGBColor(38, 38, 38);
const GRID: RGBColor = RGBColor(224, 224, 224);

/// What drawing can come to.
type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// What a curve shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The sheet on which the motion lives, or a configuration on it.
    Motion,
    /// Another sheet.
    Other,
    /// The singular configuration.
    Link,
    /// An axis.
    Ghost,
}

/// A curve, or the dot that marks the singular configuration.
#[derive(Clone, Debug)]
pub struct Curve {
    role: Role,
    points: Vec<Point>,
}

impl Curve {
    /// A curve through points.
    pub fn new(role: Role, points: Vec<Point>) -> Self {
        Self { role, points }
    }

    /// A dot.
    pub fn dot(point: Point) -> Self {
        Self::new(Role::Link, vec![point])
    }
}

/// A part of a picture.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What stands above it.
    pub title: String,
    /// What stands below and beside it.
    pub labels: [String; 2],
    /// Whether both directions have one scale.
    pub equal: bool,
    /// Whether there are axes with numbers.
    pub axes: bool,
    /// From back to front.
    pub curves: Vec<Curve>,
}

/// Panels side by side.
#[derive(Clone, Debug)]
pub struct Picture {
    /// What stands above it.
    pub title: String,
    /// From left to right.
    pub panels: Vec<Panel>,
}

/// Draws a picture as SVG.
///
/// # Errors
///
/// Whatever the drawing library reports.
pub fn draw(picture: &Picture) -> Result<String, DrawingAreaErrorKind<std::io::Error>> {
    let count = picture.panels.len() as u32;
    let size = (count * PANEL.0 + 12, TITLE + PANEL.1 + 8);
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (size.0 * DETAIL, size.1 * DETAIL))
            .into_drawing_area();
        root.fill(&WHITE)?;
        let style = TextStyle::from((FONT, HEADING).into_font()).color(&INK);
        let head = (10 * DETAIL) as i32;
        root.draw(&Text::new(
            picture.title.clone(),
            (head, head * 3 / 4),
            style,
        ))?;
        for (place, panel) in (0u32..).zip(&picture.panels) {
            let corner = (
                ((place * PANEL.0 + 6) * DETAIL) as i32,
                (TITLE * DETAIL) as i32,
            );
            let area = root
                .clone()
                .shrink(corner, (PANEL.0 * DETAIL, PANEL.1 * DETAIL));
            draw_panel(&area, panel)?;
        }
        root.present()?;
    }
    let drawn = format!(
        "width=\"{}\" height=\"{}\"",
        size.0 * DETAIL,
        size.1 * DETAIL
    );
    let shown = format!("width=\"{}\" height=\"{}\"", size.0, size.1);
    Ok(text.replacen(&drawn, &shown, 1))
}

fn draw_panel(area: &Area, panel: &Panel) -> Drawn {
    let [x, y] = bounds(panel);
    let detail = DETAIL as i32;
    let mut chart = ChartBuilder::on(area)
        .margin(8 * detail)
        .caption(panel.title.clone(), (FONT, TEXT).into_font().color(&INK))
        .x_label_area_size(34 * detail)
        .y_label_area_size(38 * detail)
        .build_cartesian_2d(x, y)?;
    if panel.axes {
        let [below, beside] = &panel.labels;
        let text = TextStyle::from((FONT, TEXT * 4 / 5).into_font()).color(&INK);
        chart
            .configure_mesh()
            .x_desc(below.clone())
            .y_desc(beside.clone())
            .x_labels(5)
            .y_labels(5)
            .x_label_formatter(&|x| number(*x))
            .y_label_formatter(&|y| number(*y))
            .label_style(text.clone())
            .axis_desc_style(text)
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID.stroke_width(DETAIL))
            .axis_style(INK.stroke_width(DETAIL))
            .draw()?;
    }
    for curve in &panel.curves {
        draw_curve(&mut chart, curve)?;
    }
    Ok(())
}

fn draw_curve(chart: &mut Chart<'_, '_>, curve: &Curve) -> Drawn {
    let (colour, width) = match curve.role {
        Role::Motion => (RGBColor(0, 114, 178), 2),
        Role::Other => (RGBColor(213, 94, 0), 2),
        Role::Link => (INK, 3),
        Role::Ghost => (RGBColor(196, 204, 212), 1),
    };
    let is_drawn = curve.points.len() < 5 && curve.points.len() > 1;
    if curve.points.len() > 1 {
        let points = curve.points.iter().map(|[x, y]| (*x, *y));
        chart.draw_series(LineSeries::new(points, colour.stroke_width(width * DETAIL)))?;
    }
    // Joints of links, and the singular configuration.
    if is_drawn || curve.points.len() == 1 {
        let dots = curve.points.iter();
        chart.draw_series(dots.map(|[x, y]| Circle::new((*x, *y), 4 * DETAIL, colour.filled())))?;
    }
    Ok(())
}

fn number(x: f64) -> String {
    let text = format!("{x:.1}").replace('-', "−");
    if text == "−0.0" { "0.0".into() } else { text }
}

/// What a panel shows, with a border around it; of one scale in both directions if it
/// says so.
fn bounds(panel: &Panel) -> [std::ops::Range<f64>; 2] {
    let points = || panel.curves.iter().flat_map(|curve| &curve.points);
    let range = |axis: usize| {
        let low = points().fold(f64::INFINITY, |low, point| low.min(point[axis]));
        let high = points().fold(f64::NEG_INFINITY, |high, point| high.max(point[axis]));
        (low, high)
    };
    let [mut x, mut y] = [range(0), range(1)];
    if panel.equal {
        let most = (x.1 - x.0).max(y.1 - y.0);
        for (low, high) in [&mut x, &mut y] {
            let spare = (most - (*high - *low)) / 2.0;
            (*low, *high) = (*low - spare, *high + spare);
        }
    }
    [x, y].map(|(low, high)| {
        let border = (high - low) * BORDER;
        low - border..high + border
    })
}
