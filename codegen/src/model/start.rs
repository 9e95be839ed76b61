//! The `start` block and the picture.

use super::lower::Lowering;
use super::value::{Scalar, Value};
use super::{Point, Shape, Start};
use crate::diagnostic::{Diagnostic, Span};
use crate::expr::{Node, Symbol};
use crate::parse::ast::{Drawing, Expr, StartItem};

impl Lowering<'_> {
    /// Reads the entries of a `start` block.
    pub fn start(&mut self, entries: &[StartItem]) -> Option<()> {
        for entry in entries {
            match entry {
                StartItem::Entry {
                    target,
                    held,
                    value,
                } => {
                    // What is wrong has been reported; the next entry is read anyway.
                    let _ = self.start_entry(target, *held, value);
                }
                StartItem::For(range, inside) => {
                    self.repeat(range, |this| {
                        this.start(inside);
                    });
                }
            }
        }
        Some(())
    }

    fn start_entry(&mut self, target: &Expr, held: bool, value: &Expr) -> Option<()> {
        let (scalar, coordinate, velocity) = self.start_target(target)?;
        let given = self.evaluator.scalar(value, "a start value")?;
        let facts = self.evaluator.facts(given.id);
        if facts.time || facts.coordinate || facts.velocity() || facts.input {
            let error = Diagnostic::error(
                value.span,
                "a start value is built of numbers, constants and parameters",
            );
            let help = "what has to hold between coordinates is a `constraint`";
            return self.report(error.help(help));
        }
        self.evaluator.same_unit(
            [(scalar, target.span), (given, value.span)],
            "this equation",
        )?;
        if let Some(first) = self
            .named
            .starts
            .insert((coordinate, velocity), target.span)
        {
            let error = Diagnostic::error(target.span, "this has a start value already");
            return self.report(error.also(first, "given here").help("remove one of them"));
        }
        let (coordinate, span) = (coordinate as usize, target.span.to(value.span));
        self.mechanism.starts.push(Start {
            coordinate,
            velocity,
            value: given.id,
            held,
            span,
        });
        Some(())
    }

    fn start_target(&mut self, target: &Expr) -> Option<(Scalar, u32, bool)> {
        let value = self.evaluator.evaluate(target)?;
        if let Value::Array(_) = value {
            let error = Diagnostic::error(target.span, "a whole array has no single start value");
            let help = "write `start { for i in 0..K { theta[i] ~ 0; } }`";
            return self.report(error.help(help));
        }
        if let Value::Scalar(scalar) = value {
            match self.evaluator.graph.node(scalar.id) {
                Node::Symbol(Symbol::Coordinate(i)) => return Some((scalar, *i, false)),
                Node::Symbol(Symbol::Velocity(i)) => return Some((scalar, *i, true)),
                _ => {}
            }
        }
        let error = Diagnostic::error(
            target.span,
            "only coordinates and their velocities have start values",
        );
        self.report(error.help("write `q1 = …;` or `der(q1) = …;`"))
    }

    /// Reads a part of the picture. Its numbers are sizes in units of their own.
    pub fn draw(&mut self, shape: Drawing, arguments: &[Expr], span: Span) -> Option<()> {
        self.evaluator.gains = true;
        let drawn = self.shape(shape, arguments, span);
        self.evaluator.gains = false;
        self.mechanism.shapes.push(drawn?);
        Some(())
    }

    fn shape(&mut self, shape: Drawing, arguments: &[Expr], span: Span) -> Option<Shape> {
        let (centre, radius) = match (shape, arguments) {
            (Drawing::Circle, [centre, radius]) => (std::slice::from_ref(centre), Some(radius)),
            (Drawing::Circle, _) => {
                let error = Diagnostic::error(span, "a circle has a centre and a radius");
                return self.report(error.help("write `draw circle([x, y], r);`"));
            }
            _ => (arguments, None),
        };
        let mut points = Vec::new();
        for argument in centre {
            points.extend(self.points(argument)?);
        }
        match (shape, points.as_slice(), radius) {
            (Drawing::Line, [_, _, ..], _) => Some(Shape::Line(points)),
            (Drawing::Polygon, [_, _, _, ..], _) => Some(Shape::Polygon(points)),
            (Drawing::Trace, [point], _) => Some(Shape::Trace(*point)),
            (Drawing::Circle, [centre], Some(radius)) => {
                let length = self.evaluator.scalar(radius, "a radius")?;
                self.drawable(&[length], radius.span)?;
                Some(Shape::Circle(*centre, length.id))
            }
            _ => self.wrong_points(shape, points.len(), span),
        }
    }

    fn wrong_points(&mut self, shape: Drawing, found: usize, span: Span) -> Option<Shape> {
        let wants = match shape {
            Drawing::Line => "a line has two or more points",
            Drawing::Polygon => "a polygon has three or more points",
            Drawing::Trace => "a trace has one point",
            Drawing::Circle => "a circle has one centre",
        };
        self.report(Diagnostic::error(
            span,
            format!("{wants}, here are {found}"),
        ))
    }

    /// A point, or the points of an array.
    fn points(&mut self, e: &Expr) -> Option<Vec<Point>> {
        let value = self.evaluator.evaluate(e)?.operand();
        let parts = match &value {
            Value::Array(array) => array.items.clone(),
            _ => vec![value],
        };
        let mut points = Vec::new();
        for part in parts {
            let Some(components) = part
                .as_vector()
                .filter(|parts| matches!(parts.len(), 2 | 3))
            else {
                let message = format!(
                    "a point is written `[x, y]` or `[x, y, z]`, this is {}",
                    part.shape()
                );
                return self.report(Diagnostic::error(e.span, message));
            };
            self.drawable(components, e.span)?;
            let zero = self.evaluator.graph.integer(0);
            let at = |k: usize| components.get(k).map_or(zero, |scalar| scalar.id);
            points.push([at(0), at(1), at(2)]);
        }
        Some(points)
    }

    /// A picture shows positions.
    fn drawable(&mut self, scalars: &[Scalar], span: Span) -> Option<()> {
        for scalar in scalars {
            let facts = self.evaluator.facts(scalar.id);
            if facts.velocity() || facts.input {
                let error = Diagnostic::error(
                    span,
                    "a picture shows positions, this has a velocity or an input in it",
                );
                return self.report(error);
            }
        }
        Some(())
    }
}
