//! Legends: beside a diagram, or above it where it is narrow, so that they hide nothing.

use super::sheet::{Area, Drawn, px};
use super::style::{DETAIL, STROKE, colour, level, mark};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

/// Width of a letter (pixels), generously.
const LETTER: u32 = 9;
/// Room before a name, for a sample of its line (pixels).
const SAMPLE: u32 = 40;
/// Distance of lines (pixels).
const LINE: u32 = 18;
/// Distance of names in a line (pixels).
const APART: u32 = 16;

/// A line of a legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// What it says.
    pub name: String,
    /// Of what.
    pub kind: Kind,
}

/// What a line of a legend explains, by its place among those of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A curve.
    Curve(usize),
    /// A mark in time.
    Mark(usize),
}

/// The width of a legend beside a diagram (pixels).
pub fn width<'a>(entries: impl Iterator<Item = &'a Entry>) -> u32 {
    let letters = entries.map(|entry| entry.name.chars().count()).max();
    SAMPLE + APART + LETTER * u32::try_from(letters.unwrap_or(0).min(30)).unwrap_or(0)
}

/// The height of a legend above a diagram of a width (pixels).
pub fn height(entries: &[Entry], width: u32) -> u32 {
    let last = places(entries, width).last().copied();
    last.map_or(0, |(_, y)| y + LINE)
}

/// Where names go in lines of a width (pixels).
fn places(entries: &[Entry], width: u32) -> Vec<(u32, u32)> {
    let mut at = (0, 0);
    let place = |entry: &Entry| {
        let letters = u32::try_from(entry.name.chars().count()).unwrap_or(0);
        let long = SAMPLE + LETTER * letters + APART;
        if at.0 > 0 && at.0 + long > width {
            at = (0, at.1 + LINE);
        }
        let here = at;
        at.0 += long;
        here
    };
    entries.iter().map(place).collect()
}

/// Draws a legend above a diagram, from a distance from the left (pixels).
///
/// # Errors
///
/// As drawing has them.
pub fn above(area: &Area, entries: &[Entry], left: u32, width: u32) -> Drawn {
    let places = places(entries, width);
    let mut all = entries.iter().zip(places);
    all.try_for_each(|(entry, (x, y))| explain(area, entry, (left + x, y + LINE / 2 + 2)))
}

/// Draws a legend beside a diagram, as far as there is room.
///
/// # Errors
///
/// As drawing has them.
pub fn beside(area: &Area, entries: &[Entry], height: u32) -> Drawn {
    let places = (0u32..).map(|i| 22 + LINE * i);
    let mut shown = entries.iter().zip(places).filter(|(_, y)| y + 10 <= height);
    shown.try_for_each(|(entry, y)| explain(area, entry, (8, y)))
}

fn explain(area: &Area, entry: &Entry, (x, y): (u32, u32)) -> Drawn {
    let sample = match entry.kind {
        Kind::Curve(place) => PathElement::new(
            vec![px(x, y), px(x + 24, y)],
            colour(place).stroke_width(STROKE + 2),
        ),
        Kind::Mark(kind) => PathElement::new(
            vec![px(x + 12, y - 8), px(x + 12, y + 8)],
            mark(kind).stroke_width(DETAIL),
        ),
    };
    area.draw(&sample)?;
    let name = entry.name.clone();
    area.draw(&Text::new(name, px(x + 32, y), level(HPos::Left)))
}

#[cfg(test)]
mod tests {
    use super::{Entry, Kind, height, places};

    #[test]
    fn names_go_on_in_the_next_line_where_one_is_full() {
        let entry = |name: &str| Entry {
            name: name.to_string(),
            kind: Kind::Curve(0),
        };
        let all = [entry("q1"), entry("q2"), entry("a name of many words")];
        let places = places(&all, 200);
        assert_eq!(places, [(0, 0), (74, 0), (0, 18)]);
        assert_eq!(height(&all, 200), 36);
        assert_eq!(height(&[], 200), 0);
    }
}
