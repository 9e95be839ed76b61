//! The picture: lines, circles, polygons and traces.
//!
//! In:  the arguments of `draw`.
//! Out: [`Shape`]s of positions; all that is wrong with a statement is reported at once.

use super::lowering::Lowering;
use super::messages::are;
use super::symbol::Symbol;
use super::value::{Scalar, Value, all};
use super::{Point, Shape};
use crate::diagnostic::{Diagnostic, Span};
use crate::expr::ExprId;
use crate::syntax::ast::{Drawing, Expr};
use std::slice::from_ref;

impl Lowering<'_> {
    /// Reads a part of the picture. Its numbers are sizes in units of their own.
    pub fn draw(&mut self, shape: Drawing, arguments: &[Expr], span: Span) -> Option<()> {
        self.evaluator.gains = true;
        let drawn = self.shape(shape, arguments, span);
        self.evaluator.gains = false;
        self.mechanism.shapes.push(drawn?);
        Some(())
    }

    fn shape(&mut self, shape: Drawing, arguments: &[Expr], span: Span) -> Option<Shape> {
        let (places, radius) = match (shape, arguments) {
            (Drawing::Circle, [centre, radius]) => (from_ref(centre), Some(self.radius(radius))),
            (Drawing::Circle, _) => {
                arguments.iter().for_each(|argument| {
                    self.evaluator.evaluate(argument);
                });
                let error = Diagnostic::error(span, "a circle has a centre and a radius");
                return self.report(error.help("write `draw circle([x, y], r);`"));
            }
            _ => (arguments, None),
        };
        let points = all(places.iter().map(|place| self.points(place)))?.concat();
        match (shape, points.as_slice(), radius) {
            (Drawing::Line, [_, _, ..], _) => Some(Shape::Line(points)),
            (Drawing::Polygon, [_, _, _, ..], _) => Some(Shape::Polygon(points)),
            (Drawing::Trace, [point], _) => Some(Shape::Trace(*point)),
            (Drawing::Circle, [centre], Some(radius)) => Some(Shape::Circle(*centre, radius?)),
            _ => self.wrong_points(shape, points.len(), span),
        }
    }

    fn wrong_points(&mut self, shape: Drawing, found: usize, span: Span) -> Option<Shape> {
        let [wants, call] = match shape {
            Drawing::Line => ["a line has two or more points", "line(p, q)"],
            Drawing::Polygon => ["a polygon has three or more points", "polygon(p, q, s)"],
            Drawing::Trace => ["a trace has one point", "trace(p)"],
            Drawing::Circle => ["a circle has one centre", "circle(p, r)"],
        };
        let message = format!("{wants}, here {}", are(found));
        self.report(Diagnostic::error(span, message).help(format!("write `draw {call};`")))
    }

    fn radius(&mut self, e: &Expr) -> Option<ExprId> {
        let length = self.evaluator.scalar(e, "a radius")?;
        self.drawable(&[length], e.span)?;
        Some(length.id)
    }

    /// A point, or the points of an array.
    fn points(&mut self, e: &Expr) -> Option<Vec<Point>> {
        let value = self.evaluator.evaluate(e)?.operand();
        let parts = match &value {
            Value::Array(array) => array.items.clone(),
            _ => vec![value],
        };
        let points: Vec<_> = parts.iter().map(|part| self.point(part, e.span)).collect();
        points.into_iter().collect()
    }

    fn point(&mut self, value: &Value, span: Span) -> Option<Point> {
        let Some(components) = value
            .as_vector()
            .filter(|parts| matches!(parts.len(), 2 | 3))
        else {
            let message = format!(
                "a point is written `[x, y]` or `[x, y, z]`, this is {}",
                value.shape()
            );
            return self.report(Diagnostic::error(span, message));
        };
        self.drawable(components, span)?;
        self.of_one_size(components.len(), span);
        let zero = self.evaluator.graph.integer(0);
        let at = |k: usize| components.get(k).map_or(zero, |scalar| scalar.id);
        Some([at(0), at(1), at(2)])
    }

    /// Warns of a picture in the plane and in space at once, the first time that it shows.
    fn of_one_size(&mut self, size: usize, span: Span) {
        let known = &mut self.named.points;
        if known.contains_key(&size) {
            return;
        }
        known.insert(size, span);
        let Some(first) = known.get(&(5 - size)).copied() else {
            return;
        };
        let this_has = |size: usize| match size {
            2 => "this has two",
            _ => "this has three",
        };
        let message = "some points of the picture have two components, others three";
        let warning = Diagnostic::warning(span, message).labelled(this_has(size));
        let warning = warning.also(first, this_has(5 - size));
        let help = "write all as `[x, y, z]`; those written `[x, y]` are drawn at z = 0";
        self.report::<()>(warning.help(help));
    }

    /// A picture shows positions.
    fn drawable(&mut self, scalars: &[Scalar], span: Span) -> Option<()> {
        let analyses = scalars.iter().map(|s| self.evaluator.analysis(s.id));
        let analyses: Vec<_> = analyses.collect();
        let rate = match analyses.iter().any(|analysis| analysis.acceleration) {
            true => Some(self.acceleration(scalars)),
            // What is differentiated twice has velocities in it as well.
            false => (analyses.iter().any(|a| a.velocity())).then_some("a velocity"),
        };
        let input = analyses.iter().any(|analysis| analysis.input);
        let state = analyses.iter().any(|analysis| analysis.state);
        let found = [
            rate,
            input.then_some("an input"),
            state.then_some("a state"),
        ];
        let found: Vec<&str> = found.into_iter().flatten().collect();
        if found.is_empty() {
            return Some(());
        }
        let found = found.join(" and ");
        let message = format!("a picture shows positions, this has {found} in it");
        let error = Diagnostic::error(span, message);
        self.report(error.help("draw what coordinates, parameters and `t` give"))
    }

    /// What is accelerated, in words.
    fn acceleration(&self, scalars: &[Scalar]) -> &'static str {
        let freedoms = self.mechanism.freedoms() as u32;
        let graph = &self.evaluator.graph;
        let mut symbols = scalars.iter().flat_map(|scalar| graph.symbols(scalar.id));
        match symbols.any(|s| matches!(s, Symbol::Acceleration(i) if i < freedoms)) {
            true => "an acceleration",
            false => "the rate of a state",
        }
    }
}
