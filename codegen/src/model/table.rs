//! Tables: functions through given points, piecewise linear or smooth.
//!
//! In:  a list of pairs, in the description or in a file beside it, and a formula.
//! Out: choices between pieces, each a polynomial of the formula.
//!
//! A piecewise linear function keeps its last values beyond the ends. A spline is the
//! natural cubic one: its second derivative is continuous and zero at the ends, beyond
//! which it goes on straight.
//!
//! Source: de Boor, A Practical Guide to Splines (1978), chapter IV.

use super::data;
use super::evaluate::Evaluator;
use super::messages::not_rising;
use super::unit::Unit;
use super::value::{Scalar, Value};
use crate::diagnostic::{Diagnostic, Span};
use crate::expr::{Comparison, ExprId, Function, Lookup, Number, Table, Test};
use crate::syntax::ast::{Expr, ExprKind};

/// The most points of a table for each of which code has a choice. The points of longer
/// ones are data, if they are constant.
const FEW: usize = 32;

/// How a table is read from a file.
const FROM_FILE: &str = "write `table(\"file.csv\", t)` for the first two columns, or name them: \
                         `table(\"file.csv\", \"time\", \"force\", t)`";

/// Quoted text.
fn text(e: &Expr) -> Option<&str> {
    match &e.kind {
        ExprKind::Text(text) => Some(text),
        _ => None,
    }
}

/// A point of a table.
struct Point {
    at: Scalar,
    /// The value of `at`, which is a constant.
    place: f64,
    value: Scalar,
    spans: [Span; 2],
}

impl Evaluator {
    /// `table(pairs, x)` or, if it is smooth, `spline(pairs, x)`.
    pub(super) fn table(&mut self, name: &str, arguments: &[Expr]) -> Option<Value> {
        let smooth = name == "spline";
        let (list, of) = (&arguments[0], &arguments[arguments.len() - 1]);
        let points = match list.kind {
            ExprKind::Text(_) => self.points_of_file(&arguments[..arguments.len() - 1]),
            _ => self.points(name, list),
        };
        let x = self.scalar(of, &format!("what `{name}` is a function of"));
        let (points, x) = (points?, x?);
        let mut unit = points[0].value.unit;
        for pair in points.windows(2) {
            let [first, second] = pair else { continue };
            let what = "the first column of this table";
            self.same_unit([(x, of.span), (first.at, first.spans[0])], what)?;
            self.same_unit(
                [(first.at, first.spans[0]), (second.at, second.spans[0])],
                what,
            )?;
            let values = [
                (first.value, first.spans[1]),
                (second.value, second.spans[1]),
            ];
            let common = self.same_unit(values, "the second column of this table")?;
            if unit == Unit::Number {
                unit = common;
            }
        }
        let id = match smooth {
            true => self.spline(&points, x.id)?,
            false => self.polygon(&points, x.id),
        };
        let span = list.span.to(of.span);
        let id = self.valid(id, span)?;
        Some(Value::Scalar(Scalar { id, unit }))
    }

    /// The points of a file.
    fn points_of_file(&mut self, texts: &[Expr]) -> Option<Vec<Point>> {
        let span = texts[0].span.to(texts[texts.len() - 1].span);
        let texts: Option<Vec<&str>> = texts.iter().map(text).collect();
        let Some((name, columns)) = texts.as_deref().and_then(<[&str]>::split_first) else {
            let error = Diagnostic::error(span, "columns are named by quoted text");
            return self.report(error.help(FROM_FILE));
        };
        let Some(folder) = &self.folder else {
            let message = "a description that is in no file has no files beside it";
            return self.report(Diagnostic::error(span, message).help("write the pairs here"));
        };
        let path = folder.join(name);
        self.files.push(path.clone());
        let pairs = match data::read(&path).and_then(|text| data::pairs(&text, columns)) {
            Ok(pairs) => pairs,
            Err(fault) => {
                let message = format!("`{name}`{}", fault.message);
                return self.report(Diagnostic::error(span, message).help(fault.help));
            }
        };
        let mut scalar =
            |value: f64| Scalar::new(self.graph.number(Number::float(value)), Unit::Number);
        let point = |[place, value]: [f64; 2]| Point {
            at: scalar(place),
            place,
            value: scalar(value),
            spans: [span, span],
        };
        Some(pairs.into_iter().map(point).collect())
    }

