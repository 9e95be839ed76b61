//! Numbers and places on axes.

use super::sheet::{Area, Drawn, px};
use super::style::{DETAIL, level};
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

/// Width of a vertical axis without its numbers (pixels).
const BESIDE_NUMBERS: u32 = 36;
/// Width of a digit (pixels), generously.
const DIGIT: f64 = 9.0;
/// Width of a point (pixels).
const POINT: f64 = 5.0;
/// Distance of numbers side by side (pixels).
const APART: f64 = 14.0;
/// What an end may be off by to be a tick, as a part of the range.
const SLACK: f64 = 1e-9;
/// The power of ten below all numbers.
const LEAST_POWER: i32 = -330;
/// Numbers with more digits are written as distances from one that all have in common.
const MOST_DIGITS: f64 = 1e5;
/// Numbers below this power of ten have a common power of ten, and those from the other on.
const POWERS: (i32, i32) = (-3, 5);

/// The ticks of an axis and what stands at them.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// From where to where it goes.
    pub range: (f64, f64),
    /// Where they are.
    ticks: Vec<f64>,
    texts: Vec<String>,
    /// What is left out in the numbers: a common power of ten, a number to add.
    note: String,
}

/// Even ticks: whole multiples of 1, 2 or 5 times a power of ten.
struct Even {
    /// The ticks in that power of ten.
    counts: Vec<f64>,
    exponent: i32,
}

impl Even {
    /// At most so many ticks in a range, of no smaller power of ten than a least one.
    fn new((from, to): (f64, f64), most: usize, least: i32) -> Self {
        let finest = ((to - from) / most.max(1) as f64).log10().floor() as i32;
        let mut exponent = finest.max(LEAST_POWER).max(least);
        loop {
            for digit in [1.0, 2.0, 5.0] {
                let place = |x: f64| scaled(x / digit, -exponent);
                // An end is a tick, whatever its last digit.
                let slack = SLACK * (place(to) - place(from));
                let first = (place(from) - slack).ceil();
                let last = (place(to) + slack).floor();
                if last - first < most as f64 {
                    let count = (last - first + 1.0) as usize;
                    let counts = (0..count).map(|i| (first + i as f64) * digit).collect();
                    return Self { counts, exponent };
                }
            }
            exponent += 1;
        }
    }

    fn ticks(&self) -> Vec<f64> {
        let tick = |count: &f64| scaled(*count, self.exponent);
        self.counts.iter().map(tick).collect()
    }
}

impl Axis {
    /// Numbers in a range, at most so many.
    pub fn numbers(range: (f64, f64), most: usize) -> Self {
        Self::written(range, Even::new(range, most, i32::MIN))
    }

    /// Whole numbers in a range, at most so many.
    pub fn whole(range: (f64, f64), most: usize) -> Self {
        Self::written(range, Even::new(range, most, 0))
    }

    /// Ticks, and as many digits as tell them apart.
    fn written(range: (f64, f64), even: Even) -> Self {
        let (mut counts, exponent) = (even.counts.clone(), even.exponent);
        let offset = common(&counts);
        counts.iter_mut().for_each(|count| *count -= offset);
        let largest = size(&counts).max(1.0).log10().floor() as i32 + exponent;
        let power = match largest >= POWERS.0 && largest < POWERS.1 || size(&counts) == 0.0 {
            true => 0,
            false => largest,
        };
        let mut note = String::new();
        if power != 0 {
            note.push_str(&format!("×{}", power_of_ten(f64::from(power))));
        }
        if offset != 0.0 {
            let sign = if offset < 0.0 { "−" } else { "+" };
            let gap = if note.is_empty() { "" } else { " " };
            note.push_str(&format!("{gap}{sign} {}", long(offset.abs(), exponent)));
        }
        let texts = counts.iter();
        Self {
            range,
            ticks: even.ticks(),
            texts: texts
                .map(|count| decimal(*count, exponent - power))
                .collect(),
            note,
        }
    }

    /// As many numbers side by side as there is room for (pixels), at most so many.
    pub fn numbers_across(range: (f64, f64), most: usize, width: u32) -> Self {
        let fits = |axis: &Axis| {
            let spacing = match axis.ticks[..] {
                [first, second, ..] => (second - first) / (range.1 - range.0),
                _ => 1.0,
            };
            axis.longest() + APART <= spacing * f64::from(width)
        };
        let mut wanted = (1..=most).rev().map(|most| Self::numbers(range, most));
        let found = wanted.find(fits);
        found.unwrap_or_else(|| Self::numbers(range, 1))
    }

