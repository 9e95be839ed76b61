//! Any numbers are drawn, whatever a run came to.

#![no_main]
#![allow(dead_code, unused_imports)]

#[path = "../../cli/error.rs"]
mod error;
#[path = "../../cli/file_error.rs"]
mod file_error;
#[path = "../../cli/interrupt.rs"]
mod interrupt;
#[path = "../../cli/number.rs"]
mod number;
#[path = "../../cli/place.rs"]
mod place;
#[path = "../../cli/plot/mod.rs"]
mod plot;

use libfuzzer_sys::fuzz_target;
use plot::{
    Cloud, Frame, Mark, Marks, Panel, Portrait, Scale, Series, Shape, Sheet, Times, frames_as_svg,
    panels_as_svg, phase_as_svg, work_diagram,
};
use std::path::Path;

/// What messages name: nothing is written.
const NOWHERE: &str = "nowhere.svg";
/// Numbers that are drawn: more are slow, not new.
const MOST: usize = 64;
const ERRORS: Scale = Scale::Logarithmic {
    low: -18,
    high: -12,
};

/// A screen, or the column of a journal.
fn sheet(is_printed: bool) -> Sheet<'static> {
    Sheet {
        path: Path::new(NOWHERE),
        title: "fuzz",
        width: is_printed.then_some(84.0),
    }
}

/// A picture of panels over time: times, and two curves.
fn draw_panels(sheet: &Sheet, numbers: &[f64]) {
    let third = numbers.len() / 3;
    let (times, values) = numbers.split_at(third);
    // The times of a run grow, whatever else becomes of it.
    let mut times = times.to_vec();
    times.sort_by(f64::total_cmp);
    let series = |name: &str, values: &[f64]| Series {
        name: name.to_string(),
        values: values.to_vec(),
    };
    let panel = |scale, values: &[f64]| Panel {
        axis: "position [m]".to_string(),
        scale,
        series: vec![
            series("a", &values[..third]),
            series("b", &values[third..2 * third]),
        ],
    };
    let counts: Vec<f64> = values
        .iter()
        .map(|value| f64::from(*value as u32))
        .collect();
    let marks = [Marks {
        times: values[..third.min(2)].to_vec(),
        name: "singular position".to_string(),
    }];
    let times = Times {
        values: &times,
        marks: &marks,
    };
    let all = [
        panel(Scale::Linear, values),
        panel(Scale::Whole, &counts),
        panel(ERRORS, values),
    ];
    panels_as_svg(sheet, times, &all).expect("drawn");
}

/// A picture of configurations.
fn draw_frames(sheet: &Sheet, numbers: &[f64]) {
    let points: Vec<[f64; 2]> = numbers.as_chunks::<2>().0.to_vec();
    let Some(first) = points.first().copied() else {
        return;
    };
    let shapes = vec![
        Shape::Line(points.clone()),
        Shape::Polygon(points),
        Shape::Circle(first, first[1]),
        Shape::Trace(first),
    ];
    let frame = Frame {
        caption: "fuzz".to_string(),
        now: shapes.clone(),
        before: vec![shapes],
    };
    frames_as_svg(sheet, &[frame]).expect("drawn");
}

/// Numbers by twos.
fn pairs(numbers: &[f64]) -> Vec<(f64, f64)> {
    let pairs = numbers.as_chunks::<2>().0.iter();
    pairs.map(|[x, y]| (*x, *y)).collect()
}

/// A picture of one quantity over another.
fn draw_portrait(sheet: &Sheet, numbers: &[f64]) {
    let portrait = Portrait {
        name: "fuzz".to_string(),
        points: pairs(numbers),
    };
    phase_as_svg(sheet, ["x [m]", "y [m]"], &[portrait]).expect("drawn");
}

/// A picture of time over error.
fn draw_work(numbers: &[f64]) {
    let cloud = |mark| Cloud {
        name: "fuzz".to_string(),
        colour: 1,
        mark,
        points: pairs(numbers),
    };
    let all = [Mark::Disc, Mark::Ring, Mark::Cross, Mark::Triangle].map(cloud);
    work_diagram(Path::new(NOWHERE), "fuzz", &all).expect("drawn");
}

fuzz_target!(|bytes: &[u8]| {
    let Some((which, bytes)) = bytes.split_first() else {
        return;
    };
    let numbers = bytes.as_chunks::<8>().0.iter().take(MOST);
    let numbers: Vec<f64> = numbers.map(|bytes| f64::from_le_bytes(*bytes)).collect();
    let sheet = sheet(which & 128 != 0);
    match which % 4 {
        0 => draw_panels(&sheet, &numbers),
        1 => draw_frames(&sheet, &numbers),
        2 => draw_portrait(&sheet, &numbers),
        _ => draw_work(&numbers),
    }
});