    /// The points of a list of pairs, in rising order.
    fn points(&mut self, name: &str, list: &Expr) -> Option<Vec<Point>> {
        let help = format!("write `{name}([[0, 1], [2, 3]], t)`: at 0 it is 1, at 2 it is 3");
        let rows = match &list.kind {
            ExprKind::Vector(rows) if rows.len() >= 2 => rows,
            _ => {
                let message = format!("`{name}` begins with a list of two or more pairs");
                return self.report(Diagnostic::error(list.span, message).help(help));
            }
        };
        let mut points: Vec<Point> = Vec::new();
        for row in rows {
            let [at, value] = match &row.kind {
                ExprKind::Vector(pair) if pair.len() == 2 => [&pair[0], &pair[1]],
                _ => {
                    let error = Diagnostic::error(row.span, "this is not a pair of numbers");
                    return self.report(error.help(help));
                }
            };
            let spans = [at.span, value.span];
            let (at, value) = (
                self.scalar(at, "the first entry of a pair")?,
                self.scalar(value, "the second entry of a pair")?,
            );
            let Some(place) = self.analysis(at.id).value.filter(|x| x.is_finite()) else {
                let error = Diagnostic::error(spans[0], "where a table changes has to be constant");
                return self.report(error.help("make it a number or a `const`"));
            };
            if let Some(before) = points.last().filter(|before| before.place >= place) {
                let message = not_rising(before.place, place);
                let error = Diagnostic::error(spans[0], message);
                return self.report(error.help("put the pairs in rising order, each place once"));
            }
            points.push(Point {
                at,
                place,
                value,
                spans,
            });
        }
        Some(points)
    }

    /// Straight pieces between the points.
    fn polygon(&mut self, points: &[Point], x: ExprId) -> ExprId {
        let values = points
            .iter()
            .map(|point| self.analysis(point.value.id).value);
        let values: Option<Vec<f64>> = values.collect();
        if let Some(values) = values.filter(|_| points.len() > FEW) {
            return self.data(points, straight(points, &values), x, false);
        }
        let mut result = points[points.len() - 1].value.id;
        for pair in points.windows(2).rev() {
            let [from, to] = pair else { continue };
            let rise = self.graph.sub(to.value.id, from.value.id);
            let run = self.graph.sub(to.at.id, from.at.id);
            let slope = self.graph.div(rise, run);
            let along = self.graph.sub(x, from.at.id);
            let climb = self.graph.mul(slope, along);
            let piece = self.graph.add(from.value.id, climb);
            result = self
                .graph
                .select(Comparison::Less, x, to.at.id, piece, result);
        }
        let first = &points[0];
        let (at, value) = (first.at.id, first.value.id);
        self.graph.select(Comparison::Less, x, at, value, result)
    }

