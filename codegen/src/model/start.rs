//! The `start` block and the picture.

use super::lowering::Lowering;
use super::messages::are;
use super::symbol::{Node, Symbol};
use super::value::{Scalar, Value};
use super::{Constraint, Point, Shape, Start};
use crate::diagnostic::{Diagnostic, Span, figure};
use crate::expr::Number;
use crate::syntax::ast::{Drawing, Expr, ExprKind, StartItem};
use crate::syntax::messages::{GIVEN, REMOVE_ONE};
use crate::syntax::written;

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
        self.without_time(target)?;
        let wanted = self.evaluator.evaluate(target)?.operand();
        let given = self.evaluator.evaluate(value)?.operand();
        for (side, value) in [(target, &wanted), (value, &given)] {
            self.without_acceleration(side, &value.scalars(), "the start")?;
        }
        if let Value::Array(_) | Value::Matrix(_) = wanted {
            let error = Diagnostic::error(target.span, "a whole array has no single start value");
            let help = "write `start { for i in 0..K { theta[i] ~ 0; } }`";
            return self.report(error.help(help));
        }
        if !wanted.same_shape(&given) {
            let message = format!(
                "this is {}, its start value {}",
                wanted.shape(),
                given.shape()
            );
            let error = Diagnostic::error(target.span.to(value.span), message);
            return self.report(error.help(match wanted {
                Value::Scalar(_) => "the start value of a number is a number",
                _ => "a vector begins at a vector: `p = [1, 0, 2];`",
            }));
        }
        let both = wanted.scalars().into_iter().zip(given.scalars());
        // Of what turns about a fixed axis, components of the angular velocity are zero.
        let says_something = |((wanted, given), _): &((Scalar, Scalar), _)| wanted.id != given.id;
        let mut entries: Vec<_> = both.zip(wanted.suffixes()).collect();
        if entries.iter().any(says_something) {
            entries.retain(says_something);
        }
        for ((wanted, given), suffix) in entries {
            let suffix = suffix.as_str();
            let (wanted, given) = ((wanted, target), (given, value));
            match self.start_target(wanted.0) {
                Some(coordinate) => self.start_value(coordinate, wanted, held, given)?,
                None => self.start_equation(wanted, held, given, suffix)?,
            }
        }
        Some(())
    }

    /// Refuses `q(0)`, as papers write what `q` is at the start.
    fn without_time(&mut self, target: &Expr) -> Option<()> {
        if let ExprKind::Call(name, arguments) = &target.kind
            && self.evaluator.scope.get(&name.text).is_some()
            && !self
                .evaluator
                .function_names()
                .contains(&name.text.as_str())
            && arguments.len() == 1
        {
            let message = "values of `start` are those at the beginning";
            let help = format!("write `{} = …;`, without a time", name.text);
            return self.report(Diagnostic::error(target.span, message).help(help));
        }
        Some(())
    }

    /// A formula that has a value at the start: an equation like a constraint, for positions
    /// or for velocities.
    fn start_equation(
        &mut self,
        (scalar, target): (Scalar, &Expr),
        held: bool,
        (given, value): (Scalar, &Expr),
        suffix: &str,
    ) -> Option<()> {
        let analysis = self.evaluator.analysis(scalar.id);
        let (message, help) = if !analysis.coordinate && !analysis.velocity() && !analysis.state {
            let message = "only coordinates and their velocities have start values";
            (message, "write `q1 = …;` or `der(q1) = …;`")
        } else if analysis.input {
            (
                "an equation of the start can't contain an input",
                "write out its law",
            )
        } else if analysis.state {
            (
                "an equation of the start can't contain a state",
                "give the state itself a value: `z = …;`",
            )
        } else if analysis.kinked {
            let help = "`abs`, `sign`, `min`, `max` and `if` can't be met from any side";
            ("an equation of the start has to be smooth", help)
        } else if analysis.degree > 1 {
            let help = "write it with `der(…)` of first degree";
            (
                "an equation of the start has to be linear in the velocities",
                help,
            )
        } else {
            self.constant_start((scalar, target), (given, value))?;
            let residual = self.evaluator.graph.sub(scalar.id, given.id);
            let span = target.span.to(value.span);
            let residual = self.evaluator.valid(residual, span)?;
            let sign = if held { '=' } else { '~' };
            let text = format!("{} {sign} {}", written(target), written(value));
            let equation = Constraint {
                residual,
                holonomic: !analysis.velocity(),
                text: self.row_text(&text, suffix),
                multiplier: None,
                span: self.place_of(span),
            };
            match held {
                true => self.mechanism.start_equations.push(equation),
                false => self.mechanism.start_guesses.push(equation),
            }
            return Some(());
        };
        self.report(Diagnostic::error(target.span, message).help(help))
    }

    /// Refuses a start value that is no constant, or in another unit.
    fn constant_start(
        &mut self,
        (scalar, target): (Scalar, &Expr),
        (given, value): (Scalar, &Expr),
    ) -> Option<()> {
        let analysis = self.evaluator.analysis(given.id);
        if analysis.time
            || analysis.coordinate
            || analysis.velocity()
            || analysis.input
            || analysis.state
        {
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
        Some(())
    }

    fn start_value(
        &mut self,
        (coordinate, velocity): (u32, bool),
        (scalar, target): (Scalar, &Expr),
        held: bool,
        (given, value): (Scalar, &Expr),
    ) -> Option<()> {
        self.constant_start((scalar, target), (given, value))?;
        let (coordinate, span) = (coordinate as usize, target.span.to(value.span));
        if !self.first_start((coordinate, velocity), target.span)? {
            return Some(());
        }
        if !velocity {
            self.many_turns(coordinate, value, given);
        }
        self.mechanism.starts.push(Start {
            coordinate,
            velocity,
            value: given.id,
            held,
            span: self.place_of(span),
        });
        Some(())
    }

    /// Whether a start value is to be kept: that of a part gives way to one outside it.
    fn first_start(&mut self, what: (usize, bool), span: Span) -> Option<bool> {
        let depth = self.frame.uses.len();
        let key = (what.0 as u32, what.1);
        match self.named.starts.get(&key).copied() {
            Some((first, other)) if other == depth => {
                let error = Diagnostic::error(span, "this has a start value already");
                return self.report(error.also(first, GIVEN).help(REMOVE_ONE));
            }
            Some((_, other)) if other < depth => return Some(false),
            Some(_) => {
                (self.mechanism.starts).retain(|start| (start.coordinate, start.velocity) != what)
            }
            None => {}
        }
        self.named.starts.insert(key, (span, depth));
        Some(true)
    }

    /// Warns of an angle of more than a turn that has no `deg` or `pi` in it: degrees are
    /// meant.
    fn many_turns(&mut self, coordinate: usize, value: &Expr, given: Scalar) {
        let number = self.evaluator.graph.as_number(given.id);
        let size = number.map_or(0.0, Number::to_f64);
        let angle = self.mechanism.coordinates[coordinate].unit == "rad";
        if angle && size.abs() > std::f64::consts::TAU {
            let size = figure(size);
            let message = format!("{size} rad is more than a turn");
            let warning = Diagnostic::warning(value.span, message);
            self.report::<()>(warning.help(format!("for degrees write `{size}*deg`")));
        }
    }

    /// The coordinate that a start value is given to, and whether its velocity is meant;
    /// `None` if it is given to a formula.
    fn start_target(&self, scalar: Scalar) -> Option<(u32, bool)> {
        match self.evaluator.graph.node(scalar.id) {
            Node::Symbol(Symbol::Coordinate(i)) => Some((*i, false)),
            Node::Symbol(Symbol::Velocity(i)) => Some((*i, true)),
            _ => None,
        }
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
        let [wants, call] = match shape {
            Drawing::Line => ["a line has two or more points", "line(p, q)"],
            Drawing::Polygon => ["a polygon has three or more points", "polygon(p, q, s)"],
            Drawing::Trace => ["a trace has one point", "trace(p)"],
            Drawing::Circle => ["a circle has one centre", "circle(p, r)"],
        };
        let message = format!("{wants}, here {}", are(found));
        self.report(Diagnostic::error(span, message).help(format!("write `draw {call};`")))
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
            let analysis = self.evaluator.analysis(scalar.id);
            if analysis.velocity() || analysis.input || analysis.state || analysis.acceleration {
                let error = Diagnostic::error(
                    span,
                    "a picture shows positions, this has a velocity, an input or a state in it",
                );
                return self.report(error.help("draw what coordinates, parameters and `t` give"));
            }
        }
        Some(())
    }
}
