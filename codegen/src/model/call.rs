//! Functions by name.

use super::evaluate::Evaluator;
use super::language::{JUMPING, OTHERS, REACTION, from_elsewhere, other_functions};
use super::linear::transposed;
use super::messages::{count, takes_others};
use super::scope::Kind;
use super::unit::{PER_SECOND, Unit};
use super::value::{Matrix, Scalar, Value, all};
use crate::diagnostic::{Diagnostic, Span, nearest};
use crate::expr::{Function, Function2};
use crate::syntax;
use crate::syntax::ast::{Expr, ExprKind, Item, ItemKind, Name};
use crate::syntax::messages::did_you_mean;

impl Evaluator {
    /// `function(arguments)`
    pub fn call(&mut self, name: &Name, arguments: &[Expr], span: Span) -> Option<Value> {
        let unary = Function::ALL.iter().find(|(_, known)| *known == name.text);
        let other = OTHERS.iter().find(|(known, ..)| *known == name.text);
        let (arity, form) = match (unary, other) {
            (Some((_, name)), _) => (1, format!("{name}(x)")),
            (None, Some((_, arity, form))) => (*arity, (*form).to_string()),
            (None, None) if self.functions.contains(&name.text) => {
                return self.apply(name, arguments, span);
            }
            (None, None) if self.parts.known(&name.text) => return self.part_alone(name, span),
            (None, None) => return self.unknown_function(name),
        };
        if let ("rot", [angle]) = (name.text.as_str(), arguments) {
            return self.plane_rotation(angle);
        }
        let of_file = matches!(name.text.as_str(), "table" | "spline")
            && (2..=4).contains(&arguments.len())
            && matches!(arguments[0].kind, ExprKind::Text(_));
        if arguments.len() != arity && !of_file {
            let takes = match name.text.as_str() {
                "rot" => "one or two arguments".to_string(),
                _ => count(arity),
            };
            let message = takes_others(&name.text, &takes, arguments.len());
            let help = match name.text.as_str() {
                "dot" => format!("write `{form}`; a derivative in time is `der(x)`"),
                "min" | "max" if arguments.len() > arity => {
                    format!("write `{name}(a, {name}(b, c))`", name = name.text)
                }
                _ => format!("write `{form}`"),
            };
            return self.report(Diagnostic::error(span, message).help(help));
        }
        if let Some((function, _)) = unary {
            return self
                .unary(*function, &arguments[0], span)
                .map(Value::Scalar);
        }
        match name.text.as_str() {
            "atan2" => self.binary(Function2::Atan2, arguments, span),
            "min" => self.binary(Function2::Min, arguments, span),
            "max" => self.binary(Function2::Max, arguments, span),
            "table" | "spline" => self.table(&name.text, arguments),
            _ => self.geometric(&name.text, arguments, span),
        }
    }

    fn geometric(&mut self, name: &str, arguments: &[Expr], span: Span) -> Option<Value> {
        match name {
            "rot" => return self.rotation_about(&arguments[0], &arguments[1], span),
            "rotx" => return self.rotation(0, &arguments[0]),
            "roty" => return self.rotation(1, &arguments[0]),
            "rotz" => return self.rotation(2, &arguments[0]),
            "quat" => return self.quaternion(arguments, span),
            _ => {}
        }
        let mut values = all(arguments.iter().map(|argument| self.evaluate(argument)))?;
        if matches!(name, "dot" | "norm" | "norm2" | "cross") {
            values = values.into_iter().map(Value::array_to_vector).collect();
        }
        match (name, values.as_slice()) {
            ("der", [value]) => {
                self.still(&arguments[0], span);
                self.derivative(value, span)
            }
            ("dot", [Value::Vector(a), Value::Vector(b)]) if a.len() == b.len() => {
                self.inner(a, b, span).map(Value::Scalar)
            }
            ("cross", [Value::Vector(a), Value::Vector(b)])
                if a.len() == b.len() && matches!(a.len(), 2 | 3) =>
            {
                self.cross(a, b, span)
            }
            ("norm2", [Value::Vector(v)]) => self.inner(v, v, span).map(Value::Scalar),
            ("norm", [Value::Vector(v)]) => {
                let square = self.inner(v, v, span)?;
                let id = self.graph.function(Function::Sqrt, square.id);
                Some(Value::Scalar(Scalar::new(id, square.unit.power(0.5))))
            }
            ("transpose", [Value::Matrix(m)]) => self.transpose(m, span).map(Value::Matrix),
            ("omega", [Value::Matrix(m)]) if m.is_square() && m.rows.len() <= 3 => {
                self.angular_velocity(m, span)
            }
            _ => self.wrong_shape(name, &values, span),
        }
    }

