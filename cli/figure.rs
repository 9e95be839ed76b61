//! Rows to panels: what is drawn together.
//!
//! In:  rows of a recording.
//! Out: [`Panel`]s: coordinates by unit, then the added columns.

use crate::column::Column;
use crate::plot::{Panel, Scale, Series};
use bricard_driver::heads;
use bricard_runtime::{Quantity, Structure};

/// Curves in one panel, so that the legend fits beside it.
const CURVES: usize = 9;
/// The axis of angles.
const ANGLE: &str = "angle [rad]";
/// What spans more than two turns is drawn apart from what oscillates (rad).
const TURNS: f64 = 4.0 * std::f64::consts::PI;
/// The range of a panel of constraint errors, unless they are larger.
pub const ERRORS: Scale = Scale::Logarithmic {
    low: -18,
    high: -12,
};

/// All coordinates and added columns of a recording.
pub fn overview(structure: &Structure, columns: &[Column], rows: &[Vec<f64>]) -> Vec<Panel> {
    let mut panels = coordinates(structure, rows);
    let first = heads(structure).len();
    let added: Vec<Curve> = columns
        .iter()
        .enumerate()
        .map(|(i, column)| Curve {
            axis: axis(*column, structure),
            scale: match column {
                Column::ConstraintError | Column::VelocityError => ERRORS,
                Column::Rank => Scale::Whole,
                _ => Scale::Linear,
            },
            series: series(column.name(structure), first + i, rows),
        })
        .collect();
    panels.extend(grouped(added));
    panels
}

/// The coordinates, those of one unit together.
pub fn coordinates(structure: &Structure, rows: &[Vec<f64>]) -> Vec<Panel> {
    let freedoms = structure.freedoms();
    let states = (structure.coordinates.iter().enumerate()).skip(freedoms.len());
    let curve = |(i, coordinate): (usize, &Quantity)| Curve {
        axis: match coordinate.unit {
            "rad" => ANGLE.to_string(),
            "m" => "position [m]".to_string(),
            "" => "coordinate".to_string(),
            unit => format!("coordinate [{unit}]"),
        },
        scale: Scale::Linear,
        series: series(coordinate.name.to_string(), 1 + i, rows),
    };
    // States stand behind the velocities.
    let states = states.map(|(i, state)| (i + freedoms.len(), state));
    let all = freedoms.iter().enumerate().chain(states).map(curve);
    // Beside an angle that goes on and on one that oscillates would look like a line.
    let (turning, others): (Vec<Curve>, Vec<Curve>) =
        all.partition(|curve| curve.axis == ANGLE && span(&curve.series) > TURNS);
    let mut panels = grouped(others);
    panels.extend(grouped(turning));
    panels
}

/// How far apart the least and the greatest finite value of a series are.
fn span(series: &Series) -> f64 {
    let finite = series.values.iter().filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| {
        (low.min(*y), high.max(*y))
    });
    high - low
}

/// A column of rows as a curve.
pub fn series(name: String, column: usize, rows: &[Vec<f64>]) -> Series {
    let value = |row: &Vec<f64>| row.get(column).copied().unwrap_or(f64::NAN);
    Series {
        name,
        values: rows.iter().map(value).collect(),
    }
}

fn axis(column: Column, structure: &Structure) -> String {
    let unit = column.unit(structure);
    let what = match column {
        Column::Energy | Column::Kinetic | Column::Potential => "energy".to_string(),
        Column::ConstraintError | Column::VelocityError => "constraint error".to_string(),
        Column::Rank => "rank".to_string(),
        Column::Reaction(_) | Column::Multiplier(_) => "reaction".to_string(),
        Column::Acceleration(i) if i < structure.freedoms().len() => "acceleration".to_string(),
        Column::Acceleration(_) => column.name(structure),
        // The components of one output lie in one panel.
        Column::Output(_) | Column::Input(_) => whole(&column.name(structure)).to_string(),
    };
    if unit.is_empty() {
        what
    } else {
        format!("{what} [{unit}]")
    }
}

/// The name of the output that a component belongs to.
fn whole(name: &str) -> &str {
    name.split(['.', '[']).next().unwrap_or(name)
}

/// A curve and the panel that it belongs to.
struct Curve {
    axis: String,
    scale: Scale,
    series: Series,
}

/// Curves with the same axis in one panel, in order of first appearance; more
/// panels where there are many.
fn grouped(curves: Vec<Curve>) -> Vec<Panel> {
    let mut panels: Vec<Panel> = Vec::new();
    for Curve {
        axis,
        scale,
        series,
    } in curves
    {
        let fits = |panel: &&mut Panel| panel.axis == axis && panel.series.len() < CURVES;
        match panels.iter_mut().find(fits) {
            Some(panel) => panel.series.push(series),
            None => panels.push(Panel {
                axis,
                scale,
                series: vec![series],
            }),
        }
    }
    panels
}