    /// At most so many numbers, written as `text` has them.
    pub fn labelled(range: (f64, f64), most: usize, text: impl Fn(f64) -> String) -> Self {
        let ticks = Even::new(range, most, 0).ticks();
        Self {
            range,
            texts: ticks.iter().map(|tick| text(*tick)).collect(),
            ticks,
            note: String::new(),
        }
    }

    /// The width that it takes at the left of a diagram (pixels).
    pub fn width(&self) -> u32 {
        BESIDE_NUMBERS + self.longest() as u32
    }

    /// The width of the longest text (pixels).
    fn longest(&self) -> f64 {
        let letter = |c: char| if c == '.' { POINT } else { DIGIT };
        let widths = self
            .texts
            .iter()
            .map(|text| text.chars().map(letter).sum::<f64>());
        widths.fold(0.0, f64::max)
    }
}

impl Axis {
    /// Room above a diagram with this axis at its left (pixels).
    pub fn head(&self) -> u32 {
        if self.note.is_empty() { 12 } else { 24 }
    }

    /// Draws what numbers leave out above an axis at a distance from the left (pixels).
    ///
    /// # Errors
    ///
    /// As drawing has them.
    pub fn note_above(&self, area: &Area, left: u32) -> Drawn {
        self.note_at(area, (px(left, 11), HPos::Left))
    }

    /// Draws what numbers leave out below an axis, up to a distance from the right (pixels).
    ///
    /// # Errors
    ///
    /// As drawing has them.
    pub fn note_below(&self, area: &Area, right: u32) -> Drawn {
        let (width, height) = area.dim_in_pixel();
        let corner = px(width / DETAIL - right, height / DETAIL - 18);
        self.note_at(area, (corner, HPos::Right))
    }

    fn note_at(&self, area: &Area, (place, side): ((i32, i32), HPos)) -> Drawn {
        match self.note.as_str() {
            "" => Ok(()),
            note => area.draw(&Text::new(note.to_string(), place, level(side))),
        }
    }
}

fn size(counts: &[f64]) -> f64 {
    counts.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// What numbers have in common, if that takes more digits than they differ by.
fn common(counts: &[f64]) -> f64 {
    let [first, .., last] = counts else {
        return 0.0;
    };
    let unit = 10_f64.powf((last - first).log10().floor() + 1.0);
    match size(counts) >= MOST_DIGITS && size(counts) >= 10.0 * unit {
        true => (first / unit).floor() * unit,
        false => 0.0,
    }
}

/// `x·10^exponent`, without a power of ten that is no number of its own.
fn scaled(x: f64, exponent: i32) -> f64 {
    let half = exponent / 2;
    let times = |x: f64, exponent: i32| match exponent < 0 {
        true => x / 10_f64.powi(-exponent),
        false => x * 10_f64.powi(exponent),
    };
    match exponent.abs() > 300 {
        true => times(times(x, half), exponent - half),
        false => times(x, exponent),
    }
}

/// A whole number times a power of ten, in as many digits as that takes.
fn decimal(count: f64, exponent: i32) -> String {
    let digits = (-exponent).max(0) as usize;
    let text = format!("{:.digits$}", scaled(count, exponent));
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    text.replace('-', "−")
}

/// A whole number times a power of ten, which is written as such where it has many digits.
fn long(count: f64, exponent: i32) -> String {
    let power = count.log10().floor() as i32;
    match exponent >= -15 && power + exponent < 15 {
        true => decimal(count, exponent),
        false => {
            let raised = power_of_ten(f64::from(power + exponent));
            format!("{}·{raised}", decimal(count, -power))
        }
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        RangedCoordf64::from(self.range.0..self.range.1).map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        match hint.weight().allow_light_points() {
            true => Vec::new(),
            false => self.ticks.clone(),
        }
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.range.0..self.range.1
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, tick: &f64) -> String {
        let place = self.ticks.iter().position(|known| known == tick);
        place.map_or_else(String::new, |place| self.texts[place].clone())
    }
}

/// `10^exponent`, for whole exponents.
pub fn power_of_ten(exponent: f64) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        _ => '⁹',
    };
    let whole = exponent.round();
    if (exponent - whole).abs() > 1e-9 {
        return String::new();
    }
    let digits: String = format!("{whole:.0}").chars().map(raised).collect();
    format!("10{digits}")
}