    fn wrong_shape(&mut self, name: &str, values: &[Value], span: Span) -> Option<Value> {
        let wants = match name {
            "dot" => "two vectors of one size",
            "cross" => "two vectors of two or three components",
            "norm" | "norm2" => "a vector",
            "transpose" => "a matrix",
            _ => "a 2 × 2 or a 3 × 3 matrix",
        };
        let shapes: Vec<_> = values.iter().map(Value::shape).collect();
        let found = match shapes.len() {
            1 => "this is",
            _ => "these are",
        };
        let message = format!("`{name}` takes {wants}, {found} {}", shapes.join(" and "));
        self.report(Diagnostic::error(span, message))
    }

    fn unary(&mut self, function: Function, argument: &Expr, span: Span) -> Option<Scalar> {
        let x = self.scalar(argument, &format!("the argument of `{}`", function.name()))?;
        let unit = match function {
            Function::Sqrt => x.unit.power(0.5),
            Function::Abs => x.unit,
            Function::Sign => x.unit.power(0.0),
            _ => {
                self.pure(
                    x.unit,
                    &format!("the argument of `{}`", function.name()),
                    argument.span,
                )?;
                x.unit
            }
        };
        let id = self.graph.function(function, x.id);
        let (at, value) = (self.analysis(x.id).value, self.analysis(id).value);
        if let (Some(at), Some(value)) = (at, value)
            && !value.is_finite()
        {
            let message = format!("`{}` has no finite value at {at}", function.name());
            return self.report(Diagnostic::error(span, message));
        }
        Some(Scalar { id, unit })
    }

    fn binary(&mut self, function: Function2, arguments: &[Expr], span: Span) -> Option<Value> {
        let what = format!("an argument of `{}`", function.name());
        let (x, y) = (
            self.scalar(&arguments[0], &what),
            self.scalar(&arguments[1], &what),
        );
        let (x, y) = (x?, y?);
        let sides = [(x, arguments[0].span), (y, arguments[1].span)];
        let common = self.same_unit(sides, &format!("`{}`", function.name()))?;
        let unit = match (function, common) {
            (Function2::Atan2, Unit::Known(_)) => Unit::PURE,
            _ => common,
        };
        let id = self.graph.function2(function, x.id, y.id);
        Some(Value::Scalar(Scalar::new(self.valid(id, span)?, unit)))
    }

    fn cross(&mut self, a: &[Scalar], b: &[Scalar], span: Span) -> Option<Value> {
        let mut minor = |i: usize, j: usize| {
            let (left, right) = (self.times(a[i], b[j], span)?, self.times(a[j], b[i], span)?);
            self.subtract(left, right, span)
        };
        if a.len() == 2 {
            return minor(0, 1).map(Value::Scalar);
        }
        let parts = [minor(1, 2), minor(2, 0), minor(0, 1)];
        parts.into_iter().collect::<Option<_>>().map(Value::Vector)
    }

    /// The transpose; of a rotation, the angular velocity −R ω comes along.
    fn transpose(&mut self, m: &Matrix, span: Span) -> Option<Matrix> {
        let rows = transposed(&m.rows);
        let Some(spin) = m.spin else {
            return Some(Matrix { rows, spin: None });
        };
        let turned = match m.rows.len() {
            // About the normal of the plane, which stays where it is.
            2 => spin.to_vec(),
            _ => self.transform(m, &spin, span)?,
        };
        let opposite: Vec<Scalar> = turned.into_iter().map(|s| self.opposite(s)).collect();
        Some(Matrix {
            rows,
            spin: opposite.try_into().ok(),
        })
    }

