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
#[path = "../../cli/plot/mod.rs"]
mod plot;

use libfuzzer_sys::fuzz_target;
use plot::{
    Cloud, Frame, Mark, Marks, Panel, Scale, Series, Shape, Times, frames, panels, work_diagram,
};
use std::path::Path;

/// Pictures go nowhere.
const NOWHERE: &str = "/dev/null";
/// Numbers that are drawn: more are slow, not new.
const MOST: usize = 64;
const ERRORS: Scale = Scale::Logarithmic {
    low: -18,
    high: -12,
};

/// A picture of panels over time: times, and two curves.
fn draw_panels(numbers: &[f64]) {
    let third = numbers.len() / 3;
    let (times, values) = numbers.split_at(third);
    // The times of a run grow, whatever else becomes of it.
    let mut times = times.to_vec();
    times.sort_by(f64::total_cmp);
    let series = |name: &str, values: &[f64]| Series {
        name: name.to_string(),
        values: values.to_vec(),
    };
    let panel = |scale| Panel {
        axis: "position [m]".to_string(),
        scale,
        series: vec![
            series("a", &values[..third]),
            series("b", &values[third..2 * third]),
        ],
    };
    let marks = [Marks {
        times: values[..third.min(2)].to_vec(),
        name: "singular position".to_string(),
    }];
    let times = Times {
        values: &times,
        marks: &marks,
    };
    let all = [panel(Scale::Linear), panel(Scale::Whole), panel(ERRORS)];
    panels(Path::new(NOWHERE), "fuzz", times, &all).expect("drawn");
}

/// A picture of configurations.
fn draw_frames(numbers: &[f64]) {
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
    frames(Path::new(NOWHERE), "fuzz", &[frame]).expect("drawn");
}

/// A picture of time over error.
fn draw_work(numbers: &[f64]) {
    let cloud = |mark| Cloud {
        name: "fuzz".to_string(),
        colour: 1,
        mark,
        points: numbers
            .as_chunks::<2>()
            .0
            .iter()
            .map(|[x, y]| (*x, *y))
            .collect(),
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
    match which % 3 {
        0 => draw_panels(&numbers),
        1 => draw_frames(&numbers),
        _ => draw_work(&numbers),
    }
});
