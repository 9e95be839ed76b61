//! Sizes and colours of all pictures.

use plotters::prelude::{IntoFont, RGBColor, TextStyle};
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Pictures are drawn this many times as large and shown reduced, because the
/// drawing library places points on whole pixels.
pub const DETAIL: u32 = 4;
/// Size of plain text (pixels).
pub const TEXT: u32 = 15 * DETAIL;
/// Size of headings (pixels).
pub const HEADING: u32 = 18 * DETAIL;
/// Width of curves.
pub const STROKE: u32 = 6;
/// Radius of points.
pub const DOT: u32 = 4;
/// The family of all text.
const FONT: &str = "sans-serif";
/// Text and axes.
pub const INK: RGBColor = RGBColor(38, 38, 38);
/// Lines of the grid.
pub const GRID: RGBColor = RGBColor(224, 224, 224);
/// Marks of time, by kind.
const MARKS: [RGBColor; 5] = [
    RGBColor(190, 190, 190),
    RGBColor(230, 190, 150),
    RGBColor(160, 205, 235),
    RGBColor(160, 215, 190),
    RGBColor(225, 190, 215),
];
/// What has been.
pub const GHOST: RGBColor = RGBColor(196, 204, 212);

/// Colours that people of any colour vision can tell apart. Source: Okabe & Ito,
/// Color Universal Design (2008).
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(90, 90, 90),
];

/// Text of a size, whose upper left corner is at its place.
pub fn letters(size: u32) -> TextStyle<'static> {
    TextStyle::from((FONT, size).into_font()).color(&INK)
}

/// Plain text, which has its place at the middle of one of its sides.
pub fn level(side: HPos) -> TextStyle<'static> {
    letters(TEXT).pos(Pos::new(side, VPos::Center))
}

/// The colour of marks of a kind.
pub fn mark(kind: usize) -> RGBColor {
    MARKS[kind % MARKS.len()]
}

/// The colour of a curve by its place.
pub fn colour(place: usize) -> RGBColor {
    COLOURS[place % COLOURS.len()]
}
