//! Rows to panels: what is drawn together.
//!
//! In:  rows of a recording.
//! Out: [`Panel`]s: coordinates by unit, then the added columns.

use crate::column::Column;
use crate::plot::{Panel, Scale, Series};
use bricard_runtime::Structure;

/// Curves in one panel, so that the legend fits beside it.
const CURVES: usize = 9;
/// The range of a panel of constraint errors, unless they are larger.
pub const ERRORS: Scale = Scale::Logarithmic {
    low: -18,
    high: -12,
};

/// All coordinates and added columns of a recording.
pub fn overview(structure: &Structure, columns: &[Column], rows: &[Vec<f64>]) -> Vec<Panel> {
    let mut panels = coordinates(structure, rows);
    let first = 1 + 2 * structure.coordinates.len();
    let added: Vec<Curve> = columns
        .iter()
        .enumerate()
        .map(|(i, column)| Curve {
            axis: axis(*column, structure),
            scale: match column {
                Column::ConstraintError | Column::VelocityError => ERRORS,
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
    let curve = |(i, coordinate): (usize, &bricard_runtime::Quantity)| Curve {
        axis: match coordinate.unit {
            "rad" => "angle [rad]".to_string(),
            "m" => "position [m]".to_string(),
            "" => "coordinate".to_string(),
            unit => format!("coordinate [{unit}]"),
        },
        scale: Scale::Linear,
        series: series(coordinate.name.to_string(), 1 + i, rows),
    };
    grouped(
        structure
            .coordinates
            .iter()
            .enumerate()
            .map(curve)
            .collect(),
    )
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
        Column::Energy | Column::Kinetic | Column::Potential => "energy",
        Column::ConstraintError | Column::VelocityError => "constraint error",
        Column::Rank => "rank",
        Column::Reaction(_) => "reaction",
        Column::Output(_) => "output",
    };
    if unit.is_empty() {
        what.to_string()
    } else {
        format!("{what} [{unit}]")
    }
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