    /// Warns of the derivative of a parameter. That of a formula may be zero for some
    /// indices of a loop and not for others.
    fn still(&mut self, argument: &Expr, span: Span) {
        let ExprKind::Name(name) = &argument.kind else {
            return;
        };
        let entry = self.scope.get(name);
        if entry.is_some_and(|entry| matches!(entry.kind, Kind::Parameter | Kind::Constant)) {
            let warning = Diagnostic::warning(span, "this derivative is zero");
            let help = format!("`{name}` does not move; coordinates are declared with `coord`");
            self.diagnostics.push(warning.help(help));
        }
    }

    /// `der(x)`: the total derivative in time.
    pub fn derivative(&mut self, value: &Value, span: Span) -> Option<Value> {
        let rates = value.scalars().into_iter().map(|s| self.rate(s, span));
        Some(value.with_scalars(all(rates)?))
    }

    /// The total derivative of a scalar in time.
    pub fn rate(&mut self, scalar: Scalar, span: Span) -> Option<Scalar> {
        let analysis = self.analysis(scalar.id);
        if analysis.acceleration {
            let error = Diagnostic::error(span, "the derivative of an acceleration is not known");
            return self.report(error.labelled("this contains `der(der(…))` already"));
        }
        if analysis.input {
            let error = Diagnostic::error(span, "the derivative of an input is not known");
            return self.report(error.help("declare another input for it"));
        }
        let mut flow = std::mem::take(&mut self.flow);
        let id = self.graph.derivative_along(scalar.id, &mut flow);
        self.flow = flow;
        // Zero fits every unit.
        let unit = match scalar.unit {
            Unit::Number if self.graph.is_zero(id) => Unit::Number,
            unit => unit.times(Unit::Known(PER_SECOND)),
        };
        Some(Scalar::new(self.valid(id, span)?, unit))
    }

    /// The names of all functions, built in and of the description.
    pub fn function_names(&self) -> Vec<&str> {
        let built_in = Function::ALL.iter().map(|(_, name)| *name);
        let built_in = built_in.chain(other_functions()).map(|name| name as &str);
        built_in.chain(self.functions.names()).collect()
    }

    /// Refuses a function that there is not.
    pub fn refuse_unknown_function(&mut self, name: &Name) {
        let own = self.parts.known(&name.text) || self.functions.contains(&name.text);
        if !own && !self.function_names().contains(&name.text.as_str()) {
            self.unknown_function(name);
        }
    }

    fn unknown_function(&mut self, name: &Name) -> Option<Value> {
        let text = name.text.as_str();
        if self.scope.unreadable.contains(text) {
            return None;
        }
        let functions = self.function_names();
        let value = self.scope.get(text).and_then(|entry| entry.value.as_ref());
        let help = if matches!(value, Some(Value::Array(_) | Value::Vector(_))) {
            format!("an element is written `{text}[0]`")
        } else if self.scope.get(text).is_some() || text == "t" || text == "pi" {
            format!("`{text}` is no function; a product is written `{text}*(…)`")
        } else if let Some(form) = from_elsewhere(text) {
            format!("write `{form}`")
        } else if JUMPING.contains(&text) {
            "steps are written with `if` or as a `table`, what is periodic with `sin` and `cos`"
                .into()
        } else if text == REACTION {
            "the reaction of a constraint that has a name is a column of each run, not a part of a \
             formula: `--columns 'reaction(name)'`"
                .into()
        } else if in_library(text) {
            format!("`{text}` is in the library of parts: write `use parts;` above")
        } else if let Some(near) = nearest(text, functions.iter().copied()) {
            did_you_mean(near)
        } else {
            format!("the functions are {}", functions.join(", "))
        };
        self.report(Diagnostic::error(name.span, format!("unknown function `{text}`")).help(help))
    }
}

/// Whether the library has a part of a name.
fn in_library(name: &str) -> bool {
    let library = syntax::library();
    let part = |item: &Item| matches!(&item.kind, ItemKind::Part(part) if part.name.text == name);
    library.iter().any(part)
}