    /// A table that code holds as data, until the program ends: a compiler ends soon.
    fn data(&mut self, points: &[Point], pieces: Vec<[f64; 4]>, x: ExprId, smooth: bool) -> ExprId {
        let places = places(points);
        let tables = &mut self.tables;
        let same = |table: &&Table| {
            table.places == places && table.pieces == pieces && table.smooth == smooth
        };
        let table = tables.iter().copied().find(same).unwrap_or_else(|| {
            let table: &'static Table = Box::leak(Box::new(Table {
                index: u32::try_from(tables.len()).unwrap_or(u32::MAX),
                places,
                pieces,
                smooth,
            }));
            tables.push(table);
            table
        });
        self.graph.function(Function::Table(Lookup::of(table)), x)
    }

    /// The natural cubic spline through the points.
    fn spline(&mut self, points: &[Point], x: ExprId) -> Option<ExprId> {
        let mut values = Vec::new();
        for point in points {
            let Some(value) = self.analysis(point.value.id).value else {
                let error =
                    Diagnostic::error(point.spans[1], "the points of a spline are constant");
                let help = "make it a number or a `const`, and multiply the spline by a parameter";
                return self.report(error.help(help));
            };
            values.push(value);
        }
        let places = places(points);
        let pieces = cubics(&places, &values);
        if points.len() > FEW {
            return Some(self.data(points, pieces, x, true));
        }
        let smooth = Test {
            smooth: true,
            ..Comparison::Less.into()
        };
        let last = places.len() - 1;
        let mut result = self.cubic(pieces[last + 1], places[last], x);
        for (i, piece) in pieces[..=last].iter().enumerate().rev() {
            // The first piece goes on straight from the first point.
            let cubic = self.cubic(*piece, places[i.saturating_sub(1)], x);
            let end = points[i].at.id;
            result = self.graph.select(smooth, x, end, cubic, result);
        }
        Some(result)
    }

    /// `c₀ + c₁ d + c₂ d² + c₃ d³` with the distance `d` from a place.
    fn cubic(&mut self, coefficients: [f64; 4], place: f64, x: ExprId) -> ExprId {
        let distance = self
            .graph
            .weighted_sum(Number::float(-place), &[(x, Number::ONE)]);
        let mut sum = self.graph.number(Number::float(coefficients[3]));
        for coefficient in coefficients[..3].iter().rev() {
            let product = self.graph.mul(sum, distance);
            sum = self
                .graph
                .weighted_sum(Number::float(*coefficient), &[(product, Number::ONE)]);
        }
        sum
    }
}

fn places(points: &[Point]) -> Vec<f64> {
    points.iter().map(|point| point.place).collect()
}

/// The pieces of a table: before the first point, between the points, behind the last.
fn straight(points: &[Point], values: &[f64]) -> Vec<[f64; 4]> {
    let mut pieces = vec![[values[0], 0.0, 0.0, 0.0]];
    for (points, values) in points.windows(2).zip(values.windows(2)) {
        let slope = (values[1] - values[0]) / (points[1].place - points[0].place);
        pieces.push([values[0], slope, 0.0, 0.0]);
    }
    pieces.push([values[values.len() - 1], 0.0, 0.0, 0.0]);
    pieces
}

/// The pieces of a natural spline: straight before the first point, cubic between the
/// points, straight behind the last.
fn cubics(places: &[f64], values: &[f64]) -> Vec<[f64; 4]> {
    let bends = bends(places, values);
    let last = places.len() - 1;
    let mut pieces = vec![[values[0], 0.0, 0.0, 0.0]];
    for i in 0..last {
        let run = places[i + 1] - places[i];
        let (bend, next) = (bends[i], bends[i + 1]);
        let slope = (values[i + 1] - values[i]) / run - run * (2.0 * bend + next) / 6.0;
        pieces.push([values[i], slope, bend / 2.0, (next - bend) / (6.0 * run)]);
    }
    pieces[0][1] = pieces[1][1];
    let run = places[last] - places[last - 1];
    let arrival = pieces[last][1] + run * (bends[last - 1] + bends[last]) / 2.0;
    pieces.push([values[last], arrival, 0.0, 0.0]);
    pieces
}

/// The second derivatives at the points of a natural spline: zero at both ends, between
/// them those for which the first derivative is continuous. By elimination without
/// pivots, which the diagonal is large enough for.
fn bends(places: &[f64], values: &[f64]) -> Vec<f64> {
    let last = places.len() - 1;
    let (mut above, mut right) = (vec![0.0; last + 1], vec![0.0; last + 1]);
    for i in 1..last {
        let (before, after) = (places[i] - places[i - 1], places[i + 1] - places[i]);
        let turn = (values[i + 1] - values[i]) / after - (values[i] - values[i - 1]) / before;
        let pivot = 2.0 * (before + after) - before * above[i - 1];
        above[i] = after / pivot;
        right[i] = (6.0 * turn - before * right[i - 1]) / pivot;
    }
    let mut bends = vec![0.0; last + 1];
    for i in (1..last).rev() {
        bends[i] = right[i] - above[i] * bends[i + 1];
    }
    bends
}
