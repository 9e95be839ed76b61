//! Rows to panels: what is drawn together.
//!
//! In:  rows of a recording.
//! Out: [`Panel`]s: coordinates by unit, then the added columns.

use crate::column::Column;
use crate::plot::{Panel, Scale, Series, ends};
use bricard_runtime::Structure;

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
    panels.extend(added(structure, columns, rows));
    panels
}

/// Numbers of a row before the added columns: time, coordinates and velocities, and states of
/// the first order.
fn begin(structure: &Structure) -> usize {
    1 + structure.freedoms().len() + structure.coordinates.len()
}

/// The added columns, those of one kind and unit together.
pub fn added(structure: &Structure, columns: &[Column], rows: &[Vec<f64>]) -> Vec<Panel> {
    let first = begin(structure);
    let all = 0..columns.len();
    grouped(
        all.map(|i| curve(structure, columns, rows, first + i))
            .collect(),
    )
}

/// The velocities, those of one unit together.
pub fn velocities(structure: &Structure, rows: &[Vec<f64>]) -> Vec<Panel> {
    let n = structure.freedoms().len();
    let places = 1 + n..=2 * n;
    grouped(places.map(|i| curve(structure, &[], rows, i)).collect())
}

/// Some columns of the rows, by their places.
pub fn chosen(
    structure: &Structure,
    columns: &[Column],
    rows: &[Vec<f64>],
    places: &[usize],
) -> Vec<Panel> {
    let curves = places.iter().map(|i| curve(structure, columns, rows, *i));
    grouped(curves.collect())
}

/// The places in the rows of the coordinates and the added columns.
pub fn places(structure: &Structure, columns: &[Column]) -> Vec<usize> {
    let n = structure.freedoms().len();
    let behind = 1 + 2 * n..begin(structure) + columns.len();
    (1..=n).chain(behind).collect()
}

/// The scale of a column of the rows, by its place.
pub fn scale(structure: &Structure, columns: &[Column], place: usize) -> Scale {
    curve(structure, columns, &[], place).scale
}

/// A column of the rows, by its place, named with its unit.
pub fn named(structure: &Structure, columns: &[Column], rows: &[Vec<f64>], place: usize) -> Series {
    let Curve { axis, series, .. } = curve(structure, columns, rows, place);
    let name = match axis.split_once('[') {
        Some((_, unit)) => format!("{} [{unit}", series.name),
        None => series.name,
    };
    Series { name, ..series }
}

/// A column of the rows, by its place behind the time.
fn curve(structure: &Structure, columns: &[Column], rows: &[Vec<f64>], place: usize) -> Curve {
    let n = structure.freedoms().len();
    let coordinate = |i: usize| structure.freedoms().get(i);
    let with_unit = |what: &str, unit: &str, per: &str| match unit {
        "" => what.to_string(),
        unit => format!("{what} [{}{per}]", printed(unit)),
    };
    let linear = |axis, name| Curve {
        axis,
        scale: Scale::Linear,
        series: series(name, place, rows),
    };
    if let Some(coordinate) = place.checked_sub(1).and_then(coordinate) {
        let axis = match coordinate.unit {
            "rad" => ANGLE.to_string(),
            "m" => "position [m]".to_string(),
            unit => with_unit("coordinate", unit, ""),
        };
        return linear(axis, coordinate.name.to_string());
    }
    if let Some(coordinate) = place.checked_sub(1 + n).and_then(coordinate) {
        let axis = match coordinate.unit {
            "rad" => "angular velocity [rad/s]".to_string(),
            unit => with_unit("velocity", unit, "/s"),
        };
        return linear(axis, format!("der({})", coordinate.name));
    }
    let state = |i: usize| structure.coordinates.get(n + i);
    if let Some(state) = place.checked_sub(1 + 2 * n).and_then(state) {
        return linear(with_unit("state", state.unit, ""), state.name.to_string());
    }
    let first = begin(structure);
    let column = place.checked_sub(first).and_then(|i| columns.get(i));
    let Some(column) = column else {
        return linear("time [s]".to_string(), "t".to_string());
    };
    Curve {
        axis: axis(*column, structure),
        scale: match column {
            Column::ConstraintError | Column::VelocityError => ERRORS,
            Column::Rank => Scale::Whole,
            _ => Scale::Linear,
        },
        series: series(column.name(structure), place, rows),
    }
}

/// The coordinates, those of one unit together.
pub fn coordinates(structure: &Structure, rows: &[Vec<f64>]) -> Vec<Panel> {
    let n = structure.freedoms().len();
    // States stand behind the velocities.
    let places = (1..=n).chain(1 + 2 * n..begin(structure));
    let all = places.map(|i| curve(structure, &[], rows, i));
    // Beside an angle that grows on and on, one that oscillates would look like a straight
    // line.
    let (turning, others): (Vec<Curve>, Vec<Curve>) =
        all.partition(|curve| curve.axis == ANGLE && span(&curve.series) > TURNS);
    let mut panels = grouped(others);
    panels.extend(grouped(turning));
    panels
}

/// How far apart the least and the greatest finite value of a series are.
fn span(series: &Series) -> f64 {
    let values = series.values.iter().copied();
    let (low, high) = ends(values.filter(|value| value.is_finite()));
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
        format!("{what} [{}]", printed(unit))
    }
}

/// A unit as it is printed: `N·m` for `N*m`, `m²` for `m^2`.
fn printed(unit: &str) -> String {
    let signs = [("*", "·"), ("^2", "²"), ("^3", "³"), ("^4", "⁴")];
    let all = signs.iter();
    all.fold(unit.to_string(), |text, (sign, print)| {
        text.replace(sign, print)
    })
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