#[cfg(test)]
mod tests {
    use super::{Axis, power_of_ten};
    use std::collections::BTreeSet;

    fn texts(range: (f64, f64)) -> (String, String) {
        let axis = Axis::numbers(range, 6);
        (axis.texts.join(" "), axis.note)
    }

    #[test]
    fn numbers_of_an_axis_are_short_and_tell_what_they_leave_out() {
        for (range, shown, note) in [
            ((-1.0, 1.0), "−1 −0.5 0 0.5 1", ""),
            ((10.0, 100.0), "20 40 60 80 100", ""),
            ((0.0, 0.013), "0 0.005 0.01", ""),
            ((0.0, 0.29), "0 0.05 0.1 0.15 0.2 0.25", ""),
            ((0.27, 0.29), "0.27 0.275 0.28 0.285 0.29", ""),
            ((-3e-7, 4.1e-7), "−2 0 2 4", "×10⁻⁷"),
            ((0.0, 2.5e5), "0 0.5 1 1.5 2 2.5", "×10⁵"),
            ((2.5e6, 2.50002e6), "0 5 10 15 20", "+ 2500000"),
            (
                (-7.000_000_4, -7.0),
                "0.6 0.7 0.8 0.9 1",
                "×10⁻⁶ − 7.000001",
            ),
            (
                (9.810_000_001, 9.810_000_002),
                "1 1.2 1.4 1.6 1.8 2",
                "×10⁻⁹ + 9.81",
            ),
            ((-1e300, 1e300), "−1 −0.5 0 0.5 1", "×10³⁰⁰"),
            ((0.0, 3e-300), "0 1 2 3", "×10⁻³⁰⁰"),
            ((1e20, 1.000_01e20), "0 0.2 0.4 0.6 0.8 1", "×10¹⁵ + 1·10²⁰"),
        ] {
            let expected = (shown.to_string(), note.to_string());
            assert_eq!(texts(range), expected, "{range:?}");
        }
        assert_eq!(power_of_ten(-14.0), "10⁻¹⁴");
    }

    #[test]
    fn ticks_of_any_range_are_told_apart() {
        let mut random = 1_u64;
        for _ in 0..10_000 {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let part = |shift: u32| ((random >> shift) & 0x3ff) as f64 / 1024.0;
            let size = 10_f64.powf(40.0 * part(20) - 20.0);
            let from = size * (part(30) - 0.5);
            let to = from + size * 10_f64.powf(-8.0 * part(40));
            let axis = Axis::numbers((from, to), 6);
            let distinct: BTreeSet<_> = axis.texts.iter().collect();
            assert!(axis.ticks.len() >= 2, "{from} to {to}: {axis:?}");
            assert_eq!(distinct.len(), axis.ticks.len(), "{from} to {to}: {axis:?}");
            assert!(axis.longest() < 90.0, "{from} to {to}: {axis:?}");
        }
    }

    #[test]
    fn the_least_and_the_largest_ranges_have_ticks() {
        for range in [(0.0, 5e-324), (1e-310, 2e-310), (-1e300, 1e300)] {
            let axis = Axis::numbers(range, 6);
            assert!((1..=6).contains(&axis.ticks.len()), "{range:?}: {axis:?}");
        }
    }

    #[test]
    fn whole_numbers_of_any_size_are_short() {
        for (range, shown, note) in [
            ((0.0, 3.0), "0 1 2 3", ""),
            ((0.0, 0.4), "0", ""),
            ((0.0, 1e250), "0 0.2 0.4 0.6 0.8 1", "×10²⁵⁰"),
        ] {
            let axis = Axis::whole(range, 6);
            assert_eq!(axis.texts.join(" "), shown, "{range:?}");
            assert_eq!(axis.note, note, "{range:?}");
        }
    }

    #[test]
    fn long_numbers_side_by_side_are_few() {
        let count = |range, width| Axis::numbers_across(range, 9, width).ticks.len();
        assert_eq!(count((0.0, 8.0), 700), 9);
        assert_eq!(count((0.0, 0.0008), 700), 9);
        assert!(count((100.0, 100.08), 300) < count((0.0, 8.0), 300));
    }
}
