//! The `start` block.

use super::lowering::Lowering;
use super::symbol::{Node, Symbol};
use super::value::{Scalar, Value};
use super::{Constraint, Start};
use crate::diagnostic::{Diagnostic, Span, figure};
use crate::expr::Number;
use crate::syntax::ast::{Expr, ExprKind, StartItem};
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
            let message =
                "only coordinates, velocities, states and formulas of them have start values";
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
}
